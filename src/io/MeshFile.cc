/// @file MeshFile.cc
/// The formats by name, and what all writers have in common.
#include <vdbtet/MeshFile.h>

#include <vdbtet/Errors.h>

#include "io/formats/CompressedFormat.h"
#include "io/formats/Format.h"

#include <atomic>
#include <filesystem>

namespace vdbtet {

namespace {

struct Known {
    MeshFormat format;
    MakeFormat make; ///< null where makeUsda() does
    /// What takes the place of the extension in the names of the files; empty for a single file of the
    /// target's own name.
    std::vector<std::string> files;
    /// Null where the format is never compressed.
    MakeCompressed makeCompressed = nullptr;
};

const std::vector<Known>& known() {
    static const std::vector<Known> kKnown = {
        {{"vtu", {".vtu"}, "VTK XML unstructured grid, raw appended", true, false, true},
         makeVtu,
         {},
         makeVtuCompressed},
        {{"vtu-inline", {}, "VTK XML unstructured grid, inline base64"}, makeVtuInline, {}},
        {{"vtkhdf", {".vtkhdf"}, "VTKHDF unstructured grid", true, false, true},
         makeVtkHdf,
         {},
         makeVtkHdfCompressed},
        {{"vtk", {".vtk"}, "legacy VTK, binary"}, makeVtk, {}},
        {{"msh", {".msh"}, "Gmsh MSH 4.1, binary"}, makeMsh, {}},
        {{"msh22", {}, "Gmsh MSH 2.2, binary"}, makeMsh22, {}},
        {{"mesh", {".mesh"}, "Medit, text", false}, makeMesh, {}},
        {{"meshb", {".meshb"}, "Medit, binary", false}, makeMeshb, {}},
        {{"tetgen", {".ele", ".node"}, "TetGen .node, .ele and .face, text"},
         makeTetGen,
         {".node", ".ele", ".face"}},
        {{"npz", {".npz"}, "NumPy arrays vertices and tet_indices, for Newton and Warp"}, makeNpz, {}},
        {{"inp", {".inp"}, "Abaqus input, text", false}, makeInp, {}},
        {{"geo", {".geo"}, "Houdini geometry, JSON text"}, makeGeo, {}},
        {{"usda", {".usda"}, "OpenUSD TetMesh, text", true, true}, nullptr, {}},
    };
    return kKnown;
}

/// The names of those that @a choose chooses.
template <typename Choose>
std::string listOf(const Choose& choose) {
    std::string list;
    for (const Known& one : known()) {
        if (choose(one)) list += (list.empty() ? "" : ", ") + one.format.name;
    }
    return list;
}

std::string listOfAll() {
    return listOf([](const Known&) { return true; });
}

const Known& find(const std::string& path, const std::string& name) {
    const std::string extension = std::filesystem::path(path).extension().string();
    for (const Known& one : known()) {
        const auto& extensions = one.format.extensions;
        const bool fits = name.empty()
                              ? std::find(extensions.begin(), extensions.end(), extension) != extensions.end()
                              : one.format.name == name;
        if (fits) return one;
    }
    if (!name.empty()) throw BadOption("no format is called '" + name + "'; there are " + listOfAll());
    throw BadOption("cannot tell the format of " + path + " by its extension; there are " + listOfAll());
}

/// Find a format that takes the options.
const Known& find(const std::string& path, const std::string& name, const FormatOptions& options) {
    const Known& one = find(path, name);
    if (options.compression < 0 || options.compression > 9) {
        throw BadOption("levels of compression are 1 to 9, not " + std::to_string(options.compression));
    }
    if (options.compression > 0 && !one.format.compresses) {
        throw BadOption("the format " + one.format.name +
                        " is written without compression; those with it are " +
                        listOf([](const Known& other) { return other.format.compresses; }));
    }
    if (options.usd && !one.format.takesUsdOptions) {
        throw BadOption("the format " + one.format.name +
                        " states no up axis and no unit, and has no prims; usda does");
    }
    return one;
}

void checkFields(const Known& one, const MeshTotals& totals) {
    if (!totals.pointFields.empty() || !totals.cellFields.empty()) MeshFile::requireFields(one.format);
}

std::vector<std::string> pathsOf(const std::string& path, const Known& one) {
    if (one.files.empty()) return {path};
    std::vector<std::string> paths;
    for (const std::string& extension : one.files)
        paths.push_back(std::filesystem::path(path).replace_extension(extension).string());
    return paths;
}

/// Lay a mesh out.
std::unique_ptr<const Format> makeFormat(const std::string& path, const Known& one, const MeshTotals& totals,
                                         const FormatOptions& options) {
    try {
        return one.make ? one.make(totals) : makeUsda(totals, options.usd.value_or(UsdOptions()));
    } catch (FileError& error) { // of a library, which knows no path
        error.prefix(path);
        throw;
    }
}

} // namespace

const std::vector<MeshFormat>& meshFormats() {
    static const std::vector<MeshFormat> kFormats = [] {
        std::vector<MeshFormat> formats;
        for (const Known& one : known()) formats.push_back(one.format);
        return formats;
    }();
    return kFormats;
}

std::unique_ptr<const Format> makeFormat(const std::string& path, const std::string& name,
                                         const MeshTotals& totals, const FormatOptions& options) {
    const Known& one = find(path, name, options);
    checkFields(one, totals);
    return makeFormat(path, one, totals, options);
}

struct MeshFile::Impl {
    Impl(const std::string& target, const Known& one, const FormatOptions& with)
        : path(target), known(one), options(with) {
        for (const std::string& name : pathsOf(target, one)) files.emplace_back(name);
    }

