/// @file TileExchange.cc
/// Lists by rank.
#include "mpi/TileExchange.h"

#include <algorithm>

namespace vdbtet::mpi {

TileExchange::TileExchange(Comm& comm, const std::vector<std::int64_t>& own,
                           const std::vector<Borrowed>& borrowed, TileRef first)
    : mComm(comm), mLent(std::size_t(comm.size())), mBorrowed(std::size_t(comm.size())), mFirst(first) {
    std::vector<Bytes> wishes(std::size_t(comm.size()));
    for (const Borrowed& tile : borrowed) {
        pack(wishes[std::size_t(tile.owner)], tile.tile);
        ++mBorrowed[std::size_t(tile.owner)];
    }
    const std::vector<Bytes> asked = comm.exchange(wishes);
    for (std::size_t rank = 0; rank < asked.size(); ++rank) {
        for (Unpacker next(asked[rank]); !next.done();) {
            const auto tile = next.next<std::int64_t>();
            mLent[rank].push_back(TileRef(std::lower_bound(own.begin(), own.end(), tile) - own.begin()));
        }
    }
}

void TileExchange::exchange(const Pack& pack, const Unpack& unpack) const {
    std::vector<Bytes> out(mLent.size());
    for (std::size_t rank = 0; rank < mLent.size(); ++rank) {
        for (const TileRef tile : mLent[rank]) pack(tile, out[rank]);
    }
    const std::vector<Bytes> in = mComm.exchange(out);
    TileRef tile = mFirst;
    for (std::size_t rank = 0; rank < in.size(); ++rank) {
        Unpacker next(in[rank]);
        for (std::int64_t i = 0; i < mBorrowed[rank]; ++i) unpack(tile++, next);
    }
}

void TileExchange::unite(VertexMasks& masks) const {
    // Back to the owners, who then tell all.
    std::vector<Bytes> out(mLent.size());
    TileRef tile = mFirst;
    for (std::size_t rank = 0; rank < out.size(); ++rank) {
        for (std::int64_t i = 0; i < mBorrowed[rank]; ++i) pack(out[rank], masks[std::size_t(tile++)]);
    }
    const std::vector<Bytes> in = mComm.exchange(out);
    for (std::size_t rank = 0; rank < in.size(); ++rank) {
        Unpacker next(in[rank]);
        for (const TileRef lent : mLent[rank]) {
            const auto marked = next.next<VertexMasks::value_type>();
            for (std::size_t l = 0; l < marked.size(); ++l) masks[std::size_t(lent)][l] |= marked[l];
        }
    }
    exchange(masks);
}

} // namespace vdbtet::mpi
