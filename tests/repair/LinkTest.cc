// How far a part of a sphere of triangles is from a disc.
#include "support/Catch.h"

#include "repair/Link.h"

using namespace vdbtet;

namespace {

/// Two poles and a ring of @a n vertices: triangle i is at the north of the edge from i to i + 1, n + i at
/// the south.
Link bipyramid(int n) {
    constexpr int kNorth = 100, kSouth = 200;
    Link link;
    for (int i = 0; i < n; ++i) link.add({kNorth, i, (i + 1) % n});
    for (int i = 0; i < n; ++i) link.add({kSouth, (i + 1) % n, i});
    link.close();
    return link;
}

LinkMask mask(std::initializer_list<int> triangles) {
    LinkMask result = 0;
    for (const int t : triangles) result |= LinkMask(1) << t;
    return result;
}

} // namespace

TEST_CASE("a disc, the whole sphere and nothing are not bad") {
    const Link link = bipyramid(6);
    CHECK(link.triangles() == 12);
    CHECK(link.vertices() == 8);
    CHECK(link.badness(0) == 0);
    CHECK(link.badness(link.all()) == 0);
    CHECK(link.badness(mask({0})) == 0);
    CHECK(link.badness(mask({0, 1, 2, 6})) == 0);
    CHECK(link.badness(mask({0, 1, 2, 3, 4, 5})) == 0); // a hemisphere, which surrounds the pole
    CHECK(link.badness(link.all() & ~mask({3})) == 0);
}

TEST_CASE("two fans are bad once for the second, and once more where they touch") {
    const Link link = bipyramid(6);
    CHECK(link.badness(mask({0, 9})) == 1);       // nothing shared
    CHECK(link.badness(mask({0, 3})) == 2);       // both at the north pole
    CHECK(link.badness(mask({0, 2, 4})) == 4);    // three of them there
    CHECK(link.badness(mask({0, 1, 8, 9})) == 2); // at vertex 2 of the ring
}

TEST_CASE("a fan with a hole is bad, and one that touches itself") {
    const Link link = bipyramid(8);
    // All but two triangles that share nothing: an annulus.
    CHECK(link.badness(link.all() & ~mask({0, 12})) == 1);
    CHECK(link.euler(link.all() & ~mask({0, 12})) == 0);
    // All but two triangles that share a vertex: a disc, if its two wedges there were apart.
    const LinkMask pinched = link.all() & ~mask({0, 4});
    CHECK(link.euler(pinched) == 1);
    CHECK(link.badness(pinched) == 1);
    CHECK(link.wedges(link.find(100), pinched) == 2);
}

TEST_CASE("fans are joined through edges, not through vertices") {
    const Link link = bipyramid(6);
    const LinkMask both = mask({0, 1, 3, 9});
    CHECK(link.joined(0, both) == mask({0, 1}));
    CHECK(link.joined(3, both) == mask({3, 9}));
    CHECK(link.joinedAround(link.find(100), 3, both) == mask({3}));
}
