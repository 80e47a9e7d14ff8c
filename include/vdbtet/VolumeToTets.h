/// @file VolumeToTets.h
/// The entry point: a sparse volume becomes a tetrahedral mesh with guaranteed dihedral angles.
///
/// The method is TIGER: S. W. Walker, "Tetrahedralization of Isosurfaces with Guaranteed-Quality by Edge
/// Rearrangement", SIAM J. Sci. Comput. 35 (2013).
#pragma once

#include <vdbtet/MeshSink.h>
#include <vdbtet/Quality.h>

#include <openvdb/openvdb.h>
#include <openvdb/util/NullInterrupter.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vdbtet {

/// Which side of the isovalue is meshed. A value equal to the isovalue is inside either way.
enum class Inside {
    Automatic, ///< by grid class: level set Below, fog volume Above, else the side the background is not on
    Below,     ///< values below the isovalue, as in a level set
    Above      ///< values above the isovalue, as in a density
};

/// What is done where the lattice does not resolve the shape, so that the boundary of the mesh would have
/// edges of four triangles, or points where parts of it merely touch.
enum class Boundary {
    Manifold, ///< gaps are filled, tets taken out, and points doubled until the boundary is a surface
    Fill,     ///< gaps are filled with tets within the angle bound; no point is doubled
    Raw       ///< nothing
};

/// What NaN and infinite values are taken for, be they of voxels, of tiles, or the background.
enum class Nan {
    Error,  ///< the grid is refused
    Inside, ///< as far inside as the background is outside
    Outside ///< the background; where that is bad itself, as far outside as any value is from the isovalue
};

/// What Options::tau is unless given.
constexpr double kDefaultTau = 0.7;

struct Options {
    /// The surface is where the grid equals this. Default: 0 for a level set, 0.5 for a fog volume; for any
    /// other class 0 if the background is positive, else 0.5.
    std::optional<double> isovalue;
    Inside inside = Inside::Automatic;
    /// With Inside and Outside a grid that holds such values is copied for the run.
    Nan nan = Nan::Error;

    /// Lattice spacing c, a world length: the long edges of the BCC lattice. Default: voxels voxels.
    std::optional<double> spacing;
    /// Lattice spacing in units of the shortest edge of a voxel; ignored where spacing is given.
    double voxels = 1.0;

    /// Version of the method. 1 and 2 are TIGER's: 2 flips the worst-case octahedra (paper, section 6), 1
    /// does not. 3 moves points along the gradient of the field instead of along edges, flips what that makes
    /// better, and takes the rule of version 2 where it leaves a bad angle all the same.
    int tiger = 2;
    /// With version 3: points inside move outwards where the surface is nearer than this share of a short
    /// edge, from 0.5 to 0.8. A larger one has the better angles, a smaller one keeps more of thin parts.
    /// Default: kDefaultTau.
    std::optional<double> tau;

    /// Nothing changes where the boundary is a surface anyway.
    Boundary boundary = Boundary::Manifold;

    /// Coarsen the inside away from the surface: octree levels, each twice as large as the last, as fast as
    /// balance allows. The boundary stays the same, bit for bit; the number of tets grows with the surface
    /// instead of the volume. Tets between levels have angles in [45, 120] degrees.
    bool grade = false;
    /// With grade: edges away from the surface are no longer than this, a world length, and no less than the
    /// spacing. Default: no limit.
    std::optional<double> maxSize;

    /// Move points at the surface, along it, and below it, until no dihedral angle is less than this many
    /// degrees, or no move helps; from 1 to 38. 30 takes little time, and 35 is about the best that can be
    /// had. The connectivity stays, and so does the surface, within a thousandth of a voxel. Default: do not.
    std::optional<double> optimize;
    /// With optimize: at most so many moves of a point.
    int sweeps = 10;

    /// Refuse, before the work, a surface that crosses more lattice tiles (8 x 8 x 8 cells) than this. A tile
    /// takes about 1.5 kB while the mesh is made.
    std::int64_t maxSurfaceTiles = std::int64_t(1) << 22;
    /// Refuse a mesh of more tets than this, before any is made: once it is known how many there will be, and
    /// where the inside alone has more, before the surface is looked at. The default is a ball of 890 cells
    /// across, in a file of 100 GB.
    std::int64_t maxTets = std::int64_t(1) << 32;
    /// Refuse, before the work, what would take more bytes than this by the estimate of Report::memory.
    /// Default: no limit.
    std::optional<std::int64_t> maxMemory;
};

/// What was wrong with the boundary, and what was done about it.
struct BoundaryCounts {
    std::int64_t found = 0;  ///< vertices whose boundary triangles were not one closed fan
    std::int64_t filled = 0; ///< tets put in
    std::int64_t peeled = 0; ///< tets taken out
    std::int64_t split = 0;  ///< points added, by doubling
    std::int64_t left = 0;   ///< of the vertices, those that are still bad
};

/// Where that is which a report counts: the first kMost of each kind in the order of tiles, world space.
struct Places {
    static constexpr std::size_t kMost = 1000;

