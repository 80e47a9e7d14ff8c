/// @file LeafExchange.h
/// Voxels, from the ranks that have read them to those that need them.
#pragma once

#include "mpi/Comm.h"
#include "mpi/Partition.h"

#include <openvdb/Grid.h>

#include <memory>
#include <vector>

namespace vdbtet::mpi {

/// @brief Make a rank's part of a grid another part.
/// @param finders  which rank has read which blocks of 8^3 voxels, at least
/// @param blocks   of all leaves of the whole grid
/// @param needs    needs(block): whether this rank does
/// @param grid     with the leaves that this rank has read; then with those that it needs, and elsewhere its
///                 background
template <typename GridT, typename Needs>
void exchangeLeaves(Comm& comm, const CurvePartition& finders, const std::vector<openvdb::Coord>& blocks,
                    const Needs& needs, GridT& grid) {
    using LeafT = typename GridT::TreeType::LeafNodeType;
    using openvdb::Coord;
    auto& tree = grid.tree();
    const auto originOf = [](const Coord& block) {
        return Coord(8 * block.x(), 8 * block.y(), 8 * block.z());
    };
    std::vector<std::vector<Coord>> wishes(std::size_t(comm.size()));
    std::vector<Coord> needless;
    std::vector<Bytes> out(wishes.size());
    comm.together([&] {
        for (const Coord& block : blocks) {
            const bool has = tree.probeConstLeaf(originOf(block)) != nullptr;
            const bool need = needs(block);
            if (need && !has) wishes[std::size_t(finders(block))].push_back(block);
            if (has && !need) needless.push_back(block);
        }
        for (std::size_t rank = 0; rank < out.size(); ++rank)
            pack(out[rank], wishes[rank].data(), wishes[rank].size());
    });
    const std::vector<Bytes> asked = comm.exchange(out);
    comm.together([&] {
        for (std::size_t rank = 0; rank < out.size(); ++rank) {
            out[rank].clear();
            for (Unpacker next(asked[rank]); !next.done();) {
                const LeafT* leaf = tree.probeConstLeaf(originOf(next.next<Coord>()));
                pack(out[rank], leaf->buffer().data(), LeafT::SIZE);
            }
        }
        for (const Coord& block : needless) tree.addTile(1, originOf(block), grid.background(), false);
    });
    const std::vector<Bytes> in = comm.exchange(out);
    comm.together([&] {
        for (std::size_t rank = 0; rank < in.size(); ++rank) {
            Unpacker next(in[rank]);
            for (const Coord& block : wishes[rank]) {
                auto leaf = std::make_unique<LeafT>(originOf(block), grid.background());
                next(leaf->buffer().data(), LeafT::SIZE);
                tree.addLeaf(leaf.release());
            }
        }
    });
}

} // namespace vdbtet::mpi
