/// @file Stars.h
/// The tets at one vertex, for the stages that look at the mesh a vertex at a time.
#pragma once

#include "tets/TileTets.h"

#include <algorithm>
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
    Removed,   ///< by Changes
    InMesh
};

/// A tet of the star of a vertex.
struct StarTet {
    std::array<int, 4> vertices; ///< local numbers, positively oriented
    TetName name;
    Presence presence;
};

/// The octahedra that a vertex is in are numbered, its roles: by the spine's lattice, then axis, then the
/// vertex's number there.
constexpr int kRoles = 18;

/// The role of each vertex of an octahedron, by the spine's lattice and axis.
using RolesOf = std::array<std::array<std::array<int, 6>, 3>, 2>;
constexpr RolesOf numberRoles() {
    RolesOf roles{};
    int next[2] = {0, 0};
    for (std::size_t spine = 0; spine < 2; ++spine) {
        for (std::size_t axis = 0; axis < 3; ++axis) {
            for (std::size_t i = 0; i < 6; ++i)
                roles[spine][axis][i] = next[bcc::kOctahedra[spine][axis][i].lattice]++;
        }
    }
    return roles;
}
constexpr RolesOf kRolesOf = numberRoles();

/// The face of a positive tet without its vertex @a v, from outside the tet.
inline LocalFace faceOpposite(const std::array<int, 4>& tet, int v) {
    std::size_t at = 0;
    while (tet[at] != v) ++at;
    const auto& face = bcc::kTetFaces[at];
    return {tet[std::size_t(face[0])], tet[std::size_t(face[1])], tet[std::size_t(face[2])]};
}

/// @brief The stars of a surface tile's own vertices.
/// @details All tets at a vertex, in the mesh or not, fill the space around it: 24 where nothing is flipped.
class Stars {
public:
    Stars(const Vertices& vertices, const Flips& flips) : mVertices(vertices), mFlips(flips) {}

    /// Go to a surface tile, the states of whose vertices are @a states, until the next call.
    void load(TileRef tile, const LocalStates& states);

    /// Call @a visit(StarTet) for each tet at vertex @a v of the tile, a local number; always in one order.
    template <typename Visit>
    void forEachTet(int v, Visit&& visit) const {
        const bcc::Lattice lattice = latticeOf(v);
        for (const Kin& kin : kKin[lattice]) visitLattice(v, kin, visit);
        const std::uint64_t slices = slicesAt(v);
        if (slices == 0) return;
        for (std::size_t role = 0; role < kRoles; ++role) {
            const auto slice = bcc::Slice(slices >> (2 * role) & 3);
            if (slice != bcc::S) visitFlipped(v, kOctahedraOf[lattice][role], slice, visit);
        }
    }

    /// Call @a visit(vertices) for the tets that a vertex has where nothing is flipped, in the same order.
    template <typename Visit>
    static void forEachLatticeTet(int v, Visit&& visit) {
        for (const Kin& kin : kKin[latticeOf(v)]) visit(kin.at(v));
    }

    /// @return how the octahedra of a vertex of the tile are cut, 2 bits each by role: 0 where none is
    /// flipped.
    std::uint64_t slicesAt(int v) const { return mSlices[std::size_t(v)]; }

private:
    /// A tet of slice S at a vertex: of the octahedron of a spine there, and of that of the ring edge.
    struct Kin {
        int spine, ring; ///< steps to the lower ends
        int spineAxis, ringAxis;
        int spineRole, ringRole;     ///< the vertex's in these octahedra
        std::array<int, 4> vertices; ///< steps
        int number;                  ///< in the octahedron that is L_A's

        std::array<int, 4> at(int v) const {
            return {v + vertices[0], v + vertices[1], v + vertices[2], v + vertices[3]};
        }
    };
    /// An octahedron that a vertex is in.
    struct Role {
        bcc::Lattice lattice;
        int axis;
        int lower;  ///< the step to the spine's lower end
        int vertex; ///< the vertex's number in it
    };
    static const std::array<std::array<Kin, 24>, 2> kKin;
    static const std::array<std::array<Role, kRoles>, 2> kOctahedraOf;
    static std::array<std::array<Kin, 24>, 2> makeKin();
    static std::array<std::array<Role, kRoles>, 2> makeRoles();

    Presence presenceOf(const StarTet& tet) const {
        int manifold = 0, interior = 0;
        for (const int v : tet.vertices) {
            manifold += mStates->manifold(v);
            interior += mStates->interior(v);
        }
        if (manifold + interior < 4) return Presence::Outside;
        const bool isChanged =
            !mChanged.empty() && std::binary_search(mChanged.begin(), mChanged.end(), keyOf(tet.name));
        if (isChanged) return manifold == 4 ? Presence::InMesh : Presence::Removed;
        return manifold == 4 ? Presence::Ambiguous : Presence::InMesh;
    }
    static int keyOf(const TetName& name) {
        return ((name.lattice * 3 + name.axis) * 4 + name.number) * kLocalVertices + name.lower;
    }
    template <typename Visit>
    void visitLattice(int v, const Kin& kin, Visit&& visit) const {
        const bcc::Lattice lattice = latticeOf(v);
        const std::uint64_t slices = slicesAt(v);
        if ((slices >> (2 * kin.spineRole) | slices >> (2 * kin.ringRole)) & 3) return;
        StarTet tet;
        tet.vertices = kin.at(v);
        tet.name = lattice == bcc::A ? TetName{bcc::A, kin.spineAxis, kin.number, v + kin.spine}
                                     : TetName{bcc::A, kin.ringAxis, kin.number, v + kin.ring};
        tet.presence = presenceOf(tet);
        visit(tet);
    }

    template <typename Visit>
    void visitFlipped(int v, const Role& role, bcc::Slice slice, Visit&& visit) const {
        const int lower = v + role.lower;
        const LocalOctahedron octahedron = localOctahedron(role.lattice, role.axis, lower);
        const auto& tets = bcc::kSliceTets[slice];
        for (int number = 0; number < 4; ++number) {
            StarTet tet;
            bool atV = false;
            for (int i = 0; i < 4; ++i) {
                atV = atV || tets[number][i] == role.vertex;
                tet.vertices[i] = octahedron[tets[number][i]];
            }
            if (!atV) continue;
            tet.name = {role.lattice, role.axis, number, lower};
            tet.presence = presenceOf(tet);
            visit(tet);
        }
    }

    const Vertices& mVertices;
    const Flips& mFlips;
    const LocalStates* mStates = nullptr;
    std::array<std::uint64_t, kLocalVertices> mSlices{}; ///< slicesAt()
    std::vector<int> mAtFlips;                           ///< the vertices where it is not 0, some twice
    std::vector<int> mChanged; ///< keyOf() of the tets in and around the tile that are changed, ascending
};

} // namespace vdbtet
