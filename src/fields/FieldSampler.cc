/// @file FieldSampler.cc
/// Trilinear interpolation in double, of any type of value.
#include <vdbtet/FieldSampler.h>

#include <vdbtet/Errors.h>

#include <openvdb/openvdb.h>

#include <tbb/concurrent_queue.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <set>
#include <utility>

namespace vdbtet {

using openvdb::Coord;
using openvdb::Vec3d;

namespace {

/// A grid of some type.
class Sampled {
public:
    virtual ~Sampled() = default;
    virtual int components() const = 0;
    virtual void sample(const ArrayView<Vec3d>& points, float* values) const = 0;
};

template <typename GridT>
class SampledGrid final : public Sampled {
public:
    using Value = typename GridT::ValueType;

    explicit SampledGrid(typename GridT::ConstPtr grid)
        : mGrid(std::move(grid)),
          mStaggered(kComponents == 3 && mGrid->getGridClass() == openvdb::GRID_STAGGERED) {}

    int components() const override { return kComponents; }

    void sample(const ArrayView<Vec3d>& points, float* values) const override {
        const auto accessor = mGrid->getConstUnsafeAccessor();
        for (const Vec3d& point : points) {
            const Vec3d index = mGrid->transform().worldToIndex(point);
            if (mStaggered) {
                for (int c = 0; c < kComponents; ++c) {
                    Vec3d at = index;
                    at[c] += 0.5; // component c of a voxel is on its lower face
                    *values++ = float(interpolate(accessor, at)[std::size_t(c)]);
                }
            } else {
                for (const double value : interpolate(accessor, index)) *values++ = float(value);
            }
        }
    }

private:
    static constexpr int kComponents = openvdb::VecTraits<Value>::IsVec ? openvdb::VecTraits<Value>::Size : 1;
    using Components = std::array<double, kComponents>;

    static Components componentsOf(const Value& value) {
        if constexpr (kComponents == 1) {
            return {double(value)};
        } else {
            return {double(value[0]), double(value[1]), double(value[2])};
        }
    }

    static Components between(const Components& a, const Components& b, double t) {
        Components result{};
        for (std::size_t c = 0; c < result.size(); ++c) result[c] = a[c] + t * (b[c] - a[c]);
        return result;
    }

    template <typename Accessor>
    static Components interpolate(const Accessor& accessor, const Vec3d& at) {
        const Coord lower = Coord::floor(at);
        const auto value = [&](int x, int y, int z) {
            return componentsOf(accessor.getValue(lower.offsetBy(x, y, z)));
        };
        const Vec3d t = at - lower.asVec3d();
        const auto alongZ = [&](int x, int y) { return between(value(x, y, 0), value(x, y, 1), t.z()); };
        const auto alongY = [&](int x) { return between(alongZ(x, 0), alongZ(x, 1), t.y()); };
        return between(alongY(0), alongY(1), t.x());
    }

    typename GridT::ConstPtr mGrid;
    bool mStaggered;
};

template <typename GridT>
bool trySample(const openvdb::GridBase::ConstPtr& grid, std::unique_ptr<Sampled>& sampled) {
    const auto typed = openvdb::gridConstPtrCast<GridT>(grid);
    if (typed) sampled = std::make_unique<SampledGrid<GridT>>(typed);
    return typed != nullptr;
}

template <typename... GridTs>
struct GridTypes {
    static bool contain(const openvdb::GridBase& grid) { return (grid.isType<GridTs>() || ...); }
    /// @return null for other types
    static std::unique_ptr<Sampled> sampled(const openvdb::GridBase::ConstPtr& grid) {
        std::unique_ptr<Sampled> result;
        static_cast<void>((trySample<GridTs>(grid, result) || ...));
        return result;
    }
};
using Samplable = GridTypes<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid, openvdb::Int64Grid,
                            openvdb::Vec3SGrid, openvdb::Vec3DGrid, openvdb::Vec3IGrid>;

/// Fields at the points, or in the tets.
class Fields {
public:
    void add(const std::string& gridName, const openvdb::GridBase::ConstPtr& grid) {
        std::unique_ptr<Sampled> sampled = Samplable::sampled(grid);
        if (!sampled) {
            throw UnsupportedGrid("grid '" + gridName + "' of type " + grid->valueType() +
                                  " cannot be sampled; only float, double, int and vector grids can");
        }
        announce(gridName, sampled->components());
        mGrids.push_back(std::move(sampled));
    }
    void add(const std::vector<openvdb::GridBase::ConstPtr>& grids) {
        for (const auto& grid : grids) add(grid->getName().empty() ? "field" : grid->getName(), grid);
    }
    /// One that is not of a grid, and comes after all that are.
    void announce(std::string name, int components) {
        // Readers look fields up by their names.
        while (!mNames.insert(name).second) name += "_";
        mFields.push_back({name, components});
    }

