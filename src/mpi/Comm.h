/// @file Comm.h
/// The few ways in which ranks talk, and how an error of one of them ends the work of all.
#pragma once

#include <mpi.h>

#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <type_traits>
#include <vector>

namespace vdbtet::mpi {

/// Bytes on their way to or from a rank.
using Bytes = std::vector<char>;

template <typename T>
void pack(Bytes& bytes, const T* values, std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T>);
    const auto* from = reinterpret_cast<const char*>(values);
    bytes.insert(bytes.end(), from, from + count * sizeof(T));
}
template <typename T>
void pack(Bytes& bytes, const T& value) {
    pack(bytes, &value, 1);
}

/// Reads what pack() has put there, in the same order.
class Unpacker {
public:
    explicit Unpacker(const Bytes& bytes) : mNext(bytes.data()), mEnd(bytes.data() + bytes.size()) {}

    template <typename T>
    void operator()(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count == 0) return;
        std::memcpy(static_cast<void*>(values), mNext, count * sizeof(T));
        mNext += count * sizeof(T);
    }
    template <typename T>
    T next() {
        T value;
        (*this)(&value, 1);
        return value;
    }
    bool done() const { return mNext == mEnd; }

private:
    const char *mNext, *mEnd;
};

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

    /// @return what all ranks have, by rank
    std::vector<Bytes> gather(const Bytes& own);
    template <typename T>
    std::vector<std::vector<T>> gather(const std::vector<T>& own) {
        Bytes bytes;
        pack(bytes, own.data(), own.size());
        std::vector<std::vector<T>> all;
        for (Bytes& part : gather(bytes)) {
            all.emplace_back(part.size() / sizeof(T));
            Unpacker next(part);
            next(all.back().data(), all.back().size());
            Bytes().swap(part);
        }
        return all;
    }

    /// @param out  to each rank
    /// @return from each rank
    std::vector<Bytes> exchange(const std::vector<Bytes>& out);

private:
    void broadcast(int from, char* data, std::size_t size) const;

    MPI_Comm mComm = MPI_COMM_NULL;
    int mRank = 0, mSize = 1;
    std::int64_t mToNeighbours = 0, mToAll = 0;
};

} // namespace vdbtet::mpi
