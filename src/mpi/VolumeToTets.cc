/// @file VolumeToTets.cc
/// From a file to each rank's part of the tiles: first who finds which tiles, then who does them.
#include <vdbtet/mpi/VolumeToTets.h>

#include "mpi/Partition.h"
#include "mpi/RankPipeline.h"

#include "BeginRun.h"
#include "ChooseLevel.h"
#include "Stage.h"
#include "field/FiniteGrid.h"
#include "field/GridField.h"
#include "io/GridPart.h"

#include <vdbtet/Errors.h>

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <utility>

namespace vdbtet::mpi {

using openvdb::Coord;

namespace {

void checkOptions(const Options& options) {
    if (options.tiger == 3)
        throw BadOption("version 3 of the method is not known to several ranks yet; vdb_tet has it");
    if (options.nan != Nan::Error)
        throw BadOption("values for NaN are not known to several ranks yet; vdb_tet has them");
    if (options.maxMemory)
        throw BadOption("a limit on memory is not known to several ranks yet; vdb_tet has it");
    if (options.optimize) throw BadOption("optimisation is not known to several ranks yet; vdb_tet has it");
}

/// A tile where the surface may be, and what is known of the one above it.
struct Found {
    Coord tile;
    std::int32_t insideAbove; ///< whether its highest vertex seems to be inside
};

/// How far the values of a leaf reach, beyond its voxels: to trilinear interpolation, and to a tile's border.
constexpr double kVoxelReach = 2.0, kCellReach = 3.0;

/// @return whether each block or one of its neighbours is a rank's.
std::vector<bool> besideOwn(const CurvePartition& finders, const std::vector<Coord>& blocks, int rank) {
    std::vector<bool> beside;
    for (const Coord& block : blocks) {
        bool any = false;
        for (int slot = 0; slot < 27 && !any; ++slot)
            any = finders(block.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1)) == rank;
        beside.push_back(any);
    }
    return beside;
}

/// Reads and finds, for one type of grid.
template <typename GridT>
class RankGrid {
public:
    RankGrid(Comm& comm, const GridSource& source, const Owner& owner, const Options& options, Report& report,
             RankReport& rankReport)
        : mComm(comm), mSource(source), mOwner(owner), mOptions(options), mReport(report),
          mRankReport(rankReport) {}

    /// @param grid  with the leaves where this rank is to find the surface, and those next to them
    void run(typename GridT::Ptr grid, const CurvePartition& finders, MeshSink& sink) {
        mGrid = std::move(grid);
        Interrupt interrupt(nullptr);
        mComm.together([&] {
            mFrame = beginRun(*mGrid, mOptions, mReport);
            mLevel = chooseLevel(*mGrid, double(mGrid->background()), mOptions, mReport);
        });
        runStage("scan", interrupt, mReport, [&] {
            scan(finders, interrupt);
            return 0;
        });
        for (int margin = 0; margin < 2; ++margin) {
            const Report before = mReport;
            if (!mGrid) mComm.together([&] { mGrid = readFinding(mComm, mSource, finders); });
            Skeleton skeleton =
                runStage("tiles", interrupt, mReport, [&] { return findTiles(finders, margin, interrupt); });
            std::vector<std::int64_t> own;
            for (std::size_t t = 0; t < skeleton.tiles.size(); ++t) {
                if (skeleton.owner(skeleton.tiles[t]) == mComm.rank()) own.push_back(std::int64_t(t));
            }
            auto field = std::make_shared<const PartField>(
                runStage("read part", interrupt, mReport, [&] { return readFor(skeleton, own); }), mFrame,
                mLevel);
            const Field* its = &field->field;
            if (runPart(mComm, std::shared_ptr<const Field>(std::move(field), its), mFrame, mOptions,
                        std::move(skeleton), own, margin, sink, mReport, mRankReport))
                return;
            mReport = before;
        }
    }

private:
    /// A field, and the grid that it refers to.
    struct PartField {
        PartField(typename GridT::Ptr part, const Frame& frame, const Level& level)
            : grid(std::move(part)), field(*grid, frame, level) {}

        typename GridT::Ptr grid;
        GridField<GridT> field;
    };

