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
#include <functional>
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

    /// Is given the blocks of 8^3 voxels that have leaves, and returns for each whether it is wanted.
    using ChooseLeaves = std::function<std::vector<bool>(const std::vector<openvdb::Coord>& blocks)>;

    /// @brief Read a float or double grid, but of its leaves only those that @a choose wants; where the
    /// others are the grid has its background.
    /// @details All nodes are read, but no values of the leaves that are not wanted.
    /// @return null for a grid of another type
    /// @throw FileError as above
    openvdb::GridBase::Ptr readPart(const Entry& entry, const ChooseLeaves& choose);

private:
    void requireWhole(const Entry& entry);
    template <typename GridT>
    openvdb::GridBase::Ptr readPartOf(const Entry& entry, const ChooseLeaves& choose);
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
