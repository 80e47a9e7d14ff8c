/// @file FieldSampler.cc
/// Trilinear interpolation in double, of any type of value.
#include <vdbtet/FieldSampler.h>

#include <vdbtet/Errors.h>

#include <openvdb/openvdb.h>

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

} // namespace

struct FieldSampler::Impl {
    MeshSink& next;
    std::vector<MeshField> fields;
    std::vector<std::unique_ptr<Sampled>> grids; ///< of the fields
};

FieldSampler::FieldSampler(MeshSink& next, const std::vector<openvdb::GridBase::ConstPtr>& grids)
    : mImpl(new Impl{next, {}, {}}) {
    std::set<std::string> names;
    for (const auto& grid : grids) {
        std::string name = grid->getName().empty() ? "field" : grid->getName();
        std::unique_ptr<Sampled> sampled = Samplable::sampled(grid);
        if (!sampled) {
            throw UnsupportedGrid("grid '" + name + "' of type " + grid->valueType() +
                                  " cannot be sampled; only float, double, int and vector grids can");
        }
        // Readers look fields up by their names.
        while (!names.insert(name).second) name += "_";
        mImpl->fields.push_back({name, sampled->components()});
        mImpl->grids.push_back(std::move(sampled));
    }
}

FieldSampler::~FieldSampler() = default;

bool FieldSampler::canSample(const openvdb::GridBase& grid) { return Samplable::contain(grid); }

bool FieldSampler::begin(const MeshTotals& totals) {
    MeshTotals more = totals;
    more.pointFields.insert(more.pointFields.end(), mImpl->fields.begin(), mImpl->fields.end());
    return mImpl->next.begin(more);
}

void FieldSampler::chunk(const MeshChunk& chunk) {
    MeshChunk more = chunk;
    std::vector<std::vector<float>> values(mImpl->grids.size());
    for (std::size_t i = 0; i < values.size(); ++i) {
        values[i].resize(chunk.points.size() * std::size_t(mImpl->fields[i].components));
        mImpl->grids[i]->sample(chunk.points, values[i].data());
        more.pointFields.emplace_back(values[i].data(), values[i].size());
    }
    mImpl->next.chunk(more);
}

void FieldSampler::end() { mImpl->next.end(); }
bool FieldSampler::concurrent() const { return mImpl->next.concurrent(); }
MeshWants FieldSampler::wants() const { return mImpl->next.wants(); }
ChunkMemory FieldSampler::memory(std::int64_t firstPoint, std::int64_t firstTet) {
    return mImpl->next.memory(firstPoint, firstTet);
}

} // namespace vdbtet
