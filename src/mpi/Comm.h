/// @file Comm.h
/// The few ways in which ranks talk, and how an error of one of them ends the work of all.
#pragma once

#include "tiles/Bytes.h"

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace vdbtet::mpi {

/// @brief A communicator of its own, with the ranks of the caller's.
/// @details All members but rank() and size() are collective. They are called by one thread, and throw
/// nothing of their own: errors of MPI go the way of the communicator's error handler. Sizes have 64 bits.
class Comm {
public:
    explicit Comm(MPI_Comm comm);
    ~Comm();
    Comm(const Comm&) = delete;
    Comm& operator=(const Comm&) = delete;

    int rank() const { return mRank; }
    int size() const { return mSize; }

    /// Bytes that this rank has sent: to its neighbours, and to all others.
    std::int64_t sentToNeighbours() const { return mToNeighbours; }
    std::int64_t sentToAll() const { return mToAll; }

    /// @brief Do work that is this rank's alone, and that may throw.
    /// @throw what it throws; and on all other ranks the same, of the lowest rank that it failed on
    void together(const std::function<void()>& work);

    /// Make each number the sum, the least or the most of all ranks'.
    void sum(std::int64_t* values, std::size_t count) const;
    void sum(std::int64_t& value) const { sum(&value, 1); }
    void least(double& value) const;
    void most(double& value) const;
    void most(std::int64_t& value) const;
    bool any(bool value) const;

    void barrier() const;

    /// @return what @a from has
    std::string fromRank(int from, const std::string& text) const;

    /// Call @a visit(list) with what each rank has, by rank; of others' lists one at a time is kept.
    template <typename T, typename Visit>
    void forEachRank(const std::vector<T>& own, const Visit& visit) {
        static_assert(std::is_trivially_copyable_v<T>);
        const std::vector<std::int64_t> sizes = gatherSizes(std::int64_t(own.size() * sizeof(T)));
        for (int from = 0; from < mSize; ++from) {
            const auto size = std::size_t(sizes[std::size_t(from)]);
            std::vector<T> others(from == mRank ? 0 : size / sizeof(T));
            const std::vector<T>& list = from == mRank ? own : others;
            broadcast(from, const_cast<char*>(reinterpret_cast<const char*>(list.data())), size);
            visit(list);
        }
    }

    /// @return what all ranks have, by rank
    template <typename T>
    std::vector<std::vector<T>> gather(const std::vector<T>& own) {
        std::vector<std::vector<T>> all;
        forEachRank(own, [&](const std::vector<T>& list) { all.push_back(list); });
        return all;
    }

    /// @param out  to each rank
    /// @return from each rank
    std::vector<Bytes> exchange(const std::vector<Bytes>& out);

private:
    /// @return the bytes that each rank is about to send to all
    std::vector<std::int64_t> gatherSizes(std::int64_t own);
    void broadcast(int from, char* data, std::size_t size) const;

    MPI_Comm mComm = MPI_COMM_NULL;
    int mRank = 0, mSize = 1;
    std::int64_t mToNeighbours = 0, mToAll = 0;
};

} // namespace vdbtet::mpi