    std::vector<openvdb::Vec3d> ambiguous; ///< the centroids of the tets
    std::vector<openvdb::Vec3d> conflicts; ///< the centres of the octahedra
    std::vector<openvdb::Vec3d> pinched;   ///< the vertices of BoundaryCounts::found, before any is mended
};

/// What a run did, and what it was done on.
struct Report {
    bool cancelled = false;

    std::string gridName;
    double isovalue = 0.0;
    Inside inside = Inside::Below; ///< as used, never Automatic
    std::string insideRule;        ///< the same in words, and why
    double spacing = 0.0;          ///< c, world units
    double voxelSize = 0.0;        ///< shortest edge of a voxel, world units
    int tiger = 2;

    std::int64_t points = 0;
    std::int64_t tets = 0;
    /// Tets by level: the longest edge of those of level l is 2^l times the spacing. Only the first unless
    /// the inside was graded.
    std::vector<std::int64_t> tetsOfLevel;
    std::int64_t boundaryTriangles = 0; ///< faces of exactly one tet
    BoundaryCounts boundary;
    std::int64_t ambiguous = 0;   ///< tets of four manifold vertices; dropped (paper, section 2.5)
    std::int64_t conflicts = 0;   ///< octahedra of Algorithm 5 with a fourth manifold vertex (section 6.2.1)
    std::int64_t activeFlips = 0; ///< long edges flipped by Algorithm 4
    std::int64_t extraFlips = 0;  ///< long edges flipped by Algorithm 5
    std::int64_t lastResortFlips = 0; ///< conflicts flipped all the same (section 6.2.2)
    std::int64_t qualityFlips = 0;    ///< long edges flipped by version 3 for the better angles
    std::int64_t flagged = 0;         ///< vertices that version 3 took the rule of version 2 for
    int guardRounds = 0;              ///< of version 3 in which it did so
    std::int64_t badValues = 0;       ///< NaN or infinite, taken for what Options::nan says
    std::int64_t surfaceTiles = 0;    ///< tiles that held any per-vertex state
    std::int64_t gridMemory = 0;      ///< of the grid, and of its copy if values had to be replaced, bytes
    std::int64_t memory = 0;          ///< estimated before the work: the peak of that and the mesher, bytes;
                                      ///< what the sink keeps, such as a TetMesh, is not in it
    std::int64_t cutEdges = 0;        ///< short edges with a cut point
    std::int64_t backLabelled = 0;    ///< vertices that the serial worklist settled
    std::int64_t tieBroken = 0;       ///< vertices settled by the rule for exact ties and cycles

    Places places; ///< of ambiguous, conflicts and boundary.found

    std::int64_t verticesMoved = 0; ///< by optimisation
    int sweeps = 0;                 ///< of optimisation

    AngleStats angles; ///< over all tets
    AnglePercentiles percentiles;
    std::vector<AngleBin> angleBins; ///< the same angles, ascending
    AngleRange anglesBefore;         ///< before optimisation
    double angleMin = 0.0;           ///< the bounds proven for this run: the angles lie strictly between them
    double angleMax = 180.0;
    openvdb::BBoxd bounds; ///< of the points, world space

    struct Stage {
        std::string name;
        double seconds;
    };
    std::vector<Stage> stages;    ///< wall time, in the order of work
    double worklistSeconds = 0.0; ///< of the stage labels, the serial part
};

/// @brief Mesh the inside of a sparse volume with tetrahedra.
/// @param grid         FloatGrid or DoubleGrid with an affine transform. Signs are read from the values; the
///                     active mask is not consulted.
/// @param sink         receives exact totals, then the mesh in chunks of bounded size, in world space
/// @param options      see Options
/// @param interrupter  may be null; when it says stop, the run returns early with Report::cancelled set, and
///                     the sink's end() is not called. It is told of each stage of Report::stages by
///                     start(name) and end(), one after the other, and asked wasInterrupted(percent), from
///                     any thread and from several at once, often enough to stop within a fraction of a
///                     second: percent of the stage's work, rising but for what threads overtake each other,
///                     or -1 where no one knows. Of the stage emit it is the percentage of the tets that
///                     the sink has got.
/// @details Runs on the caller's tbb::task_arena; the mesh is the same, bit for bit, for any number of
/// threads. Memory grows with the surface, not with the volume or its bounding box.
/// @throw BadOption, UnsupportedGrid, BadValue, NoSurface, UnboundedInside, TooLarge, std::bad_alloc where
/// memory runs out all the same, and whatever the sink throws
template <typename GridT>
Report volumeToTets(const GridT& grid, MeshSink& sink, const Options& options = {},
                    openvdb::util::NullInterrupter* interrupter = nullptr);

/// The same for a grid whose type is known at run time only; anything but FloatGrid and DoubleGrid throws
/// UnsupportedGrid.
Report volumeToTets(const openvdb::GridBase& grid, MeshSink& sink, const Options& options = {},
                    openvdb::util::NullInterrupter* interrupter = nullptr);

extern template Report volumeToTets(const openvdb::FloatGrid&, MeshSink&, const Options&,
                                    openvdb::util::NullInterrupter*);
extern template Report volumeToTets(const openvdb::DoubleGrid&, MeshSink&, const Options&,
                                    openvdb::util::NullInterrupter*);

} // namespace vdbtet
