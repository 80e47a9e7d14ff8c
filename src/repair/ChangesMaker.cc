/// @file ChangesMaker.cc
/// Tets, vertices and faces, each by the tile that owns it.
#include "repair/ChangesMaker.h"

#include <algorithm>
#include <utility>

namespace vdbtet {

namespace {

/// A face of a tet of a star, from outside the tet, as the tile sees it that owns the tet.
LocalFace faceOf(const StarTet& tet, int opposite, int stepToOwner) {
    LocalFace face = faceOpposite(tet.vertices, opposite);
    for (int& v : face) v -= stepToOwner;
    return face;
}

/// The step from a star's tile to the one that owns one of its tets, as a difference of local numbers.
int stepToOwner(const StarTet& tet) {
    const int n = bitOf(tet.name.lower);
    return PaddedMask::step(8 * tileStep(PaddedMask::x(n)), 8 * tileStep(PaddedMask::y(n)),
                            8 * tileStep(PaddedMask::z(n)));
}

LocalFace ascending(LocalFace face) {
    std::sort(face.begin(), face.end());
    return face;
}

bool has(LinkMask mask, int t) { return mask >> t & 1; }

} // namespace

void ChangesMaker::addTets(BoundaryCounts& counts) {
    for (const std::int64_t id : mRounds.toggled()) mTiles[TetId::tile(id)].tets.push_back(TetId::code(id));
    std::set<std::int64_t> filled, peeled;
    Star star;
    for (const std::int64_t vertex : mRounds.changed()) {
        mRounds.read(vertex, star);
        noteVertex(star);
        for (LinkMask toggled = star.in ^ star.inBefore; toggled != 0; toggled &= toggled - 1) {
            const int t = __builtin_ctzll(toggled);
            (has(star.in, t) ? filled : peeled).insert(star.ids[std::size_t(t)]);
            for (int side = 0; side < 3; ++side) noteFace(star, t, side);
        }
    }
    counts.filled = std::int64_t(filled.size());
    counts.peeled = std::int64_t(peeled.size());
}

void ChangesMaker::noteVertex(const Star& star) {
    const int n = bitOf(star.vertex);
    const bcc::Lattice lattice = latticeOf(star.vertex);
    const int bit = TileMask::bit(PaddedMask::x(n), PaddedMask::y(n), PaddedMask::z(n));
    TileChanges& tile = mTiles[star.tile];
    const bool manifold = mVertices.labels.manifold[star.tile][lattice].test(bit);
    const bool used = star.in != 0, usedBefore = star.inBefore != 0;
    if (used && !usedBefore) tile.used[lattice].set(bit);
    if (!used && usedBefore) tile.unused[lattice].set(bit);
    if (used && star.in != star.link.all() && !manifold) tile.exposed[lattice].set(bit);
    if (star.in == star.link.all() && manifold) tile.buried[lattice].set(bit);
}

void ChangesMaker::noteFace(const Star& star, int t, int side) {
    const int beyond = star.link.beyond(t, side);
    const std::int64_t id = star.ids[std::size_t(t)], other = star.ids[std::size_t(beyond)];
    const StarTet &tet = star.tets[std::size_t(t)], &otherTet = star.tets[std::size_t(beyond)];
    const int apex = star.link.name(star.link.corner(t, (side + 2) % 3)),
              otherApex = star.link.name(star.link.otherCorner(beyond, t));
    // Two tets share one face; but those that no surface tile owns are all alike here.
    if (!mFaces.insert({std::min(id, other), std::max(id, other), other < 0 ? apex - stepToOwner(tet) : 0})
             .second)
        return;

    const auto owner = [&](LinkMask in) { return has(in, t) == has(in, beyond) ? 0 : has(in, t) ? 1 : 2; };
    const int before = owner(star.inBefore), now = owner(star.in);
    if (before == now) return;
    const auto note = [&](int which, std::vector<LocalFace> TileChanges::*faces) {
        if (which == 0) return;
        const std::int64_t of = which == 1 ? id : other;
        const StarTet& its = which == 1 ? tet : otherTet;
        if (of < 0) {
            mLeavesSurface = true;
            return;
        }
        (mTiles[TetId::tile(of)].*faces)
            .push_back(faceOf(its, which == 1 ? apex : otherApex, stepToOwner(its)));
    };
    note(before, &TileChanges::gone);
    note(now, &TileChanges::fresh);
}

void ChangesMaker::split(BoundaryCounts& counts) {
    Star star;
    for (const std::int64_t vertex : mRounds.bad()) {
        mRounds.read(vertex, star);
        std::vector<std::pair<std::int64_t, LinkMask>> fans; // by the lowest tet
        for (LinkMask left = star.in; left != 0;) {
            const LinkMask fan = star.link.joined(__builtin_ctzll(left), star.in);
            left &= ~fan;
            std::int64_t lowest = star.ids[std::size_t(__builtin_ctzll(fan))];
            for (int t = 0; t < star.size; ++t) {
                if (has(fan, t)) lowest = std::min(lowest, star.ids[std::size_t(t)]);
            }
            fans.emplace_back(lowest, fan);
        }
        std::sort(fans.begin(), fans.end());
        auto& copies = mTiles[star.tile].copies;
        for (std::size_t i = 1; i < fans.size(); ++i) {
            splitOff(star, fans[i].second, int(copies.size()));
            copies.push_back(std::uint16_t(vertex & 1023));
            ++counts.split;
        }
    }
}

void ChangesMaker::splitOff(const Star& star, LinkMask fan, int copy) {
    for (LinkMask left = fan; left != 0; left &= left - 1) {
        const int t = __builtin_ctzll(left);
        const StarTet& tet = star.tets[std::size_t(t)];
        const std::int64_t id = star.ids[std::size_t(t)];
        if (id < 0) {
            mLeavesSurface = true;
            continue;
        }
        const int step = stepToOwner(tet);
        TileChanges& owner = mTiles[TetId::tile(id)];
        const TileChanges::Copy corner{star.vertex - step, copy};
        owner.tetCopies.push_back({TetId::code(id), corner});
        for (int side = 0; side < 3; ++side) {
            if (has(star.in, star.link.beyond(t, side))) continue;
            const int apex = star.link.name(star.link.corner(t, (side + 2) % 3));
            owner.faceCopies.push_back({ascending(faceOf(tet, apex, step)), corner});
        }
    }
}

Changes ChangesMaker::take() {
    Changes changes;
    changes.numbers.assign(mVertices.layout.surfaceTiles.size(), -1);
    for (auto& [tile, its] : mTiles) {
        std::sort(its.tetCopies.begin(), its.tetCopies.end(),
                  [](const auto& a, const auto& b) { return a.tet < b.tet; });
        std::sort(its.faceCopies.begin(), its.faceCopies.end(),
                  [](const auto& a, const auto& b) { return a.face < b.face; });
        changes.numbers[tile] = std::int32_t(changes.tiles.size());
        changes.tiles.push_back(std::move(its));
    }
    return changes;
}

} // namespace vdbtet
