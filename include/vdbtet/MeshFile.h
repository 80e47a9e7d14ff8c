/// @file MeshFile.h
/// Streams a mesh into a file of any format that is known.
#pragma once

#include <vdbtet/MeshSink.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vdbtet {

/// A format that meshes can be written in.
struct MeshFormat {
    std::string name;                    ///< as an option has it
    std::vector<std::string> extensions; ///< file names' that stand for it, with the dot
    std::string description;
    bool holdsFields = true;      ///< values at points and in tets
    bool takesUsdOptions = false; ///< states what UsdOptions have
    bool compresses = false;      ///< if asked to
};

/// All of them.
const std::vector<MeshFormat>& meshFormats();

/// What a file of OpenUSD has besides the mesh. The mesh stays as it is: nothing is turned or scaled.
struct UsdOptions {
    enum class Axis { Y, Z };
    Axis upAxis = Axis::Y;
    double metersPerUnit = 1.0;
    /// The boundary as a Mesh, too, for programs that show no TetMesh: the default prim is an Xform "mesh" of
    /// a TetMesh "tets" and a Mesh "surface", which takes points and point fields from the TetMesh.
    bool surface = false;
};

/// What some formats take, and others refuse.
struct FormatOptions {
    int compression = 0; ///< level of zlib's, from 1, fast, to 9, small; 0 for none
    std::optional<UsdOptions> usd = std::nullopt;
};

/// @brief Writes a mesh into a file, or a few files that belong together.
/// @details A file is written beside its target under a temporary name and renamed by end(), so the target is
/// always either the old file or the whole new one. Several threads write at once; into compressed files
/// chunks come in order, and several threads compress them. Coordinates are world space, and float64, or
/// float32 where MeshTotals::float32Suffices and the format is used with either; texts have the digits that
/// these need. Every member throws FileError when a file cannot be written, and begin() throws TooLarge when
/// the format cannot hold so large a mesh, and BadOption when there are fields and it cannot hold them.
class MeshFile final : public MeshSink {
public:
    /// @param path    with an extension that tells the format, unless @a format does
    /// @param format  name of a format; default: by the extension
    /// @throw BadOption where there is no such format, or it does not take the options
    explicit MeshFile(const std::string& path, const std::string& format = {},
                      const FormatOptions& options = {});
    ~MeshFile() override;

    bool begin(const MeshTotals& totals) override;
    void chunk(const MeshChunk& chunk) override;
    void end() override;
    bool concurrent() const override;
    MeshWants wants() const override;

    /// @return the format of files like @a path
    /// @throw BadOption as above
    static const MeshFormat& formatOf(const std::string& path, const std::string& format = {},
                                      const FormatOptions& options = {});

    /// @return the paths of all files that a mesh is written into, most often @a path alone
    /// @throw BadOption as above
    static std::vector<std::string> filesOf(const std::string& path, const std::string& format = {});

    /// @throw BadOption where it does not hold fields, as begin() does: for those who ask before the work
    static void requireFields(const MeshFormat& format);

    /// @return the exact size in bytes of what a mesh of @a totals takes in files like @a path; of compressed
    /// ones, the size that they do not exceed
    /// @throw BadOption, TooLarge as above
    static std::uint64_t size(const std::string& path, const MeshTotals& totals,
                              const std::string& format = {}, const FormatOptions& options = {});

    /// @return the size in bytes of what end() has written
    std::uint64_t bytes() const;

private:
    struct Impl;
    std::unique_ptr<Impl> mImpl;
};

} // namespace vdbtet
