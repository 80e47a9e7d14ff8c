/// @file GridArchive.cc
/// The head of a .vdb file, and its grids one by one.
#include "io/GridArchive.h"

#include <vdbtet/Errors.h>

#include <openvdb/Exceptions.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/File.h>
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

    // Buffers left on disk would be missed only when the mesher touches them.
    mStream.seekg(0, std::ios_base::end);
    if (entry.descriptor.getEndPos() > mStream.tellg()) {
        throw FileError(mPath + " ends before its grid does: it is truncated or damaged");
    }

    const bool allKnown =
        std::all_of(mEntries.begin(), mEntries.end(), [](const Entry& e) { return e.grid; });
    if (delayLoad && allKnown) {
        openvdb::io::File file(mPath);
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
