/// @file RankGrading.h
/// What follows the surface: octants, numbers, and which of them are a rank's.
#pragma once

#include "mpi/Comm.h"
#include "mpi/RankPart.h"

#include "grading/Grading.h"
#include "numbering/Numbering.h"

#include <vector>

namespace vdbtet::mpi {

/// @brief gradeInterior() of the whole mesh.
/// @param moved  of the tiles of the part
/// @param top    0 for a uniform mesh
/// @details All ranks have all octants of a graded mesh, some 200 B a surface tile: they are few next to what
/// makes them.
Grading gradePart(Comm& comm, const RankPart& part, const std::vector<TileSigns>& signs,
                  const VertexMasks& moved, int top, Interrupt& interrupt);

/// @brief Numbers the mesh as one of its ranks.
/// @details Of a graded mesh an interior tile of the first tier is its first surface tile's owner's, and
/// those of higher tiers are dealt out in order.
class OtherRanks final : public OtherParts {
public:
    OtherRanks(Comm& comm, const Layout& layout, const Grading& grading);

    bool isOwn(int tier, const Span& span) const override {
        return span.tile >= 0 && (mGrading.top == 0 ? span.tile < mLayout.ownCount()
                                                    : bool(mOwn[std::size_t(tier)][std::size_t(span.tile)]));
    }
    void addCounts(int tier, const Spans& spans, std::vector<SpanCounts>& counts) override;
    void addSums(Numbering& numbering) override;

    /// Get the used vertices of others' tiles that ids are looked up in.
    void addUsed(const RankPart& part, Numbering& numbering) const;

    /// @return the own tiles of both kinds, of all tiers
    std::vector<TileRange> ranges(const RankPart& part, const Skeleton& skeleton,
                                  const Numbering& numbering) const;

private:
    /// Which rank has number @a i of @a count.
    int dealt(std::int64_t i, std::int64_t count) const { return int(i * mComm.size() / count); }

    Comm& mComm;
    const Layout& mLayout;
    const Grading& mGrading;
    std::vector<std::vector<bool>> mOwn; ///< of a graded mesh, by tier and record
};

} // namespace vdbtet::mpi
