// How many jobs fit into memory.
#include "support/Catch.h"
#include "support/TempFolder.h"

#include "batch/Memory.h"

#include <filesystem>
#include <fstream>

namespace {

/// A file system's root with a few files of the kernel's.
struct Root {
    void put(const std::string& path, const std::string& text) const {
        const std::filesystem::path file = folder.file(path);
        std::filesystem::create_directories(file.parent_path());
        std::ofstream(file) << text;
    }
    std::optional<std::int64_t> free() const { return freeMemory(folder.file("")); }

    vdbtet::test::TempFolder folder;
};

} // namespace

TEST_CASE("free memory is what the machine has, or less where a control group leaves less") {
    const Root root;
    CHECK_FALSE(root.free());
    root.put("proc/meminfo", "MemTotal: 9000 kB\nMemAvailable:    5000 kB\n");
    CHECK(root.free() == 5000 * 1024);

    root.put("proc/self/cgroup", "0::/slurm/job_7\n");
    CHECK(root.free() == 5000 * 1024); // no such folder: no limit
    root.put("sys/fs/cgroup/slurm/job_7/memory.max", "max\n");
    root.put("sys/fs/cgroup/slurm/job_7/memory.current", "1000000\n");
    CHECK(root.free() == 5000 * 1024);
    root.put("sys/fs/cgroup/slurm/memory.max", "4000000\n");
    root.put("sys/fs/cgroup/slurm/memory.current", "3000000\n");
    CHECK(root.free() == 1000000);
    root.put("sys/fs/cgroup/slurm/memory.stat", "active_file 5\ninactive_file 500000\n");
    CHECK(root.free() == 1500000); // files read once are given up first
    root.put("sys/fs/cgroup/slurm/job_7/memory.max", "1000\n");
    CHECK(root.free() == 0);
}

TEST_CASE("limits of the first version of control groups count") {
    const Root root;
    root.put("proc/meminfo", "MemAvailable:    5000 kB\n");
    root.put("proc/self/cgroup", "3:cpu:/a\n2:memory:/a\n");
    root.put("sys/fs/cgroup/memory/a/memory.limit_in_bytes", "2000000\n");
    root.put("sys/fs/cgroup/memory/a/memory.usage_in_bytes", "500000\n");
    CHECK(root.free() == 1500000);
}

TEST_CASE("as many jobs run as fit, at least one and at most the threads") {
    CHECK(jobsThatFit(0, 1000, 8) == 1);
    CHECK(jobsThatFit(9000, 1000, 8) == 6); // half as much again is kept
    CHECK(jobsThatFit(1000000, 1000, 8) == 8);
    CHECK(jobsThatFit(1000000, 0, 3) == 3);
    CHECK(jobsThatFit(1000000, 1000, 0) == 1);
}
