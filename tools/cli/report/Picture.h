/// @file Picture.h
/// A mesh that is small enough to be shown in a page.
#pragma once

#include <vdbtet/TetMesh.h>
#include <vdbtet/VolumeToTets.h>

#include <openvdb/util/NullInterrupter.h>

#include <cstdint>
#include <string>

/// At most this many tets are shown: some 25 MB as base64, and no trouble for a browser.
constexpr std::int64_t kMostTetsShown = 1000000;

struct Picture {
    enum class Kind {
        Whole,       ///< the mesh itself
        SameSurface, ///< its boundary and the tets at it, and larger tets inside
        Coarser,     ///< the same volume at a larger spacing
        None         ///< not even that can be shown
    };
    Kind kind = Kind::None;
    vdbtet::TetMesh mesh;  ///< world space
    vdbtet::Report report; ///< of its run
    std::string why;       ///< of None
};

/// @brief Mesh a volume once more, for the eye.
/// @param of         the report of the run whose mesh is to be shown
/// @param mostTets   what is to be shown has no more than these
/// @param interrupter  as for volumeToTets()
/// @return nothing in it but Report::cancelled when interrupted
/// @details A second run costs less than what a sink that kept the mesh would: it has the same bytes where it
/// is small enough, takes no memory beside that of the first, and where it is too large the same code makes
/// the thinner one. The first attempt at that grades the inside, for then the surface, with all the worst
/// tets, is shown as it is, bit for bit. Only where that is too much, too, does the spacing double until it
/// fits.
Picture makePicture(const openvdb::GridBase& grid, const vdbtet::Options& options, const vdbtet::Report& of,
                    std::int64_t mostTets, openvdb::util::NullInterrupter* interrupter);
