/// @file TileExchange.h
/// Keeps borrowed tiles' records up to date.
#pragma once

#include "mpi/Comm.h"

#include "tiles/Spans.h"

#include <cstdint>
#include <functional>
#include <vector>

namespace vdbtet::mpi {

/// A tile of another rank.
struct Borrowed {
    int owner;
    std::int64_t tile; ///< its number among all surface tiles
};

/// @brief Knows who needs which of our tiles, and whose tiles we need, and sends records of any kind.
/// @details Made once for each set of tiles; collective like all of its members.
class TileExchange {
public:
    using Pack = std::function<void(TileRef, Bytes&)>;
    using Unpack = std::function<void(TileRef, Unpacker&)>;

    /// @param own       the numbers of our tiles among all surface tiles, ascending; their references are
    ///                  0, 1, ...
    /// @param borrowed  those we need, ascending by owner, then tile
    /// @param first     the reference of the first of these; the others follow
    TileExchange(Comm& comm, const std::vector<std::int64_t>& own, const std::vector<Borrowed>& borrowed,
                 TileRef first);

    /// Send the records of our tiles that others have borrowed, and get those that we have.
    /// @param unpack  called in ascending order of the tiles' references
    void operator()(const Pack& pack, const Unpack& unpack);

    /// Of a record of one size for each tile.
    template <typename Records>
    void operator()(Records& records) {
        (*this)([&](TileRef t, Bytes& bytes) { pack(bytes, records[std::size_t(t)]); },
                [&](TileRef t, Unpacker& next) { next(&records[std::size_t(t)], 1); });
    }

private:
    Comm& mComm;
    std::vector<std::vector<TileRef>> mLent; ///< by rank
    std::vector<std::int64_t> mBorrowed;     ///< by rank, how many
    TileRef mFirst;
};

} // namespace vdbtet::mpi
