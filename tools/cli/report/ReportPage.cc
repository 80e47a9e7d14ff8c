/// @file ReportPage.cc
/// The page around the data, and the mesh as base64.
#include "report/ReportPage.h"

#include "UsageError.h"
#include "report/PageData.h"
#include "report/PageTemplate.h"
#include "report/Picture.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <string_view>
#include <vector>

namespace {

/// Writes a file from front to back.
class PageStream {
public:
    explicit PageStream(vdbtet::OutputFile& file) : mFile(file) {}

    void text(std::string_view text) {
        mFile.writeAt(mOffset, text.data(), text.size());
        mOffset += text.size();
    }

    /// An element that holds bytes as base64.
    void array(const char* id, const std::vector<unsigned char>& bytes) {
        text(std::string("<script type=\"text/plain\" id=\"") + id + "\">");
        constexpr std::size_t kPiece = 3 << 16; // of three: so that only the last is padded
        for (std::size_t at = 0; at < bytes.size(); at += kPiece)
            text(base64(bytes.data() + at, std::min(kPiece, bytes.size() - at)));
        text("</script>\n");
    }

private:
    static std::string base64(const unsigned char* bytes, std::size_t size) {
        static const char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string text;
        text.reserve((size + 2) / 3 * 4);
        for (std::size_t at = 0; at < size; at += 3) {
            const std::size_t left = std::min<std::size_t>(3, size - at);
            std::uint32_t bits = 0;
            for (std::size_t i = 0; i < 3; ++i) bits = bits << 8 | (i < left ? bytes[at + i] : 0u);
            for (std::size_t i = 0; i < 4; ++i) text += i <= left ? kDigits[bits >> (18 - 6 * i) & 63] : '=';
        }
        return text;
    }

    vdbtet::OutputFile& mFile;
    std::uint64_t mOffset = 0;
};

/// Lowest byte first, on any machine.
void put(std::vector<unsigned char>& bytes, std::uint32_t value) {
    for (int shift = 0; shift < 32; shift += 8) bytes.push_back(static_cast<unsigned char>(value >> shift));
}

/// float32, three a point, as seen from the middle of the box: there they are fine wherever the mesh is.
std::vector<unsigned char> pointBytes(const Picture& picture, double scale) {
    const openvdb::Vec3d centre = picture.report.bounds.getCenter();
    std::vector<unsigned char> bytes;
    bytes.reserve(12 * picture.mesh.points.size());
    for (const openvdb::Vec3d& point : picture.mesh.points) {
        for (int axis = 0; axis < 3; ++axis) {
            const auto value = static_cast<float>(scale * (point[axis] - centre[axis]));
            std::uint32_t bits = 0;
            std::memcpy(&bits, &value, sizeof bits);
            put(bytes, bits);
        }
    }
    return bytes;
}

/// uint32, four a tet.
std::vector<unsigned char> tetBytes(const Picture& picture) {
    std::vector<unsigned char> bytes;
    bytes.reserve(16 * picture.mesh.tets.size());
    for (const vdbtet::Tet& tet : picture.mesh.tets) {
        for (const std::int64_t corner : tet) put(bytes, static_cast<std::uint32_t>(corner));
    }
    return bytes;
}

/// A byte a tet, for its colour: no tet's smallest angle exceeds 70.53 degrees.
std::vector<unsigned char> qualityBytes(const std::vector<vdbtet::AngleRange>& angles) {
    std::vector<unsigned char> bytes;
    bytes.reserve(angles.size());
    for (const vdbtet::AngleRange& range : angles)
        bytes.push_back(static_cast<unsigned char>(std::clamp(range.min * 255.0 / 72.0 + 0.5, 0.0, 255.0)));
    return bytes;
}

} // namespace

bool isReportPage(const std::string& path) {
    const auto extension = std::filesystem::path(path).extension();
    return extension == ".html" || extension == ".htm";
}

void requireReportPages() {
    if (*kPageTemplate != '\0') return;
    throw UsageError(
        "this vdb_tet was built without three.js, which a report in HTML needs: install libjs-three "
        "and build it again, or give --report a name that ends in .json");
}

bool writeReportPage(vdbtet::OutputFile& file, const CommandLine& line, const Summary& summary,
                     const openvdb::GridBase& grid, openvdb::util::NullInterrupter* interrupter) {
    const Picture picture = makePicture(grid, line.options, summary.report, kMostTetsShown, interrupter);
    if (picture.report.cancelled) return false;
    const std::vector<vdbtet::AngleRange> angles = anglesOf(picture.mesh);

    const std::string_view page = kPageTemplate, mark = "<!--data-->";
    const std::size_t at = page.find(mark);
    PageStream stream(file);
    stream.text(page.substr(0, at));
    stream.text("<script type=\"application/json\" id=\"data\">" +
                pageData(line, summary, grid, picture, angles) + "</script>\n");
    stream.array("points", pointBytes(picture, line.scale));
    stream.array("tets", tetBytes(picture));
    stream.array("quality", qualityBytes(angles));
    stream.text(page.substr(at + mark.size()));
    file.commit();
    return true;
}
