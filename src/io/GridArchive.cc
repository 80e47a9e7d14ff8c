/// @file GridArchive.cc
/// The head of a .vdb file, and its grids one by one.
#include "io/GridArchive.h"

#include <vdbtet/Errors.h>

#include <openvdb/Exceptions.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/File.h>
#include <openvdb/openvdb.h>
#include <openvdb/version.h>

#include <algorithm>
#include <array>

namespace vdbtet {

GridArchive::GridArchive(const std::string& path)
    : mPath(path), mStreamMetadata(new openvdb::io::StreamMetadata), mStream(path, std::ios_base::binary) {
    mStream.exceptions(std::ios_base::badbit | std::ios_base::failbit | std::ios_base::eofbit);
    readHeader(mStream);
    mStreamMetadata->setSeekable(inputHasGridOffsets());
    openvdb::io::setStreamMetadataPtr(mStream, mStreamMetadata, /*transfer=*/false);
    setFormatVersion(mStream);
    setLibraryVersion(mStream);
    setDataCompression(mStream);
    mMetadata.readMeta(mStream);

    const std::int32_t count = readGridCount(mStream);
    if (count < 0) throw FileError(mPath + " is damaged: it claims to hold a negative number of grids");
    NamedGridMap grids;
    for (std::int32_t i = 0; i < count; ++i) {
        Entry entry;
        try {
            entry.grid = entry.descriptor.read(mStream);
        } catch (const openvdb::LookupError&) {
            // Thrown between the type and the three offsets, of which the last leads to the next grid. A
            // file without offsets cannot be read past a grid of unknown type.
            if (!inputHasGridOffsets()) throw;
            std::array<std::int64_t, 3> offsets;
            mStream.read(reinterpret_cast<char*>(offsets.data()), sizeof offsets);
            mStream.seekg(offsets[2]);
            mEntries.push_back(entry);
            continue;
        }
        if (inputHasGridOffsets()) {
            entry.descriptor.seekToEnd(mStream);
        } else {
            requireCompression();
            readGrid(entry.grid, entry.descriptor, mStream);
            grids[entry.descriptor.uniqueName()] = entry.grid;
        }
        mEntries.push_back(entry);
    }
    if (!inputHasGridOffsets()) {
        for (const Entry& entry : mEntries) connectInstance(entry.descriptor, grids);
    }
}

openvdb::GridBase::Ptr GridArchive::readHead(const Entry& entry) {
    if (!inputHasGridOffsets()) return entry.grid;
    // Older files have the transform behind the tree.
    if (openvdb::io::getFormatVersion(mStream) < openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING)
        return read(entry, false);
    const auto grid = create(entry);
    entry.descriptor.seekToGrid(mStream);
    readGridCompression(mStream);
    grid->readMeta(mStream);
    grid->readTransform(mStream);
    return grid;
}

openvdb::GridBase::Ptr GridArchive::read(const Entry& entry, bool delayLoad) {
    if (!inputHasGridOffsets()) return entry.grid;
    entry.descriptor.seekToGrid(mStream);
    requireCompression();

    requireWhole(entry);

    const bool allKnown =
        std::all_of(mEntries.begin(), mEntries.end(), [](const Entry& e) { return e.grid; });
    if (delayLoad && allKnown) {
        openvdb::io::File file(mPath);
#ifdef OPENVDB_USE_DELAYED_LOADING
        file.setCopyMaxBytes(0); // it is mapped as it is
#endif
        file.open(/*delayLoad=*/true);
        return file.readGrid(openvdb::io::GridDescriptor::nameAsString(entry.descriptor.uniqueName()));
    }

    const auto grid = readHere(entry);
    if (entry.descriptor.isInstance()) {
        const auto parent = std::find_if(mEntries.begin(), mEntries.end(), [&](const Entry& e) {
            return e.descriptor.uniqueName() == entry.descriptor.instanceParentName() &&
                   !e.descriptor.isInstance();
        });
        if (parent == mEntries.end() || !parent->grid) {
            throw FileError(mPath + " is damaged: the grid shares its tree with one that is not there");
        }
        grid->setTree(readHere(*parent)->baseTreePtr());
    }
    return grid;
}

/// Buffers left on disk would be missed only when the mesher touches them, or never.
void GridArchive::requireWhole(const Entry& entry) {
    mStream.seekg(0, std::ios_base::end);
    if (entry.descriptor.getEndPos() > mStream.tellg()) {
        throw FileError(mPath + " ends before its grid does: it is truncated or damaged");
    }
}

openvdb::GridBase::Ptr GridArchive::readPart(const Entry& entry, const ChooseLeaves& choose) {
    if (entry.grid->isType<openvdb::FloatGrid>()) return readPartOf<openvdb::FloatGrid>(entry, choose);
    if (entry.grid->isType<openvdb::DoubleGrid>()) return readPartOf<openvdb::DoubleGrid>(entry, choose);
    return nullptr;
}

template <typename GridT>
openvdb::GridBase::Ptr GridArchive::readPartOf(const Entry& entry, const ChooseLeaves& choose) {
    // Older files, and grids that share the tree of another one, are read as a whole.
    const bool inParts =
        inputHasGridOffsets() && !entry.descriptor.isInstance() &&
        openvdb::io::getFormatVersion(mStream) >= openvdb::OPENVDB_FILE_VERSION_GRID_INSTANCING;
    typename GridT::Ptr grid;
    if (inParts) {
        entry.descriptor.seekToGrid(mStream);
        requireCompression();
        requireWhole(entry);
        // As openvdb::io::Archive::readGrid() does, up to the leaves.
        grid = openvdb::gridPtrCast<GridT>(create(entry));
        entry.descriptor.seekToGrid(mStream);
        readGridCompression(mStream);
        mStreamMetadata->setHalfFloat(grid->saveFloatAsHalf());
        openvdb::io::setGridClass(mStream, openvdb::GRID_UNKNOWN);
        openvdb::io::setGridBackgroundValuePtr(mStream, nullptr);
        grid->readMeta(mStream);
        openvdb::io::setGridClass(mStream, grid->getGridClass());
        grid->removeMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD);
        grid->readTransform(mStream);
        grid->readTopology(mStream);
    } else {
        grid = openvdb::gridPtrCast<GridT>(read(entry, false));
    }

