/// @file Hdf5File.h
/// HDF5 files, made by the HDF5 library in a place of our choice instead of a file of its own: so that what
/// the library makes is laid out, written, counted and removed like all our files.
#pragma once

#include "io/NumberType.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace vdbtet {

/// Where the library's reads and writes go.
class Hdf5Storage {
public:
    virtual ~Hdf5Storage() = default;
    virtual void write(std::uint64_t offset, const void* data, std::size_t size) = 0;
    /// Bytes that were never written are zero.
    virtual void read(std::uint64_t offset, void* data, std::size_t size) = 0;
};

/// Memory for a file of which only little is written: all but its arrays.
class Hdf5Image final : public Hdf5Storage {
public:
    void write(std::uint64_t offset, const void* data, std::size_t size) override;
    void read(std::uint64_t offset, void* data, std::size_t size) override;

    /// @return all that was written of the first @a size bytes, by offset, with zeros between
    std::vector<std::pair<std::uint64_t, std::string>> pieces(std::uint64_t size) const;

private:
    static constexpr std::uint64_t kPageBytes = 512;

    std::map<std::uint64_t, std::array<char, kPageBytes>> mPages; ///< by offset / kPageBytes
};

/// What the library's handle of the file refers to.
struct Hdf5Device;

/// An array of one or two dimensions in a group.
struct Hdf5Array {
    std::string name;
    NumberType type;
    std::vector<std::uint64_t> extent;
    /// Rows a chunk, where the array is in chunks, which are compressed; 0 where it is in one piece.
    std::uint64_t chunkRows = 0;
    bool shuffled = false;
};

/// @brief An HDF5 file in the making, of the oldest version, which all read.
/// @details Has no times in it. The library is called under one lock, for few builds of it may be called by
/// several threads; it prints nothing. Every member but the destructor throws FileError where the library
/// fails, and what the storage throws.
class Hdf5File {
public:
    /// Group and array numbers are the library's.
    using Id = std::int64_t;

    /// @param storage  lives as long as the file; empty
    /// @param path     for messages
    Hdf5File(Hdf5Storage& storage, const std::string& path);
    ~Hdf5File();
    Hdf5File(const Hdf5File&) = delete;
    Hdf5File& operator=(const Hdf5File&) = delete;

    /// @param parent  default: the root
    Id addGroup(const std::string& name, Id parent = 0);
    /// Of fixed length, padded with nulls, ASCII.
    void addAttribute(Id group, const std::string& name, const std::string& value);
    void addAttribute(Id group, const std::string& name, const std::vector<std::int64_t>& values);
    void addNumber(Id group, const std::string& name, std::int64_t value);
    Id addArray(Id group, const Hdf5Array& array);

    /// @return where the data of an array in one piece are in the file; 0 for an empty one
    std::uint64_t offsetOf(Id array, const Hdf5Array& shape);
    /// Write a chunk, its filters applied.
    void writeChunk(Id array, const Hdf5Array& shape, std::uint64_t firstRow, const void* data,
                    std::size_t size);

    /// @return the size of the file
    std::uint64_t close();

private:
    class Session;

    /// @return false where the library fails
    bool letGo();

    std::string mPath;
    std::shared_ptr<Hdf5Device> mDevice;
    Id mDriver = -1, mFile = -1;
};

} // namespace vdbtet
