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
        vdbtet::mpi::pack(wishes[std::size_t(tile.owner)], tile.tile);
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

void TileExchange::operator()(const Pack& pack, const Unpack& unpack) {
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

} // namespace vdbtet::mpi
