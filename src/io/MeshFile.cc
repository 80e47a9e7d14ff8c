/// @file MeshFile.cc
/// The formats by name, and what all writers have in common.
#include <vdbtet/MeshFile.h>

#include <vdbtet/Errors.h>

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
};

const std::vector<Known>& known() {
    static const std::vector<Known> kKnown = {
        {{"vtu", {".vtu"}, "VTK XML unstructured grid, raw appended"}, makeVtu, {}},
        {{"vtu-inline", {}, "VTK XML unstructured grid, inline base64"}, makeVtuInline, {}},
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

std::string listOf(const std::vector<Known>& all) {
    std::string list;
    for (const Known& one : all) list += (list.empty() ? "" : ", ") + one.format.name;
    return list;
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
    if (!name.empty()) throw BadOption("no format is called '" + name + "'; there are " + listOf(known()));
    throw BadOption("cannot tell the format of " + path + " by its extension; there are " + listOf(known()));
}

std::vector<std::string> pathsOf(const std::string& path, const Known& one) {
    if (one.files.empty()) return {path};
    std::vector<std::string> paths;
    for (const std::string& extension : one.files)
        paths.push_back(std::filesystem::path(path).replace_extension(extension).string());
    return paths;
}

/// Lay a mesh out.
std::unique_ptr<const Format> makeFormat(const Known& one, const MeshTotals& totals,
                                         const std::optional<UsdOptions>& usd) {
    if (!totals.pointFields.empty() || !totals.cellFields.empty()) MeshFile::requireFields(one.format);
    if (usd) MeshFile::requireUsd(one.format);
    return one.make ? one.make(totals) : makeUsda(totals, usd.value_or(UsdOptions()));
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

struct MeshFile::Impl {
    Impl(const std::string& target, const Known& one, const std::optional<UsdOptions>& usdOptions)
        : path(target), known(one), usd(usdOptions) {
        if (usd) requireUsd(one.format);
        for (const std::string& name : pathsOf(target, one)) files.emplace_back(name);
    }

    std::string path;
    const Known& known;
    std::optional<UsdOptions> usd;
    std::deque<RecordFile> files;
    MeshTotals totals;
    std::unique_ptr<const Format> format;
    std::atomic<std::int64_t> points{0}, tets{0}, triangles{0}; ///< written
};

MeshFile::MeshFile(const std::string& path, const std::string& format, const std::optional<UsdOptions>& usd)
    : mImpl(std::make_unique<Impl>(path, find(path, format), usd)) {}

MeshFile::~MeshFile() = default;

bool MeshFile::begin(const MeshTotals& totals) {
    mImpl->totals = totals;
    mImpl->format = makeFormat(mImpl->known, totals, mImpl->usd);
    const auto& layouts = mImpl->format->layouts();
    for (std::size_t i = 0; i < layouts.size(); ++i) mImpl->files[i].start(layouts[i]);
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
    impl.format->write(chunk, impl.files);
    impl.points += points;
    impl.tets += tets;
    impl.triangles += triangles;
}

void MeshFile::end() {
    const Impl& impl = *mImpl;
    if (impl.points != impl.totals.points || impl.tets != impl.totals.tets ||
        (impl.format->wantsTriangles() && impl.triangles != impl.totals.triangles)) {
        throw FileError("cannot write " + impl.path + ": the mesh is smaller than announced");
    }
    impl.format->finish(mImpl->files);
    for (RecordFile& file : mImpl->files) file.commit();
}

bool MeshFile::concurrent() const { return true; }

MeshWants MeshFile::wants() const {
    MeshWants wants;
    wants.triangles = mImpl->format && mImpl->format->wantsTriangles();
    return wants;
}

const MeshFormat& MeshFile::formatOf(const std::string& path, const std::string& format) {
    return find(path, format).format;
}

void MeshFile::requireFields(const MeshFormat& format) {
    if (format.holdsFields) return;
    std::string others;
    for (const MeshFormat& one : meshFormats()) {
        if (one.holdsFields) others += (others.empty() ? "" : ", ") + one.name;
    }
    throw BadOption("the format " + format.name + " is written without fields; those with fields are " +
                    others);
}

void MeshFile::requireUsd(const MeshFormat& format) {
    if (!format.takesUsdOptions)
        throw BadOption("the format " + format.name +
                        " states no up axis and no unit, and has no prims; usda does");
}

std::uint64_t MeshFile::size(const std::string& path, const MeshTotals& totals, const std::string& format,
                             const std::optional<UsdOptions>& usd) {
    const std::unique_ptr<const Format> made = makeFormat(find(path, format), totals, usd);
    std::uint64_t bytes = 0;
    for (const RecordLayout& layout : made->layouts()) bytes += layout.size();
    return bytes;
}

} // namespace vdbtet
