/// @file TileExchange.h
/// Keeps borrowed tiles' records up to date.
#pragma once

#include "mpi/Comm.h"

#include "tiles/Seams.h"

#include <cstdint>
#include <vector>

namespace vdbtet::mpi {

/// A tile of another rank.
struct Borrowed {
    int owner;
    std::int64_t tile; ///< its number among all surface tiles
};

/// @brief Knows who needs which of our tiles, and whose tiles we need, and sends records of any kind.
/// @details Made once for each set of tiles; collective like all of its members.
class TileExchange final : public Seams {
public:
    /// @param own       the numbers of our tiles among all surface tiles, ascending; their references are
    ///                  0, 1, ...
    /// @param borrowed  those we need, ascending by owner, then tile
    /// @param first     the reference of the first of these; the others follow
    TileExchange(Comm& comm, const std::vector<std::int64_t>& own, const std::vector<Borrowed>& borrowed,
                 TileRef first);

    using Seams::exchange;
    void exchange(const Pack& pack, const Unpack& unpack) const override;
    void unite(VertexMasks& masks) const override;
    void together(const std::function<void()>& work) const override { mComm.together(work); }
    void sum(std::int64_t& value) const override { mComm.sum(value); }
    bool any(bool value) const override { return mComm.any(value); }

private:
    Comm& mComm;
    std::vector<std::vector<TileRef>> mLent; ///< by rank
    std::vector<std::int64_t> mBorrowed;     ///< by rank, how many
    TileRef mFirst;
};

} // namespace vdbtet::mpi
