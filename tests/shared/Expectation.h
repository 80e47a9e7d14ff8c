/// @file Expectation.h
/// What a file is expected to do, as a table in the tests can say it.
#pragma once

#include "support/MeshChecker.h"

#include <vdbtet/Errors.h>
#include <vdbtet/VolumeToTets.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace vdbtet::test {

/// A file with its options, and an error or the properties of the mesh. The setters return the object, so
/// that a table's line can chain them.
class Expectation {
public:
    explicit Expectation(std::string file) : mFile(std::move(file)) {}

    Expectation& grid(std::string name) { return mName = std::move(name), *this; }
    Expectation& iso(double isovalue) { return mOptions.isovalue = isovalue, *this; }
    Expectation& inside(Inside side) { return mOptions.inside = side, *this; }
    Expectation& voxels(double count) { return mOptions.voxels = count, *this; }

    /// The file is refused: by the reader or by the mesher.
    template <typename Exception>
    Expectation& refused() {
        mRefusal = [](const std::function<void()>& work) { return throwsThis<Exception>(work); };
        return *this;
    }

    Expectation& components(int count) { return mComponents = count, *this; }
    /// Of the whole boundary, which then must also be a manifold.
    Expectation& euler(int number) { return mEuler = number, *this; }
    /// Within so many per cent.
    Expectation& volume(double volume, double percent = 2.0) {
        mVolume = volume;
        mPercent = percent;
        return *this;
    }
    /// The very mesh of another file, bit for bit, or with a tolerance in spacings.
    Expectation& sameAs(std::string other, double tolerance = 0.0) {
        mSameAs = std::move(other);
        mTolerance = tolerance;
        return *this;
    }

    const std::string& file() const { return mFile; }

    /// Reads and meshes the file in @a folder, and fails the running test where anything is not as expected.
    void check(const std::string& folder) const;

private:
    template <typename Exception>
    static bool throwsThis(const std::function<void()>& work) {
        try {
            work();
        } catch (const Exception& error) {
            return std::string(error.what()).size() > 20; // it says something
        }
        return false;
    }

    void checkMesh(const std::string& folder) const;
    /// The graded mesh is as clean, and has the same surface as the uniform one.
    void checkGraded(const std::string& folder, const MeshFigures& uniform) const;

    std::string mFile, mName;
    Options mOptions;
    std::function<bool(const std::function<void()>&)> mRefusal;
    std::optional<int> mComponents, mEuler;
    std::optional<double> mVolume;
    double mPercent = 0.0;
    std::string mSameAs;
    double mTolerance = 0.0;
};

} // namespace vdbtet::test
