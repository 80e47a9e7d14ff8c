/// @file VolumeToTets.cc
/// From a file to each rank's part of the tiles: first who finds which tiles, then who does them.
#include <vdbtet/mpi/VolumeToTets.h>

#include "mpi/LeafExchange.h"
#include "mpi/Partition.h"
#include "mpi/RankPipeline.h"

#include "BeginRun.h"
#include "ChooseLevel.h"
#include "Limits.h"
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
#include <optional>
#include <utility>

namespace vdbtet::mpi {

using openvdb::Coord;

namespace {

/// A tile where the surface may be, and what is known of the one above it.
struct Found {
    Coord tile;
    std::int32_t insideAbove; ///< whether its highest vertex seems to be inside
};

/// How far the values of a leaf reach, beyond its voxels: to trilinear interpolation, and to a tile's border.
constexpr double kVoxelReach = 2.0, kCellReach = 3.0;

/// @return whether any block in a box may be a rank's; of a single block, whether it is.
bool mayHave(const CurvePartition& finders, const openvdb::CoordBBox& blocks, int rank) {
    // Along the curve all blocks of a box lie between these two.
    return finders(blocks.min()) <= rank && rank <= finders(blocks.max());
}

/// @return whether each block or one of its neighbours is a rank's.
std::vector<bool> besideOwn(const CurvePartition& finders, const std::vector<Coord>& blocks, int rank) {
    std::vector<bool> beside;
    for (const Coord& block : blocks) {
        bool any = false;
        if (mayHave(finders, openvdb::CoordBBox(block.offsetBy(-1), block.offsetBy(1)), rank)) {
            for (int slot = 0; slot < 27 && !any; ++slot)
                any = finders(block.offsetBy(slot / 9 - 1, slot / 3 % 3 - 1, slot % 3 - 1)) == rank;
        }
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

    /// @param grid    with the leaves where this rank is to find the surface, and those next to them
    /// @param blocks  of all leaves
    void run(typename GridT::Ptr grid, const CurvePartition& finders, const std::vector<Coord>& blocks,
             MeshSink& sink) {
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
        // As runPipeline() does.
        for (int margin = mOptions.optimize ? 1 : 0; margin < 2; ++margin) {
            const Report before = mReport;
            if (!mGrid) {
                mComm.together([&] {
                    mGrid = openvdb::gridPtrCast<GridT>(
                        readGridPart(mSource.path, mSource.name,
                                     [&](const auto&) { return besideOwn(finders, blocks, mComm.rank()); }));
                    mReplacement->apply(*mGrid);
                });
            }
            Skeleton skeleton =
                runStage("tiles", interrupt, mReport, [&] { return findTiles(finders, margin, interrupt); });
            std::vector<std::int64_t> own;
            for (std::size_t t = 0; t < skeleton.tiles.size(); ++t) {
                if (skeleton.owner(skeleton.tiles[t]) == mComm.rank()) own.push_back(std::int64_t(t));
            }
            auto field = std::make_shared<const PartField>(
                runStage("share voxels", interrupt, mReport,
                         [&] { return partFor(skeleton, own, finders, blocks); }),
                mFrame, mLevel);
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
        ValueScan scan;
        mComm.together([&] {
            // All ranks have all tiles, and where leaves were not read, more.
            scan = scanValues(*mGrid, interrupt,
                              [&](const Coord& origin) { return finders(origin >> 3) == mComm.rank(); });
        });
        ValueScan all;
        mComm.forEachRank(std::vector<ValueScan>{scan}, [&](const auto& one) { all.add(one[0]); });
        mReplacement.emplace(all, *mGrid, mLevel, mOptions.nan);
        requireInside(mReplacement->values(), mLevel);
        mReport.badValues = mReplacement->count();
        mComm.together([&] { mReplacement->apply(*mGrid); });
    }

    /// All ranks together find all surface tiles, each where it has the leaves.
    Skeleton findTiles(const CurvePartition& finders, int margin, Interrupt& interrupt) {
        std::vector<Found> found;
        mComm.together([&] {
            tbb::enumerable_thread_specific<NearTiles> parts(mFrame, mOptions.maxSurfaceTiles, margin);
            // Where leaves are others', there seem to be surfaces.
            forEachSurfaceBlock(
                mGrid->tree(), mLevel, mOptions.maxSurfaceTiles, interrupt, parts,
                [&](const openvdb::CoordBBox& blocks) { return mayHave(finders, blocks, mComm.rank()); });
            Coords tiles;
            for (const NearTiles& part : parts)
                tiles.insert(tiles.end(), part.tiles().begin(), part.tiles().end());
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
        mComm.forEachRank(found, [&](const auto& part) { all.insert(all.end(), part.begin(), part.end()); });
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

    /// @return what own tiles need, in place of what finding them needed
    typename GridT::Ptr partFor(const Skeleton& skeleton, const std::vector<std::int64_t>& own,
                                const CurvePartition& finders, const std::vector<Coord>& blocks) {
        typename GridT::Ptr grid = std::move(mGrid);
        if (mComm.size() > 1) {
            exchangeLeaves(
                mComm, finders, blocks, [&](const Coord& block) { return isNear(skeleton, own, block); },
                *grid);
        }
        mComm.together([&] {
            mReport.gridMemory = std::int64_t(grid->memUsage());
            mReport.memory = mReport.gridMemory + estimateMemory(std::int64_t(own.size()), mOptions) +
                             forAllRanks(skeleton);
            requireMemory(mReport.memory, mOptions, "meshing a rank's part of it");
        });
        mComm.most(mReport.gridMemory);
        mComm.most(mReport.memory);
        mRankReport.leaves = std::int64_t(grid->tree().leafCount());
        return grid;
    }

    /// @return the bytes of what all ranks know, and of MPI
    std::int64_t forAllRanks(const Skeleton& skeleton) const {
        constexpr std::int64_t kAnyRank = 60'000'000, kTile = 110, kTileGraded = 500;
        return kAnyRank + std::int64_t(skeleton.tiles.size()) * (mOptions.grade ? kTileGraded : kTile);
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
    std::optional<Replacement<GridT>> mReplacement; ///< once all values are known
};

} // namespace

Report volumeToTets(const GridSource& source, MeshSink& sink, const Options& options, MPI_Comm communicator,
                    const Owner& owner, RankReport* rankReport) {
    Comm comm(communicator);
    Report report;
    RankReport ranks;
    Interrupt interrupt(nullptr);
    CurvePartition finders({}, 1);
    std::vector<Coord> blocks;
    openvdb::GridBase::Ptr grid;
    runStage("read", interrupt, report, [&] {
        comm.together([&] {
            grid = readGridPart(source.path, source.name, [&](const std::vector<Coord>& all) {
                blocks = all;
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
        RankGrid<GridT>(comm, source, owner, options, report, ranks)
            .run(std::move(typed), finders, blocks, sink);
    };
    try {
        auto floats = openvdb::gridPtrCast<openvdb::FloatGrid>(grid);
        auto doubles = openvdb::gridPtrCast<openvdb::DoubleGrid>(grid);
        grid.reset();
        // Nobody else keeps the grid, so that its part can go when nobody reads it any more.
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
