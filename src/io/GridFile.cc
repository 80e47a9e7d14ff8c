/// @file GridFile.cc
/// Which grid of a .vdb file is meant, and what to say when none is.
#include <vdbtet/GridFile.h>

#include <vdbtet/Errors.h>
#include <vdbtet/FieldSampler.h>

#include "io/GridArchive.h"
#include "io/GridPart.h"

#include <openvdb/openvdb.h>

#include <sys/stat.h>

#include <algorithm>
#include <cctype>
#include <cerrno>
#include <cstring>
#include <new>

namespace vdbtet {

namespace {

using Entry = GridArchive::Entry;

/// What else people call .vdb, by its first bytes.
std::string hint(const std::string& head) {
    const auto starts = [&](const char* with) { return head.rfind(with, 0) == 0; };
    if (head.empty()) return ": it is empty";
    if (starts("\x1f\x8b")) return ": it is compressed with gzip, so gunzip it first";
    if (starts("NanoVDB")) return ": it is a NanoVDB file, so convert it with nanovdb_convert first";
    if (starts("version https://git-lfs")) return ": it is a Git LFS pointer, so run 'git lfs pull' first";
    return "";
}

void requireVdbFile(const std::string& path) {
    struct stat info = {};
    if (::stat(path.c_str(), &info) != 0) {
        throw FileError("cannot read " + path + ": " + std::strerror(errno));
    }
    if (S_ISDIR(info.st_mode)) throw FileError("cannot read " + path + ": " + std::strerror(EISDIR));
    if (!S_ISREG(info.st_mode)) throw FileError("cannot read " + path + ": it is not a regular file");

    std::ifstream stream(path, std::ios_base::binary);
    if (!stream) throw FileError("cannot read " + path + ": " + std::strerror(errno));
    std::string head(24, '\0');
    stream.read(head.data(), static_cast<std::streamsize>(head.size()));
    head.resize(static_cast<std::size_t>(stream.gcount()));
    std::int64_t magic = 0;
    if (head.size() >= sizeof magic) std::memcpy(&magic, head.data(), sizeof magic);
    if (magic != openvdb::OPENVDB_MAGIC) throw FileError(path + " is not a .vdb file" + hint(head));
}

std::string plainName(const Entry& entry) {
    return openvdb::io::GridDescriptor::stripSuffix(entry.descriptor.uniqueName());
}

bool isScalar(const Entry& entry) {
    return entry.grid &&
           (entry.grid->isType<openvdb::FloatGrid>() || entry.grid->isType<openvdb::DoubleGrid>());
}

std::vector<std::size_t> namesakes(const std::vector<Entry>& entries, const std::string& name) {
    std::vector<std::size_t> found;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (plainName(entries[i]) == name) found.push_back(i);
    }
    return found;
}

openvdb::GridClass classOf(GridArchive& archive, const Entry& entry) {
    return entry.grid ? archive.readHead(entry)->getGridClass() : openvdb::GRID_UNKNOWN;
}

/// The name that findByName() takes for an entry.
std::string uniqueName(const std::vector<Entry>& entries, std::size_t index) {
    const std::string name = plainName(entries[index]);
    const auto same = namesakes(entries, name);
    if (same.size() == 1 && !name.empty()) return name;
    return name + "[" + std::to_string(std::find(same.begin(), same.end(), index) - same.begin()) + "]";
}

/// One line such as "density (float, fog volume), v[0] (vec3s, unknown), v[1] (vec3s, unknown)".
std::string listing(GridArchive& archive) {
    constexpr std::size_t maxGrids = 30, maxName = 60;
    const auto& entries = archive.entries();
    std::string list;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (i > 0) list += ", ";
        if (i == maxGrids) return list + "and " + std::to_string(entries.size() - i) + " more";

        std::string name = uniqueName(entries, i);
        if (name.size() > maxName) name = name.substr(0, maxName) + "...";
        list += name + " (";
        list += entries[i].grid ? entries[i].grid->valueType() + ", " +
                                      openvdb::GridBase::gridClassToString(classOf(archive, entries[i]))
                                : entries[i].descriptor.gridType() + ", a type OpenVDB does not know";
        list += ")";
    }
    return list;
}

