/// @file RankFlips.cc
/// Chosen where they are owned, and lent.
#include "mpi/RankFlips.h"

namespace vdbtet::mpi {

Flips flipPart(Comm& comm, const Seams& beside, const Vertices& vertices, int version, Interrupt& interrupt) {
    Flips flips;
    comm.together([&] { flips = chooseFlips(vertices, version, interrupt); });
    // Tiles beside come right behind the own ones.
    beside.exchange(
        [&](TileRef t, Bytes& bytes) {
            const std::int64_t first = flips.first[std::size_t(t)], end = flips.first[std::size_t(t) + 1];
            pack(bytes, end - first);
            pack(bytes, flips.codes.data() + first, std::size_t(end - first));
        },
        [&](TileRef, Unpacker& next) {
            const auto count = std::size_t(next.next<std::int64_t>()), first = flips.codes.size();
            flips.codes.resize(first + count);
            next(flips.codes.data() + first, count);
            flips.first.push_back(std::int64_t(flips.codes.size()));
        });
    flips.first.resize(vertices.layout.surfaceTiles.size() + 1, flips.first.back());
    sumFlips(comm, flips);
    flips.conflictPlaces.clear();
    return flips;
}

void sumFlips(const Comm& comm, Flips& flips) {
    for (std::int64_t* sum :
         {&flips.active, &flips.extra, &flips.quality, &flips.lastResort, &flips.conflicts})
        comm.sum(*sum);
}

} // namespace vdbtet::mpi
