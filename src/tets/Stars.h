/// @file Stars.h
/// The tets at one vertex, for the stages that look at the mesh a vertex at a time.
#pragma once

#include "tets/TileTets.h"

#include <array>
#include <cstdint>
#include <vector>

namespace vdbtet {

/// @brief Names a tet by the octahedron that owns it, as TileTets does: an L_A spine, or the flipped one of
/// an L_B spine.
struct TetName {
    bcc::Lattice lattice; ///< of the spine
    int axis;
    int number; ///< in kSliceTets of the octahedron's slice
    int lower;  ///< the spine's lower end, a local number
};

enum class Presence : std::uint8_t {
    Outside,   ///< a vertex of it is outside
    Ambiguous, ///< all its vertices are manifold: dropped
    InMesh
};

/// A tet of the star of a vertex.
struct StarTet {
    std::array<int, 4> vertices; ///< local numbers, positively oriented
    TetName name;
    Presence presence;
};

/// @brief The stars of a surface tile's own vertices.
/// @details All tets at a vertex, in the mesh or not, fill the space around it: 24 where nothing is flipped.
class Stars {
public:
    explicit Stars(const Flips& flips) : mFlips(flips) {}

    /// Go to a surface tile, the states of whose vertices are @a states, until the next call.
    void load(const Neighbours& neighbours, const LocalStates& states);

    /// Call @a visit(StarTet) for each tet at vertex @a v of the tile, a local number; always in one order.
    template <typename Visit>
    void forEachTet(int v, Visit&& visit) const {
        const bcc::Lattice lattice = latticeOf(v);
        for (const Kin& kin : kKin[lattice]) visitLattice(v, kin, visit);
        if (!mAnyFlips) return;
        for (const Role& role : kRoles[lattice]) visitFlipped(v, role, visit);
    }

private:
    /// A tet of slice S at a vertex: of the octahedron of a spine there, and of that of the ring edge.
    struct Kin {
        int spine, ring; ///< steps to the lower ends
        int spineAxis, ringAxis;
        std::array<int, 4> vertices; ///< steps
        int number;                  ///< in the octahedron that is L_A's
    };
    /// An octahedron that a vertex is in.
    struct Role {
        bcc::Lattice lattice;
        int axis;
        int lower;  ///< the step to the spine's lower end
        int vertex; ///< the vertex's number in it
    };
    static const std::array<std::array<Kin, 24>, 2> kKin;
    static const std::array<std::array<Role, 18>, 2> kRoles;
    static std::array<std::array<Kin, 24>, 2> makeKin();
    static std::array<std::array<Role, 18>, 2> makeRoles();

    Presence presenceOf(const std::array<int, 4>& vertices) const {
        int manifold = 0, interior = 0;
        for (const int v : vertices) {
            manifold += mStates->manifold(v);
            interior += mStates->interior(v);
        }
        return manifold == 4              ? Presence::Ambiguous
               : manifold + interior == 4 ? Presence::InMesh
                                          : Presence::Outside;
    }
    bool flipped(bcc::Lattice lattice, int axis, int lower) const {
        return mLocalFlips.mask(lattice, axis).test(bitOf(lower));
    }

    template <typename Visit>
    void visitLattice(int v, const Kin& kin, Visit&& visit) const {
        const bcc::Lattice lattice = latticeOf(v);
        if (flipped(lattice, kin.spineAxis, v + kin.spine)) return;
        if (flipped(bcc::other(lattice), kin.ringAxis, v + kin.ring)) return;
        StarTet tet;
        for (int i = 0; i < 4; ++i) tet.vertices[i] = v + kin.vertices[i];
        tet.name = lattice == bcc::A ? TetName{bcc::A, kin.spineAxis, kin.number, v + kin.spine}
                                     : TetName{bcc::A, kin.ringAxis, kin.number, v + kin.ring};
        tet.presence = presenceOf(tet.vertices);
        visit(tet);
    }

    template <typename Visit>
    void visitFlipped(int v, const Role& role, Visit&& visit) const {
        const int lower = v + role.lower;
        if (!flipped(role.lattice, role.axis, lower)) return;
        const LocalOctahedron octahedron = localOctahedron(role.lattice, role.axis, lower);
        const auto& tets = bcc::kSliceTets[mLocalFlips.slice(role.axis, lower)];
        for (int number = 0; number < 4; ++number) {
            StarTet tet;
            bool atV = false;
            for (int i = 0; i < 4; ++i) {
                atV = atV || tets[number][i] == role.vertex;
                tet.vertices[i] = octahedron[tets[number][i]];
            }
            if (!atV) continue;
            tet.name = {role.lattice, role.axis, number, lower};
            tet.presence = presenceOf(tet.vertices);
            visit(tet);
        }
    }

    const Flips& mFlips;
    const LocalStates* mStates = nullptr;
    LocalFlips mLocalFlips;
    bool mAnyFlips = false;
};

} // namespace vdbtet