/// The index of the grid that @a name means, not empty.
std::size_t findByName(GridArchive& archive, const std::string& path, const std::string& name) {
    const auto& entries = archive.entries();
    const auto same = namesakes(entries, name);
    if (same.size() == 1) return same[0];
    if (same.size() > 1) {
        throw FileError(path + " holds " + std::to_string(same.size()) + " grids named \"" + name +
                        "\": choose one as NAME[0] ... NAME[" + std::to_string(same.size() - 1) + "]");
    }
    const auto bracket = name.rfind('[');
    if (bracket != std::string::npos && name.back() == ']') {
        const std::string digits = name.substr(bracket + 1, name.size() - bracket - 2);
        const auto indexed = namesakes(entries, name.substr(0, bracket));
        const bool isNumber =
            !digits.empty() && digits.size() < 9 &&
            std::all_of(digits.begin(), digits.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
        if (isNumber && std::stoul(digits) < indexed.size()) return indexed[std::stoul(digits)];
    }
    throw FileError(path + " has no grid named \"" + name + "\"; it holds: " + listing(archive));
}

/// The index of the only scalar grid, else of the only level set.
std::size_t findTheOne(GridArchive& archive, const std::string& path) {
    const auto& entries = archive.entries();
    if (entries.empty()) throw UnsupportedGrid(path + " holds no grids");
    std::vector<std::size_t> scalars, levelSets;
    for (std::size_t i = 0; i < entries.size(); ++i) {
        if (isScalar(entries[i])) scalars.push_back(i);
    }
    if (scalars.size() == 1) return scalars[0];
    if (scalars.empty()) {
        throw UnsupportedGrid(path + " holds no float or double grid, only: " + listing(archive));
    }
    for (const std::size_t i : scalars) {
        if (classOf(archive, entries[i]) == openvdb::GRID_LEVEL_SET) levelSets.push_back(i);
    }
    if (levelSets.size() == 1) return levelSets[0];
    throw UnsupportedGrid(path + " holds several scalar grids; choose one by its name: " + listing(archive));
}

/// Open a file, and let @a work(GridArchive&) read from it.
template <typename Work>
auto withArchive(const std::string& path, const Work& work) {
    openvdb::initialize();
    requireVdbFile(path);
    try {
        GridArchive archive(path);
        return work(archive);
    } catch (const Error&) {
        throw;
    } catch (const std::ios_base::failure&) {
        throw FileError(path + " ends too early or cannot be read: it is truncated or damaged");
    } catch (const std::bad_alloc&) {
        throw FileError(path + " needs more memory than there is, or is damaged");
    } catch (const std::exception& error) {
        throw FileError("cannot read " + path + ": " + error.what());
    }
}

const Entry& knownEntry(GridArchive& archive, const std::string& path, std::size_t index) {
    const Entry& entry = archive.entries()[index];
    if (!entry.grid) {
        throw UnsupportedGrid(path + ": the grid is a " + entry.descriptor.gridType() +
                              ", a type that OpenVDB does not know");
    }
    return entry;
}

openvdb::GridBase::Ptr readEntry(GridArchive& archive, const std::string& path, std::size_t index,
                                 bool delayLoad) {
    return archive.read(knownEntry(archive, path, index), delayLoad);
}

/// The index of the grid that is meant.
std::size_t findGrid(GridArchive& archive, const std::string& path, const std::string& name) {
    return name.empty() ? findTheOne(archive, path) : findByName(archive, path, name);
}

} // namespace

openvdb::GridBase::Ptr readGrid(const std::string& path, const std::string& name, bool delayLoad) {
    return withArchive(path, [&](GridArchive& archive) {
        return readEntry(archive, path, findGrid(archive, path, name), delayLoad);
    });
}

openvdb::GridBase::Ptr readGridPart(const std::string& path, const std::string& name,
                                    const GridArchive::ChooseLeaves& choose) {
    return withArchive(path, [&](GridArchive& archive) {
        const Entry& entry = knownEntry(archive, path, findGrid(archive, path, name));
        if (const auto grid = archive.readPart(entry, choose)) return grid;
        throw UnsupportedGrid(path + ": a grid of type " + entry.descriptor.gridType() +
                              " cannot be meshed; only float and double grids can");
    });
}

openvdb::GridBase::Ptr readGridHead(const std::string& path, const std::string& name) {
    return withArchive(path, [&](GridArchive& archive) {
        return archive.readHead(knownEntry(archive, path, findGrid(archive, path, name)));
    });
}

std::vector<GridHead> readHeads(const std::string& path) {
    return withArchive(path, [&](GridArchive& archive) {
        const std::vector<Entry>& entries = archive.entries();
        std::vector<GridHead> heads;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            GridHead head{uniqueName(entries, i), entries[i].descriptor.gridType(), nullptr};
            if (entries[i].grid) head.grid = archive.readHead(entries[i]);
            heads.push_back(head);
        }
        return heads;
    });
}

std::vector<std::string> scalarGrids(const std::string& path) {
    return withArchive(path, [&](GridArchive& archive) {
        const auto& entries = archive.entries();
        std::vector<std::string> names;
        for (std::size_t i = 0; i < entries.size(); ++i) {
            if (isScalar(entries[i])) names.push_back(uniqueName(entries, i));
        }
        if (!names.empty()) return names;
        throw UnsupportedGrid(path + (entries.empty()
                                          ? " holds no grids"
                                          : " holds no float or double grid, only: " + listing(archive)));
    });
}

openvdb::MetaMap readFileMetadata(const std::string& path) {
    return withArchive(path, [](GridArchive& archive) { return archive.metadata(); });
}

std::vector<openvdb::GridBase::ConstPtr> readFields(const std::string& path,
                                                    const std::vector<std::string>& names,
                                                    const std::string& except, bool delayLoad) {
    return withArchive(path, [&](GridArchive& archive) {
        std::vector<openvdb::GridBase::ConstPtr> grids;
        for (const std::string& name : names)
            grids.push_back(readEntry(archive, path, findByName(archive, path, name), delayLoad));
        if (!names.empty()) return grids;
        for (std::size_t i = 0; i < archive.entries().size(); ++i) {
            const Entry& entry = archive.entries()[i];
            if (!entry.grid || !FieldSampler::canSample(*entry.grid) || plainName(entry) == except) continue;
            grids.push_back(readEntry(archive, path, i, delayLoad));
        }
        return grids;
    });
}

} // namespace vdbtet
