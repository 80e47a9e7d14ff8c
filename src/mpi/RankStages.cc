/// @file RankStages.cc
/// Work and exchange, in turns.
#include "mpi/RankStages.h"

#include "labels/Labelling.h"

#include <chrono>
#include <utility>

namespace vdbtet::mpi {

Labels labelPart(Comm& comm, TileExchange& beside, const Layout& layout, const Arrows& arrows,
                 Interrupt& interrupt) {
    Labelling labelling(layout, arrows, interrupt);
    const auto exchange = [&] {
        beside(
            [&](TileRef t, Bytes& bytes) {
                pack(bytes, labelling.undecided()[std::size_t(t)]);
                pack(bytes, labelling.manifold()[std::size_t(t)]);
            },
            [&](TileRef t, Unpacker& next) {
                next(&labelling.undecided()[std::size_t(t)], 1);
                next(&labelling.manifold()[std::size_t(t)], 1);
            });
    };
    exchange();
    for (int round = 0; round < Labelling::kRounds; ++round) {
        for (bcc::Lattice lattice : {bcc::A, bcc::B}) {
            labelling.runPhase(lattice);
            exchange();
        }
    }
    Labels labels;
    const auto start = std::chrono::steady_clock::now();
    labels.backLabelled = labelling.findLeft();
    // Wherever a chain of arrows leads from rank to rank, each turn follows it to the next seam.
    while (comm.any(labelling.runWorklist())) exchange();
    labels.tieBroken = labelling.breakTies();
    exchange();
    comm.sum(labels.backLabelled);
    comm.sum(labels.tieBroken);
    labels.backLabelled -= labels.tieBroken;
    labels.worklistSeconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    labels.manifold = std::move(labelling.manifold());
    return labels;
}

void borrowDestinations(TileExchange& beside, const Labels& labels, Destinations& destinations) {
    // Of each lattice the moves of a tile lie side by side.
    const auto forEach = [&](TileRef t, const auto& visit) {
        for (int lattice = 0; lattice < 2; ++lattice)
            visit(destinations.first[std::size_t(t)][std::size_t(lattice)],
                  std::size_t(labels.manifold[std::size_t(t)][std::size_t(lattice)].count()));
    };
    beside(
        [&](TileRef t, Bytes& bytes) {
            forEach(t, [&](std::int64_t first, std::size_t count) {
                pack(bytes, destinations.distances.data() + first, count);
                pack(bytes, destinations.directions.data() + first, count);
            });
        },
        [&](TileRef t, Unpacker& next) {
            forEach(t, [&](std::int64_t first, std::size_t count) {
                next(destinations.distances.data() + first, count);
                next(destinations.directions.data() + first, count);
            });
        });
}

Flips flipPart(Comm& comm, TileExchange& beside, const Vertices& vertices, int version,
               Interrupt& interrupt) {
    Flips flips;
    comm.together([&] { flips = chooseFlips(vertices, version, interrupt); });
    // Tiles beside come right behind the own ones.
    beside(
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
    for (std::int64_t* sum :
         {&flips.active, &flips.extra, &flips.quality, &flips.lastResort, &flips.conflicts})
        comm.sum(*sum);
    flips.conflictPlaces.clear();
    return flips;
}

} // namespace vdbtet::mpi
