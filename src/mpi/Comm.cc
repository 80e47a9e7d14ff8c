/// @file Comm.cc
/// Messages in pieces whose size fits an int.
#include "mpi/Comm.h"

#include <vdbtet/Errors.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <new>

namespace vdbtet::mpi {

namespace {

constexpr std::size_t kPiece = std::size_t(1) << 30;

/// Call @a send(data, size) for the pieces of a message.
template <typename Send>
void inPieces(char* data, std::size_t size, const Send& send) {
    for (std::size_t done = 0; done < size; done += kPiece)
        send(data + done, int(std::min(kPiece, size - done)));
}

/// The types of errors that cross ranks, by number.
enum class Kind : std::int64_t { Option, Grid, Value, Surface, Unbounded, Large, File, Memory, Other, None };

struct Failure {
    Kind kind = Kind::None;
    std::string message;
};

Failure failureOf(const std::function<void()>& work) {
    try {
        work();
    } catch (const BadOption& error) {
        return {Kind::Option, error.what()};
    } catch (const UnsupportedGrid& error) {
        return {Kind::Grid, error.what()};
    } catch (const BadValue& error) {
        return {Kind::Value, error.what()};
    } catch (const NoSurface& error) {
        return {Kind::Surface, error.what()};
    } catch (const UnboundedInside& error) {
        return {Kind::Unbounded, error.what()};
    } catch (const TooLarge& error) {
        return {Kind::Large, error.what()};
    } catch (const FileError& error) {
        return {Kind::File, error.what()};
    } catch (const std::bad_alloc&) {
        return {Kind::Memory, ""};
    } catch (const std::exception& error) {
        return {Kind::Other, error.what()};
    }
    return {};
}

[[noreturn]] void raise(const Failure& failure) {
    switch (failure.kind) {
    case Kind::Option:
        throw BadOption(failure.message);
    case Kind::Grid:
        throw UnsupportedGrid(failure.message);
    case Kind::Value:
        throw BadValue(failure.message);
    case Kind::Surface:
        throw NoSurface(failure.message);
    case Kind::Unbounded:
        throw UnboundedInside(failure.message);
    case Kind::Large:
        throw TooLarge(failure.message);
    case Kind::File:
        throw FileError(failure.message);
    case Kind::Memory:
        throw Error("out of memory");
    default:
        throw Error(failure.message);
    }
}

} // namespace

Comm::Comm(MPI_Comm comm) {
    MPI_Comm_dup(comm, &mComm);
    MPI_Comm_rank(mComm, &mRank);
    MPI_Comm_size(mComm, &mSize);
}

Comm::~Comm() {
    // To free it is collective, and an exception may be this rank's alone.
    if (std::uncaught_exceptions() == 0) MPI_Comm_free(&mComm);
}

void Comm::together(const std::function<void()>& work) {
    Failure failure = failureOf(work);
    int first = failure.kind == Kind::None ? mSize : mRank;
    MPI_Allreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, mComm);
    if (first == mSize) return;
    failure.kind = Kind(std::stoll(fromRank(first, std::to_string(std::int64_t(failure.kind)))));
    failure.message = fromRank(first, failure.message);
    raise(failure);
}

void Comm::sum(std::int64_t* values, std::size_t count) const {
    MPI_Allreduce(MPI_IN_PLACE, values, int(count), MPI_INT64_T, MPI_SUM, mComm);
}

void Comm::least(double& value) const { MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MIN, mComm); }

void Comm::most(double& value) const { MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_DOUBLE, MPI_MAX, mComm); }

void Comm::most(std::int64_t& value) const {
    MPI_Allreduce(MPI_IN_PLACE, &value, 1, MPI_INT64_T, MPI_MAX, mComm);
}

bool Comm::any(bool value) const {
    int any = value ? 1 : 0;
    MPI_Allreduce(MPI_IN_PLACE, &any, 1, MPI_INT, MPI_MAX, mComm);
    return any != 0;
}

void Comm::barrier() const { MPI_Barrier(mComm); }

void Comm::broadcast(int from, char* data, std::size_t size) const {
    inPieces(data, size, [&](char* piece, int bytes) { MPI_Bcast(piece, bytes, MPI_CHAR, from, mComm); });
}

std::string Comm::fromRank(int from, const std::string& text) const {
    std::int64_t size = std::int64_t(text.size());
    MPI_Bcast(&size, 1, MPI_INT64_T, from, mComm);
    std::string result = text;
    result.resize(std::size_t(size));
    broadcast(from, result.data(), result.size());
    return result;
}

std::vector<std::int64_t> Comm::gatherSizes(std::int64_t own) {
    std::vector<std::int64_t> sizes(static_cast<std::size_t>(mSize));
    MPI_Allgather(&own, 1, MPI_INT64_T, sizes.data(), 1, MPI_INT64_T, mComm);
    if (mSize > 1) mToAll += own;
    return sizes;
}

std::vector<Bytes> Comm::exchange(const std::vector<Bytes>& out) {
    std::vector<std::int64_t> outSizes, inSizes(static_cast<std::size_t>(mSize));
    for (const Bytes& bytes : out) outSizes.push_back(std::int64_t(bytes.size()));
    MPI_Alltoall(outSizes.data(), 1, MPI_INT64_T, inSizes.data(), 1, MPI_INT64_T, mComm);
    std::vector<Bytes> in(static_cast<std::size_t>(mSize));
    std::vector<MPI_Request> requests;
    constexpr int kTag = 1;
    for (int other = 0; other < mSize; ++other) {
        Bytes& bytes = in[std::size_t(other)];
        if (other == mRank) {
            bytes = out[std::size_t(other)];
            continue;
        }
        bytes.resize(std::size_t(inSizes[std::size_t(other)]));
        inPieces(bytes.data(), bytes.size(), [&](char* piece, int size) {
            MPI_Irecv(piece, size, MPI_CHAR, other, kTag, mComm, &requests.emplace_back());
        });
    }
    for (int other = 0; other < mSize; ++other) {
        if (other == mRank) continue;
        const Bytes& bytes = out[std::size_t(other)];
        mToNeighbours += std::int64_t(bytes.size());
        inPieces(const_cast<char*>(bytes.data()), bytes.size(), [&](char* piece, int size) {
            MPI_Isend(piece, size, MPI_CHAR, other, kTag, mComm, &requests.emplace_back());
        });
    }
    MPI_Waitall(int(requests.size()), requests.data(), MPI_STATUSES_IGNORE);
    return in;
}

} // namespace vdbtet::mpi