    auto& tree = grid->tree();
    std::vector<openvdb::Coord> blocks;
    for (auto leaf = tree.cbeginLeaf(); leaf; ++leaf) blocks.push_back(leaf->origin() >> 3);
    const std::vector<bool> wanted = choose(blocks);
    if (inParts) {
        // Leaves are stored in the order of the tree. One that is outside of the box is passed over.
        const openvdb::CoordBBox nowhere(openvdb::Coord::min(), openvdb::Coord::min());
        std::size_t number = 0;
        for (auto leaf = tree.beginLeaf(); leaf; ++leaf, ++number) {
            leaf->readBuffers(mStream, wanted[number] ? leaf->getNodeBoundingBox() : nowhere,
                              grid->saveFloatAsHalf());
        }
        openvdb::io::setGridBackgroundValuePtr(mStream, nullptr);
    }
    for (std::size_t i = 0; i < blocks.size(); ++i) {
        if (wanted[i]) continue;
        const openvdb::Coord& block = blocks[i];
        tree.addTile(1, openvdb::Coord(8 * block.x(), 8 * block.y(), 8 * block.z()), grid->background(),
                     false);
    }
    return grid;
}

openvdb::GridBase::Ptr GridArchive::readHere(const Entry& entry) {
    const auto grid = create(entry);
    entry.descriptor.seekToGrid(mStream);
    readGrid(grid, entry.descriptor, mStream);
    return grid;
}

openvdb::GridBase::Ptr GridArchive::create(const Entry& entry) const {
    const auto grid = openvdb::GridBase::createGrid(entry.descriptor.gridType());
    grid->setSaveFloatAsHalf(entry.grid->saveFloatAsHalf());
    return grid;
}

/// @pre the stream is where a grid begins; it is left there
void GridArchive::requireCompression() {
    const auto position = mStream.tellg();
    readGridCompression(mStream);
    const auto flags = openvdb::io::getDataCompression(mStream);
    mStream.seekg(position);
    const bool blosc = (flags & openvdb::io::COMPRESS_BLOSC) && !hasBloscCompression();
    const bool zip = (flags & openvdb::io::COMPRESS_ZIP) && !hasZLibCompression();
    if (!blosc && !zip) return;
    const std::string codec = blosc ? "Blosc" : "zlib";
    throw FileError(mPath + " is compressed with " + codec + ", but OpenVDB " OPENVDB_LIBRARY_VERSION_STRING +
                    " was built here without it: install an OpenVDB with " + codec +
                    ", or save the file with another compression");
}

} // namespace vdbtet