    void scan(const CurvePartition& finders, Interrupt& interrupt) {
        ValueScan scan, common;
        mComm.together([&] {
            scan = scanValues(*mGrid, interrupt,
                              [&](const auto& leaf) { return finders(leaf.origin() >> 3) == mComm.rank(); });
            common = scanValues(*mGrid, interrupt, [](const auto&) { return false; });
        });
        ValueScan all;
        for (const auto& one : mComm.gather(std::vector<ValueScan>{scan})) all.add(one[0]);
        // All ranks have all values that are not in leaves.
        all.bad -= (mComm.size() - 1) * common.bad;
        requireInside(requireFinite(all, double(mGrid->background()), *mGrid), mLevel);
    }

    /// All ranks together find all surface tiles, each where it has the leaves.
    Skeleton findTiles(const CurvePartition& finders, int margin, Interrupt& interrupt) {
        struct Finder {
            void operator()(const Coord& block, const TileMask& mixed) {
                if ((*finders)(block) == rank) near(block, mixed);
            }
            NearTiles near;
            const CurvePartition* finders;
            int rank;
        };
        std::vector<Found> found;
        mComm.together([&] {
            tbb::enumerable_thread_specific<Finder> parts(
                Finder{NearTiles(mFrame, mOptions.maxSurfaceTiles, margin), &finders, mComm.rank()});
            forEachSurfaceBlock(mGrid->tree(), mLevel, mOptions.maxSurfaceTiles, interrupt, parts);
            Coords tiles;
            for (const Finder& part : parts)
                tiles.insert(tiles.end(), part.near.tiles().begin(), part.near.tiles().end());
            tbb::parallel_sort(tiles.begin(), tiles.end());
            tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
            const auto accessor = mGrid->getConstAccessor();
            for (const Coord& tile : tiles) {
                const openvdb::Vec3d top = 8.0 * tile.asVec3d() + openvdb::Vec3d(0.0, 0.0, 7.0);
                const Coord voxel = Coord::round(mFrame.toIndex * top);
                found.push_back({tile, mLevel.phi(accessor.getValue(voxel)) >= 0.0});
            }
        });
        std::vector<Found> all;
        for (auto& part : mComm.gather(found)) all.insert(all.end(), part.begin(), part.end());
        tbb::parallel_sort(all.begin(), all.end(),
                           [](const Found& a, const Found& b) { return a.tile < b.tile; });
        Skeleton skeleton;
        std::vector<bool> insideAbove;
        for (const Found& one : all) {
            if (skeleton.tiles.empty() || skeleton.tiles.back() != one.tile) {
                skeleton.tiles.push_back(one.tile);
                insideAbove.push_back(false);
            }
            insideAbove.back() = insideAbove.back() || one.insideAbove != 0;
        }
        if (std::int64_t(skeleton.tiles.size()) > mOptions.maxSurfaceTiles)
            throwTooManyTiles(mOptions.maxSurfaceTiles);
        shareOut(skeleton, insideAbove);
        return skeleton;
    }

    /// Choose the owners. Where runs are is a guess yet, which does no harm.
    void shareOut(Skeleton& skeleton, const std::vector<bool>& insideAbove) const {
        // A surface tile has half the tets of one inside, and takes much else.
        constexpr std::int64_t kSurface = 2, kInside = 1;
        const auto gapAbove = [&](std::size_t t) -> std::int64_t {
            if (!insideAbove[t] || t + 1 == skeleton.tiles.size()) return 0;
            const Coord &tile = skeleton.tiles[t], &next = skeleton.tiles[t + 1];
            if (tile.x() != next.x() || tile.y() != next.y()) return 0;
            return std::int64_t(next.z()) - tile.z() - 1;
        };
        std::int64_t inside = 0;
        for (std::size_t t = 0; t < skeleton.tiles.size(); ++t) inside += gapAbove(t);
        // Few enough parts of runs that memory grows with the surface.
        while (inside / skeleton.runStep > 4 * std::int64_t(skeleton.tiles.size())) skeleton.runStep *= 2;
        if (mOwner) {
            skeleton.owner = mOwner;
            return;
        }
        std::vector<CurvePartition::Work> work;
        for (std::size_t t = 0; t < skeleton.tiles.size(); ++t) {
            const Coord& tile = skeleton.tiles[t];
            work.emplace_back(tile, kSurface);
            const std::int64_t first = std::int64_t(tile.z()) + 1, end = first + gapAbove(t);
            for (std::int64_t z = first; z < end;) {
                const std::int64_t step = z & -std::int64_t(skeleton.runStep),
                                   next = std::min(end, step + skeleton.runStep);
                work.emplace_back(Coord(tile.x(), tile.y(), int(step)), kInside * (next - z));
                z = next;
            }
        }
        skeleton.owner = CurvePartition(work, mComm.size());
    }

