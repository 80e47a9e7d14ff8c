/// @file GridArchive.h
/// A .vdb file opened for reading: its table of contents, then any one of its grids.
///
/// openvdb::io::File serves the same end, but a file that ends too early reads as garbage where leaves are
/// stored uncompressed, one grid of a type it does not know spoils all others, and grids are listed with
/// their types only by way of reading them all. This archive reads with stream exceptions on.
#pragma once

#include <openvdb/Grid.h>
#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

namespace vdbtet {

/// All members throw std::ios_base::failure where the file ends too early, and openvdb's exceptions.
class GridArchive : private openvdb::io::Archive {
public:
    struct Entry {
        openvdb::io::GridDescriptor descriptor;
        openvdb::GridBase::Ptr grid; ///< holds no more than its type; null if OpenVDB does not know the type
    };

    /// @pre path names a regular file
    explicit GridArchive(const std::string& path);

    /// In file order.
    const std::vector<Entry>& entries() const { return mEntries; }
    /// Of the file itself.
    const openvdb::MetaMap& metadata() const { return mMetadata; }
    /// @return the grid's metadata and transform, mostly with an empty tree
    openvdb::GridBase::Ptr readHead(const Entry& entry);
    /// @throw FileError when this OpenVDB lacks the compression the grid is stored with
    openvdb::GridBase::Ptr read(const Entry& entry, bool delayLoad);

private:
    openvdb::GridBase::Ptr readHere(const Entry& entry);
    openvdb::GridBase::Ptr create(const Entry& entry) const;
    void requireCompression();

    std::string mPath;
    openvdb::io::StreamMetadata::Ptr mStreamMetadata; // the stream refers to it
    std::ifstream mStream;
    openvdb::MetaMap mMetadata;
    std::vector<Entry> mEntries;
};

} // namespace vdbtet
