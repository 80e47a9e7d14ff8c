/// @file Link.cc
/// Triangles as bits of a word.
#include "repair/Link.h"

#include <cassert>
#include <cstdlib>

namespace vdbtet {

namespace {

int count(LinkMask mask) { return __builtin_popcountll(mask); }
int lowest(LinkMask mask) { return __builtin_ctzll(mask); }

} // namespace

void Link::add(const std::array<int, 3>& vertices) {
    assert(mTriangles < kMostTriangles);
    for (std::size_t i = 0; i < 3; ++i) {
        const std::size_t slot = slotOf(vertices[i]);
        int v = mSlots[slot];
        if (v < 0) {
            assert(mVertices < kMostVertices);
            v = mVertices++;
            mSlots[slot] = std::int8_t(v);
            mNames[v] = vertices[i];
            mAt[v] = 0;
        }
        mCorners[mTriangles][i] = std::uint8_t(v);
        mAt[v] |= LinkMask(1) << mTriangles;
    }
    ++mTriangles;
}

/// The slot that has a name, or that it goes into.
std::size_t Link::slotOf(int name) const {
    std::size_t slot = std::uint32_t(name) * 0x9e3779b1u >> 26;
    while (mSlots[slot] >= 0 && mNames[mSlots[slot]] != name) slot = (slot + 1) % mSlots.size();
    return slot;
}

int Link::find(int name) const { return mSlots[slotOf(name)]; }

void Link::close() {
    for (int t = 0; t < mTriangles; ++t) {
        for (std::size_t i = 0; i < 3; ++i) {
            // Two triangles share an edge.
            const LinkMask both = mAt[mCorners[t][i]] & mAt[mCorners[t][(i + 1) % 3]] & ~(LinkMask(1) << t);
            assert(count(both) == 1);
            mBeyond[t][i] = std::uint8_t(lowest(both));
        }
    }
}

LinkMask Link::joined(int from, LinkMask among) const {
    LinkMask reached = LinkMask(1) << from;
    for (LinkMask fresh = reached; fresh != 0;) {
        LinkMask next = 0;
        for (; fresh != 0; fresh &= fresh - 1) {
            for (const std::uint8_t t : mBeyond[lowest(fresh)]) next |= LinkMask(1) << t;
        }
        fresh = next & among & ~reached;
        reached |= fresh;
    }
    return reached;
}

LinkMask Link::joinedAround(int vertex, int from, LinkMask among) const {
    // Triangles about a vertex that are neighbours share an edge at it, the star being more than a triangle.
    return joined(from, among & mAt[vertex]);
}

int Link::wedges(int vertex, LinkMask in) const {
    int ends = 0;
    for (LinkMask left = in & mAt[vertex]; left != 0; left &= left - 1) {
        const int t = lowest(left);
        for (std::size_t i = 0; i < 3; ++i) {
            if (mCorners[t][i] == vertex) ends += !(in >> mBeyond[t][i] & 1);
        }
    }
    return ends;
}

int Link::euler(LinkMask fan) const {
    // With F faces, B edges at its border, and I vertices that it surrounds: a vertex has as many wedges as
    // border edges that start there, so there are B + I of them, and (3 F + B) / 2 edges.
    int border = 0;
    LinkMask open = 0; // the triangles about a vertex of the border
    for (LinkMask left = fan; left != 0; left &= left - 1) {
        const int t = lowest(left);
        for (std::size_t i = 0; i < 3; ++i) {
            if (fan >> mBeyond[t][i] & 1) continue;
            ++border;
            open |= LinkMask(1) << mCorners[t][i];
        }
    }
    int surrounded = 0;
    for (int v = 0; v < mVertices; ++v) surrounded += (fan & mAt[v]) != 0 && !(open >> v & 1);
    return surrounded + (border - count(fan)) / 2;
}

int Link::badness(LinkMask in) const {
    if (in == 0 || in == all()) return 0;
    int bad = -1;
    for (LinkMask left = in; left != 0;) {
        const LinkMask fan = joined(lowest(left), in);
        left &= ~fan;
        bad += 1 + std::abs(1 - euler(fan));
    }
    for (int v = 0; v < mVertices; ++v) {
        const int about = wedges(v, in);
        if (about > 1) bad += about - 1;
    }
    return bad;
}

} // namespace vdbtet