    /// Read what own tiles need, in place of what finding them needed.
    typename GridT::Ptr readFor(const Skeleton& skeleton, const std::vector<std::int64_t>& own) {
        if (mComm.size() == 1) return std::move(mGrid);
        mGrid.reset();
        typename GridT::Ptr grid;
        mComm.together([&] {
            const auto needs = [&](const Coord& block) { return isNear(skeleton, own, block); };
            grid = openvdb::gridPtrCast<GridT>(
                readGridPart(mSource.path, mSource.name, [&](const std::vector<Coord>& blocks) {
                    std::vector<bool> wanted;
                    for (const Coord& block : blocks) wanted.push_back(needs(block));
                    return wanted;
                }));
        });
        mRankReport.leaves = std::int64_t(grid->tree().leafCount());
        return grid;
    }

    static typename GridT::Ptr readFinding(Comm& comm, const GridSource& source,
                                           const CurvePartition& finders) {
        return openvdb::gridPtrCast<GridT>(
            readGridPart(source.path, source.name, [&](const std::vector<Coord>& blocks) {
                return besideOwn(finders, blocks, comm.rank());
            }));
    }

    /// Whether values in a block matter to own tiles.
    bool isNear(const Skeleton& skeleton, const std::vector<std::int64_t>& own, const Coord& block) const {
        const openvdb::Vec3d centre = mFrame.fromIndex * (8.0 * block.asVec3d() + openvdb::Vec3d(3.5));
        Coord low, high;
        for (int axis = 0; axis < 3; ++axis) {
            double half = kCellReach;
            for (int j = 0; j < 3; ++j) half += (3.5 + kVoxelReach) * std::abs(mFrame.fromIndex(axis, j));
            low[axis] = int(std::floor((centre[axis] - half) / 8.0));
            high[axis] = int(std::floor((centre[axis] + half) / 8.0));
        }
        for (int x = low.x(); x <= high.x(); ++x) {
            for (int y = low.y(); y <= high.y(); ++y) {
                const auto tile = std::lower_bound(
                    own.begin(), own.end(), Coord(x, y, low.z()),
                    [&](std::int64_t t, const Coord& at) { return skeleton.tiles[std::size_t(t)] < at; });
                if (tile != own.end() && !(Coord(x, y, high.z()) < skeleton.tiles[std::size_t(*tile)]))
                    return true;
            }
        }
        return false;
    }

    Comm& mComm;
    const GridSource& mSource;
    const Owner& mOwner;
    const Options& mOptions;
    Report& mReport;
    RankReport& mRankReport;
    typename GridT::Ptr mGrid;
    Frame mFrame;
    Level mLevel;
};

} // namespace

Report volumeToTets(const GridSource& source, MeshSink& sink, const Options& options, MPI_Comm communicator,
                    const Owner& owner, RankReport* rankReport) {
    Comm comm(communicator);
    Report report;
    RankReport ranks;
    comm.together([&] { checkOptions(options); });
    Interrupt interrupt(nullptr);
    CurvePartition finders({}, 1);
    openvdb::GridBase::Ptr grid;
    runStage("read", interrupt, report, [&] {
        comm.together([&] {
            grid = readGridPart(source.path, source.name, [&](const std::vector<Coord>& blocks) {
                std::vector<CurvePartition::Work> work;
                for (const Coord& block : blocks) work.emplace_back(block, 1);
                finders = CurvePartition(work, comm.size());
                return besideOwn(finders, blocks, comm.rank());
            });
        });
        return 0;
    });
    const std::string name = quoted(*grid);
    ranks.gridType = grid->valueType() + ", " + openvdb::GridBase::gridClassToString(grid->getGridClass());
    const auto run = [&](auto typed) {
        using GridT = typename decltype(typed)::element_type;
        RankGrid<GridT>(comm, source, owner, options, report, ranks).run(std::move(typed), finders, sink);
    };
    try {
        auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
        grid.reset();
        // Nobody else keeps the grid, so that its part can go when the next one is read.
        floats ? run(std::move(floats)) : run(std::move(doubles));
    } catch (const FileError&) {
        throw; // a sink's, and about its file
    } catch (Error& error) {
        error.prefix(name);
        throw;
    }
    ranks.sentToNeighbours = comm.sentToNeighbours();
    ranks.sentToAll = comm.sentToAll();
    if (rankReport) *rankReport = ranks;
    return report;
}

} // namespace vdbtet::mpi
