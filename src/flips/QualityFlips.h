/// @file QualityFlips.h
/// The flips of version 3: those of Algorithm 4, and those that make the worst angle of an octahedron better.
#pragma once

#include "Parallel.h"
#include "destinations/LocalVertices.h"
#include "flips/Flips.h"

#include <cstdint>
#include <vector>

namespace vdbtet {

/// An octahedron that had better be flipped.
struct FlipCandidate {
    std::uint16_t spine; ///< (lattice * 3 + axis) << 9 | the bit of its lower end
    std::uint8_t slice;  ///< the better one of A and B
    float gain;          ///< in worth(), degrees

    friend bool operator==(const FlipCandidate& a, const FlipCandidate& b) {
        return a.spine == b.spine && a.slice == b.slice && a.gain == b.gain;
    }
};

/// @brief The flips of version 3, a tile's by itself, so that those of some tiles can be chosen again.
/// @details An active spine is flipped to the slice of the larger worth(). A candidate is any other
/// octahedron whose four tets are in the mesh before and after, and whose worth grows by more than 0.1
/// degrees by that: all its vertices are in the mesh, so none of its ring edges is active. Two of them at
/// least are manifold, so that the octahedron lies in cells that a graded mesh keeps (finestCells() in
/// grading/). It is flipped if it gains more than each candidate whose spine is one of its ring edges, as
/// those alone share a tet with it; what is less than kTieAngle apart goes to the one of the lower end.
class QualityFlips {
public:
    /// @param vertices  must outlive this; its labels and destinations may change between calls
    explicit QualityFlips(const Vertices& vertices);

    /// @brief Choose the flips of some tiles, after which all are as they would be had all been chosen anew.
    /// @param tiles    own ones, ascending; the octahedra of all others have the vertices they had before
    /// @param changed  receives the lower ends of all spines that are flipped now or were, and not alike
    void choose(const std::vector<TileRef>& tiles, VertexMasks& changed, Interrupt& interrupt,
                const Seams& seams = Seams());

    void chooseAll(Interrupt& interrupt, const Seams& seams = Seams());

    /// Those of borrowed tiles, too; the counts are of own ones.
    Flips flips() const;

    /// Of a surface tile, ascending; of interest to tests.
    const std::vector<FlipCandidate>& candidates(TileRef tile) const { return mTiles[tile].candidates; }

private:
    struct OfTile {
        std::vector<std::uint16_t> active, chosen; ///< as Flips::codes; sorted
        std::vector<FlipCandidate> candidates;     ///< ascending by spine
    };

    /// Whether a candidate gains more than those at its ring edges.
    bool wins(TileRef tile, const FlipCandidate& candidate) const;
    const FlipCandidate* find(TileRef tile, std::uint16_t spine) const;

    const Vertices& mVertices;
    std::vector<OfTile> mTiles;
};

} // namespace vdbtet