    const std::vector<MeshField>& all() const { return mFields; }
    bool ofGrids() const { return !mGrids.empty(); }

    /// @param values  receives them for all grids, one after the other
    void sample(const ArrayView<Vec3d>& at, std::vector<float>& values,
                std::vector<ArrayView<float>>& views) const {
        std::size_t components = 0;
        for (const auto& grid : mGrids) components += std::size_t(grid->components());
        values.resize(components * at.size());
        float* next = values.data();
        for (std::size_t i = 0; i < mGrids.size(); ++i) {
            const std::size_t count = at.size() * std::size_t(mFields[i].components);
            mGrids[i]->sample(at, next);
            views.emplace_back(next, count);
            next += count;
        }
    }

private:
    std::vector<MeshField> mFields;
    std::vector<std::unique_ptr<Sampled>> mGrids; ///< of the first fields
    std::set<std::string> mNames;
};

/// The values of a chunk.
struct Values {
    std::vector<float> points, cells, flags;
};

} // namespace

struct FieldSampler::Impl {
    MeshSink& next;
    bool boundaryFlag, minDihedral;
    Fields points, cells;
    tbb::concurrent_queue<Values> spare; ///< memory that chunks before have left
};

FieldSampler::FieldSampler(MeshSink& next, const FieldOptions& fields)
    : mImpl(new Impl{next, fields.boundaryFlag, fields.minDihedral, {}, {}, {}}) {
    mImpl->points.add(fields.pointGrids);
    mImpl->cells.add(fields.cellGrids);
    if (fields.boundaryFlag) mImpl->points.announce("boundary", 1);
    if (fields.minDihedral) mImpl->cells.announce("min_dihedral", 1);
}

FieldSampler::FieldSampler(MeshSink& next, const std::vector<openvdb::GridBase::ConstPtr>& grids)
    : FieldSampler(next, FieldOptions{grids, {}, false, false}) {}

FieldSampler::~FieldSampler() = default;

bool FieldSampler::canSample(const openvdb::GridBase& grid) { return Samplable::contain(grid); }

bool FieldSampler::begin(const MeshTotals& totals) {
    MeshTotals more = totals;
    const auto append = [](std::vector<MeshField>& to, const std::vector<MeshField>& fields) {
        to.insert(to.end(), fields.begin(), fields.end());
    };
    append(more.pointFields, mImpl->points.all());
    append(more.cellFields, mImpl->cells.all());
    return mImpl->next.begin(more);
}

void FieldSampler::chunk(const MeshChunk& chunk) {
    MeshChunk more = chunk;
    Values values;
    mImpl->spare.try_pop(values);
    mImpl->points.sample(chunk.points, values.points, more.pointFields);
    mImpl->cells.sample(chunk.centroids, values.cells, more.cellFields);
    if (mImpl->boundaryFlag) {
        values.flags.assign(chunk.points.size(), 0.0f);
        for (const std::int64_t id : chunk.surfacePoints)
            values.flags[std::size_t(id - chunk.firstPoint)] = 1.0f;
        more.pointFields.emplace_back(values.flags.data(), values.flags.size());
    }
    if (mImpl->minDihedral) more.cellFields.push_back(chunk.minDihedrals);
    mImpl->next.chunk(more);
    mImpl->spare.push(std::move(values));
}

void FieldSampler::end() { mImpl->next.end(); }
bool FieldSampler::concurrent() const { return mImpl->next.concurrent(); }
MeshWants FieldSampler::wants() const {
    MeshWants wants = mImpl->next.wants();
    wants.triangles = wants.triangles || mImpl->boundaryFlag;
    wants.centroids = wants.centroids || mImpl->cells.ofGrids();
    wants.minDihedrals = wants.minDihedrals || mImpl->minDihedral;
    return wants;
}
ChunkMemory FieldSampler::memory(std::int64_t firstPoint, std::int64_t firstTet) {
    return mImpl->next.memory(firstPoint, firstTet);
}

} // namespace vdbtet
