/// @file check_mesh.cc
/// Judges a mesh file as the suite judges meshes: a program for batter.py --check.
#include "support/MeshFigures.h"

#include <exception>
#include <fstream>
#include <iostream>
#include <stdexcept>
#include <string>

namespace {

using namespace vdbtet;

/// The bound that holds whatever the surface (paper, eq. 21), in degrees.
constexpr double kLeast = 8.54, kGreatest = 164.18;

template <typename T>
T take(std::istream& stream) {
    T value{};
    stream.read(reinterpret_cast<char*>(&value), sizeof value);
    return value;
}

/// @brief Read Medit's binary format of versions 2 and 3: 32-bit ids, and coordinates of 64 bits.
/// @throw std::exception where the file is not whole
TetMesh readMesh(const std::string& path) {
    enum Keyword : std::int32_t { kDimension = 3, kVertices = 4, kTetrahedra = 8, kEnd = 54 };
    std::ifstream stream(path, std::ios::binary);
    stream.exceptions(std::ios::failbit | std::ios::badbit | std::ios::eofbit);
    take<std::int32_t>(stream); // tells the byte order
    const auto version = take<std::int32_t>(stream);
    TetMesh mesh;
    for (;;) {
        const auto keyword = take<std::int32_t>(stream);
        version < 3 ? take<std::int32_t>(stream) : take<std::int64_t>(stream); // where the next one is
        if (keyword == kEnd) return mesh;
        const auto count = take<std::int32_t>(stream);
        if (keyword == kDimension) {
            if (count != 3) throw std::runtime_error("not of three dimensions");
        } else if (keyword == kVertices) {
            for (std::int32_t i = 0; i < count; ++i) {
                mesh.points.push_back(take<openvdb::Vec3d>(stream));
                take<std::int32_t>(stream);
            }
        } else if (keyword == kTetrahedra) {
            for (std::int32_t i = 0; i < count; ++i) {
                Tet tet{};
                for (auto& corner : tet) corner = take<std::int32_t>(stream) - 1; // they are from 1
                mesh.tets.push_back(tet);
                take<std::int32_t>(stream);
            }
        } else {
            throw std::runtime_error("a keyword that vdb_tet does not write");
        }
    }
}

/// @return what is wrong, or nothing
std::string faultOf(const test::MeshFigures& f) {
    if (f.badIndices || f.nonFinitePoints) return "indices out of range, or points that are not finite";
    if (f.tets == 0) return "no tets";
    if (f.inverted) return "tets without volume";
    if (f.overusedFaces || f.misorientedFaces) return "faces of three tets, or seen alike from both sides";
    if (f.unusedPoints) return "points that no tet has";
    if (f.nonmanifoldEdges || f.nonmanifoldPoints) return "a boundary that is not a surface";
    if (f.minAngle < kLeast - f.precision || f.maxAngle > kGreatest + f.precision)
        return "angles out of bound";
    return {};
}

} // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::cerr << "usage: vdbtet_check_mesh FILE.meshb\n";
        return 2;
    }
    try {
        const test::MeshFigures figures = test::examine(readMesh(argv[1]));
        const std::string fault = faultOf(figures);
        if (fault.empty()) return 0;
        std::cerr << fault << "; angles from " << figures.minAngle << " to " << figures.maxAngle << '\n';
    } catch (const std::exception& error) {
        std::cerr << "it cannot be read: " << error.what() << '\n';
    }
    return 1;
}
