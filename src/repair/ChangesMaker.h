/// @file ChangesMaker.h
/// From toggled tets and bad vertices to what each tile has to know.
#pragma once

#include "destinations/Changes.h"
#include "repair/Rounds.h"

#include <vdbtet/VolumeToTets.h>

#include <array>
#include <cstdint>
#include <map>
#include <set>

namespace vdbtet {

class ChangesMaker {
public:
    /// @param rounds  all done
    ChangesMaker(const Vertices& vertices, Rounds& rounds) : mVertices(vertices), mRounds(rounds) {}

    /// Note the toggled tets, and what they do to vertices and faces.
    void addTets(BoundaryCounts& counts);

    /// Give each fan of tets at a bad vertex a point of its own; the one with the lowest tet keeps the first.
    void split(BoundaryCounts& counts);

    Changes take();

    /// @return whether a changed face belongs to a tet that no surface tile owns.
    bool leavesSurface() const { return mLeavesSurface; }

private:
    void noteVertex(const Star& star);
    void noteFace(const Star& star, int t, int side);
    void splitOff(const Star& star, LinkMask fan, int copy);

    const Vertices& mVertices;
    Rounds& mRounds;
    std::map<TileRef, TileChanges> mTiles;
    std::set<std::array<std::int64_t, 3>> mFaces; ///< those noted
    bool mLeavesSurface = false;
};

} // namespace vdbtet