    std::string path;
    const Known& known;
    FormatOptions options;
    std::deque<RecordFile> files;
    MeshTotals totals;
    std::unique_ptr<const Format> format;         ///< without compression; the other one with it
    std::unique_ptr<CompressedFormat> compressed; ///< refers to the file
    std::uint64_t bytes = 0;
    std::atomic<std::int64_t> points{0}, tets{0}, triangles{0}; ///< written
};

MeshFile::MeshFile(const std::string& path, const std::string& format, const FormatOptions& options)
    : mImpl(std::make_unique<Impl>(path, find(path, format, options), options)) {}

MeshFile::~MeshFile() = default;

bool MeshFile::begin(const MeshTotals& totals) {
    Impl& impl = *mImpl;
    checkFields(impl.known, totals);
    impl.totals = totals;
    if (impl.options.compression > 0) {
        impl.compressed = impl.known.makeCompressed(impl.files[0].file(), totals, impl.options.compression);
        return true;
    }
    impl.format = makeFormat(impl.path, impl.known, totals, impl.options);
    const auto& layouts = impl.format->layouts();
    for (std::size_t i = 0; i < layouts.size(); ++i) {
        impl.files[i].start(layouts[i]);
        impl.bytes += layouts[i].size();
    }
    return true;
}

void MeshFile::chunk(const MeshChunk& chunk) {
    Impl& impl = *mImpl;
    const auto points = std::int64_t(chunk.points.size()), tets = std::int64_t(chunk.tets.size()),
               triangles = std::int64_t(chunk.triangles.size());
    if (chunk.firstPoint + points > impl.totals.points || chunk.firstTet + tets > impl.totals.tets ||
        chunk.firstTriangle + triangles > impl.totals.triangles) {
        throw FileError("cannot write " + impl.path + ": the mesh is larger than announced");
    }
    impl.compressed ? impl.compressed->write(chunk) : impl.format->write(chunk, impl.files);
    impl.points += points;
    impl.tets += tets;
    impl.triangles += triangles;
}

void MeshFile::end() {
    Impl& impl = *mImpl;
    if (impl.points != impl.totals.points || impl.tets != impl.totals.tets ||
        (wants().triangles && impl.triangles != impl.totals.triangles)) {
        throw FileError("cannot write " + impl.path + ": the mesh is smaller than announced");
    }
    if (impl.compressed) {
        impl.bytes = impl.compressed->finish();
    } else {
        impl.format->finish(impl.files, impl.format->checksums());
    }
    for (RecordFile& file : impl.files) file.prepare();
    for (RecordFile& file : impl.files) file.commit();
}

bool MeshFile::concurrent() const { return mImpl->options.compression == 0; }

MeshWants MeshFile::wants() const {
    MeshWants wants;
    wants.triangles = mImpl->format && mImpl->format->wantsTriangles();
    return wants;
}

const MeshFormat& MeshFile::formatOf(const std::string& path, const std::string& format,
                                     const FormatOptions& options) {
    return find(path, format, options).format;
}

std::vector<std::string> MeshFile::filesOf(const std::string& path, const std::string& format) {
    return pathsOf(path, find(path, format));
}

void MeshFile::requireFields(const MeshFormat& format) {
    if (format.holdsFields) return;
    throw BadOption("the format " + format.name + " is written without fields; those with fields are " +
                    listOf([](const Known& one) { return one.format.holdsFields; }));
}

std::uint64_t MeshFile::size(const std::string& path, const MeshTotals& totals, const std::string& format,
                             const FormatOptions& options) {
    const Known& one = find(path, format, options);
    checkFields(one, totals);
    const std::unique_ptr<const Format> made = makeFormat(path, one, totals, options);
    std::uint64_t bytes = 0;
    for (const RecordLayout& layout : made->layouts()) bytes += layout.size();
    return options.compression > 0 ? CompressedFormat::mostBytes(bytes, totals) : bytes;
}

std::uint64_t MeshFile::bytes() const { return mImpl->bytes; }

} // namespace vdbtet
