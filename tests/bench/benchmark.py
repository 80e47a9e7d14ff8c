"""Runs vdbtet_bench and vdb_tet on fixtures of growing size, each next to its floor, and prints tables in Markdown.

tools/bench.sh builds what this runs. Every figure is a median; a ratio is the median of the ratios of single
repetitions, whose two sides were measured one right after the other.
"""

import argparse
import json
import math
import os
import pathlib
import platform
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

THREADS = (1, 2)
MOST = THREADS[-1]
# Larger meshes are not written to disk.
MAX_FILE_BYTES = 4e9


class Fixture:
    """A grid file, and what was measured on it."""

    def __init__(self, path, resolution=None):
        self.path = pathlib.Path(path)
        self.name = self.path.stem
        self.resolution = resolution  # None for a shape that is there at one size only
        self.rounds = {}  # by threads: a dictionary of seconds for each repetition
        self.report = None  # of a dry run
        self.peak = self.coarse_peak = None  # bytes
        self.processes = []  # (vdb_tet, read, cp) seconds for each repetition
        self.graded = None  # the report of a run with --grade
        self.graded_peak = None  # bytes
        self.graded_processes = []  # (vdb_tet --grade, read, volumeToMesh, cp) seconds for each repetition

    def stages(self):
        """The stages of the library, in the order of work. A dry run measures; else that is part of emit."""
        names = [stage["name"] for stage in self.report["stages"]]
        return names[names.index("scan") : names.index("measure") + 1] + ["emit"]

    def band(self):
        """The stages from the signs to the flips, which work on surface tiles only."""
        stages = self.stages()
        return stages[stages.index("tiles") + 1 : stages.index("flips") + 1]

    def third_band(self):
        """The same of version 3, with its guard."""
        return [f"version 3: {name}" for name in (*self.band(), "guard")]

    def seconds(self, names, threads=MOST):
        """The median of a sum."""
        return statistics.median(sum(r[name] for name in names) for r in self.rounds[threads])

    def ratio(self, names, floor):
        rounds = self.rounds[MOST]
        if floor not in rounds[0]:
            return None
        return statistics.median(sum(r[name] for name in names) / r[floor] for r in rounds)

    def process_ratio(self):
        return statistics.median(t / (r + c) for t, r, c in self.processes) if self.processes else None

    def memory_ratio(self):
        """Peak memory beyond the grid's, as a share of 300 bytes a surface vertex + 200 MB."""
        vertices = self.report["boundaryTriangles"] / 2  # Euler: a closed surface has twice as many triangles
        return (self.peak - self.rounds[MOST][0]["gridBytes"]) / (300 * vertices + 200e6)


def progress(text):
    print(text, file=sys.stderr, flush=True)


def run(*command):
    """Run a command; return its wall time and its peak memory in bytes."""
    start = time.perf_counter()
    process = subprocess.Popen([str(word) for word in command], stdout=sys.stderr)
    _, status, usage = os.wait4(process.pid, 0)
    seconds = time.perf_counter() - start
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode != 0:
        sys.exit(f"benchmark.py: exit code {process.returncode} from {' '.join(process.args)}")
    return seconds, usage.ru_maxrss * 1024


def measure_stages(fixture, args, folder):
    """One process a fixture; inside it, the repetitions on 1 and 2 threads come in random order."""
    out = folder / "stages.json"
    run(args.bench, f"--benchmark_repetitions={args.repetitions}", "--benchmark_enable_random_interleaving=true",
        "--benchmark_display_aggregates_only=true", f"--benchmark_out={out}", "--benchmark_out_format=json",
        fixture.path)
    for entry in json.loads(out.read_text())["benchmarks"]:
        if entry["run_type"] == "iteration":
            threads = int(entry["name"].split("/")[1])
            fixture.rounds.setdefault(threads, []).append(entry)


def vdb_tet(fixture, args, folder, *more):
    """Run the tool; return its wall time, its peak memory and its report."""
    report = folder / "report.json"
    seconds, peak = run(args.vdb_tet, "-q", "-j", MOST, "--report", report, fixture.path, *more)
    return seconds, peak, json.loads(report.read_text())


def measure_memory(fixture, args, folder):
    peaks, coarse_peaks = [], []
    for _ in range(args.repetitions):
        _, peak, fixture.report = vdb_tet(fixture, args, folder, "--dry-run")
        peaks.append(peak)
        if fixture.resolution:
            # The process and its grid, with a band that is as good as none and alike at all resolutions.
            coarse = vdb_tet(fixture, args, folder, "--dry-run", "--voxels", fixture.resolution / 16)
            coarse_peaks.append(coarse[1])
    fixture.peak = statistics.median(peaks)
    if coarse_peaks:
        fixture.coarse_peak = statistics.median(coarse_peaks)


def measure_processes(fixture, args, folder):
    """vdb_tet to a VTU, and cp of the same file, from and to the page cache. What was written before is synced first,
    or else its way to the disk would be paid by whoever comes next."""
    size = fixture.report["bytes"]
    if size > min(MAX_FILE_BYTES, shutil.disk_usage(folder).free / 3):
        return
    first, out, copy = folder / "first.vtu", folder / "out.vtu", folder / "copy.vtu"
    vdb_tet(fixture, args, folder, first)
    for _ in range(args.repetitions):
        os.sync()
        seconds, _, report = vdb_tet(fixture, args, folder, out)
        out.unlink()
        read = next(stage["seconds"] for stage in report["stages"] if stage["name"] == "read")
        os.sync()
        copying, _ = run("cp", first, copy)
        copy.unlink()
        fixture.processes.append((seconds, read, copying))
    first.unlink()


def measure_graded(fixture, args, folder):
    """What a graded mesh of a solid takes, next to reading the grid, making its surface and copying the file."""
    fixture.report = vdb_tet(fixture, args, folder, "--dry-run")[2]
    first, out, copy = folder / "first.vtu", folder / "out.vtu", folder / "copy.vtu"
    _, fixture.graded_peak, fixture.graded = vdb_tet(fixture, args, folder, "--grade", first)
    for _ in range(args.repetitions):
        os.sync()
        seconds = vdb_tet(fixture, args, folder, "--grade", out)[0]
        out.unlink()
        floor = subprocess.run([args.bench, "--floor", fixture.path], capture_output=True, text=True, check=True)
        read, surface = (float(word) for word in floor.stdout.split())
        os.sync()
        copying, _ = run("cp", first, copy)
        copy.unlink()
        fixture.graded_processes.append((seconds, read, surface, copying))
    first.unlink()


def print_table(header, rows):
    for row in [header, ["---"] + ["--:"] * (len(header) - 1), *rows]:
        print("| " + " | ".join(row) + " |")
    print()


def print_environment(args):
    model = platform.processor() or platform.machine()
    for line in pathlib.Path("/proc/cpuinfo").read_text().splitlines():
        if line.startswith("model name"):
            model = line.split(":", 1)[1].strip()
    memory = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE")
    version = subprocess.run([args.vdb_tet, "--version"], capture_output=True, text=True, check=True).stdout.strip()
    print(f"{version}; {model}, {os.cpu_count()} logical CPUs, {memory / 2**30:.0f} GiB; {platform.system()} "
          f"{platform.release()}; medians of {args.repetitions} repetitions.\n")


def print_stages(fixtures):
    print(f"Milliseconds on {THREADS[0]} → {MOST} threads, and the speed-up. *emit* measures as well; *measure* is "
          "a dry run's. *begin* is the sink's, here one that drops the chunks:\n")

    def cell(fixture, names):
        if names[0] not in fixture.rounds[MOST][0]:
            return "–"
        one, most = (1000 * fixture.seconds(names, threads) for threads in (THREADS[0], MOST))
        digits = 0 if one >= 1000 else 1 if one >= 10 else 3
        return f"{one:.{digits}f} → {most:.{digits}f} ({one / most:.2f})"

    stages = fixtures[0].stages()
    band = fixtures[0].band()
    rows = [(name, [name]) for name in stages]
    rows += [(f"band: {band[0]} to {band[-1]}", band), ("band of version 3", fixtures[0].third_band()),
             ("optimize, to 30 degrees", ["optimize"]),
             ("volumeToTets, chunks dropped", ["volumeToTets"]),
             ("volumeToTets, into memory", ["wholeMesh"]), ("OpenVDB's volumeToMesh", ["volumeToMesh"]),
             ("memcpy of the mesh", ["memcpy"])]
    print_table(["ms"] + [f.name for f in fixtures],
                [[label] + [cell(f, names) for f in fixtures] for label, names in rows])


def print_ratios(fixtures):
    print(f"Ratios on {MOST} threads:\n")
    rows = [
        ("band / volumeToMesh", "0.5", lambda f: f.ratio(f.band(), "volumeToMesh")),
        ("serial worklist / band", "0.01", lambda f: f.seconds(["worklist"]) / f.seconds(f.band())),
        ("repair, where nothing is bad / band", "", lambda f: f.seconds(["repair"]) / f.seconds(f.band())),
        ("band with tiles / volumeToMesh", "", lambda f: f.ratio(["tiles"] + f.band(), "volumeToMesh")),
        ("band of version 3 / volumeToMesh", "5, aim 2", lambda f: f.ratio(f.third_band(), "volumeToMesh")),
        ("optimize, to 30 degrees / volumeToMesh", "8, aim 3", lambda f: f.ratio(["optimize"], "volumeToMesh")),
        ("whole mesh into memory / memcpy of it", "2, aim 1.3", lambda f: f.ratio(["wholeMesh"], "memcpy")),
        ("vdb_tet to VTU / (read + cp of the file)", "1.5", Fixture.process_ratio),
        ("peak memory beyond the grid / (300 B a surface vertex + 200 MB)", "1", Fixture.memory_ratio),
    ]
    show = lambda value: "–" if value is None else f"{value:.2g}" if value < 0.1 else f"{value:.2f}"
    print_table(["ratio", "at most"] + [f.name for f in fixtures],
                [[label, target] + [show(ratio(f)) for f in fixtures] for label, target, ratio in rows])


def print_processes(fixtures):
    fixtures = [f for f in fixtures if f.processes]
    if not fixtures:
        return
    print(f"Whole processes on {MOST} threads, in seconds:\n")
    rows = [[label] + [f"{statistics.median(p[i] for p in f.processes):.3f}" for f in fixtures]
            for i, label in enumerate(["vdb_tet to VTU", "of that, reading the grid", "cp of the VTU"])]
    rows.append(["size of the VTU, MB"] + [f"{f.report['bytes'] / 1e6:.0f}" for f in fixtures])
    print_table(["s"] + [f.name for f in fixtures], rows)


def exponent(points):
    """The p of n^p, by least squares on logarithms."""
    logs = [(math.log(n), math.log(value)) for n, value in points]
    mean_x, mean_y = (statistics.fmean(column) for column in zip(*logs))
    return sum((x - mean_x) * (y - mean_y) for x, y in logs) / sum((x - mean_x) ** 2 for x, _ in logs)


def print_growth(fixtures):
    fixtures = [f for f in fixtures if f.resolution]
    if len(fixtures) < 2:
        return
    sizes = [f.resolution for f in fixtures]
    print(f"Growth from {sizes[0]} to {sizes[-1]} as n^p, on {MOST} threads:\n")
    rows = [
        ("band, seconds", "2.0 ± 0.15", "{:.4f}", lambda f: f.seconds(f.band())),
        ("peak memory beyond a coarse lattice's, MB", "2.0 ± 0.15", "{:.1f}",
         lambda f: max(f.peak - f.coarse_peak, 4096) / 1e6),  # a page at least, as zero has no logarithm
        ("tets, millions", "3", "{:.2f}", lambda f: f.report["tets"] / 1e6),
    ]
    table = []
    for label, target, shape, value in rows:
        values = [value(f) for f in fixtures]
        points = list(zip(sizes, values))
        table.append([label] + [shape.format(v) for v in values] +
                     [f"{exponent(points):.2f}", f"{exponent(points[-2:]):.2f}", target])
    print_table(["quantity"] + [str(n) for n in sizes] + ["p", "p of the last two", "target"], table)


def print_interior(boxes):
    """What has next to no surface."""
    if not boxes:
        return
    print(f"The interior alone, boxes made of constant tiles, into memory on {MOST} threads:\n")
    sizes = [f.resolution for f in boxes]
    seconds = [f.seconds(["wholeMesh"]) for f in boxes]
    rows = [["seconds"] + [f"{s:.3f}" for s in seconds] + [f"{exponent(list(zip(sizes, seconds))):.2f}"],
            ["/ memcpy of the mesh"] + [f"{f.ratio(['wholeMesh'], 'memcpy'):.2f}" for f in boxes] + [""]]
    print_table(["box"] + [str(n) for n in sizes] + ["p of n^p"], rows)


def print_graded(balls):
    """Solids whose inside is coarsened."""
    print(f"Graded, balls of so many voxels across, on {MOST} threads:\n")
    sizes = [f.resolution for f in balls]
    tets = [(f.resolution, f.graded["tets"]) for f in balls]
    table = [
        ["tets, millions"] + [f"{t / 1e6:.2f}" for _, t in tets],
        ["tets of the uniform mesh / tets"] + [f"{f.report['tets'] / f.graded['tets']:.1f}" for f in balls],
        ["peak memory, MB"] + [f"{f.graded_peak / 1e6:.0f}" for f in balls],
    ]
    labels = ["vdb_tet --grade to VTU, s", "reading the grid, s", "volumeToMesh, s", "cp of the VTU, s"]
    for i, label in enumerate(labels):
        table.append([label] + [f"{statistics.median(p[i] for p in f.graded_processes):.3f}" for f in balls])
    ratios = [statistics.median(p[0] / sum(p[1:]) for p in f.graded_processes) for f in balls]
    table.append(["vdb_tet --grade / (read + volumeToMesh + cp), at most 1.5"] + [f"{r:.2f}" for r in ratios])
    print_table(["ball"] + [str(n) for n in sizes], table)
    if len(balls) > 1:
        print(f"The tets grow as n^p with p = {exponent(tets):.2f} (target 2.0 ± 0.1).\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--bench", required=True, type=os.path.abspath, help="vdbtet_bench")
    parser.add_argument("--vdb-tet", required=True, type=os.path.abspath, help="vdb_tet")
    parser.add_argument("--folder", required=True, help="where to make a temporary folder for grids and meshes")
    parser.add_argument("--sizes", default="128,256,512,1024", help="resolutions of the fixture made by code")
    parser.add_argument("--repetitions", type=int, default=5)
    parser.add_argument("grids", nargs="*", help="more grids, .vdb")
    args = parser.parse_args()

    with tempfile.TemporaryDirectory(dir=args.folder) as name:
        folder = pathlib.Path(name)
        fixtures = []
        sizes = sorted(int(text) for text in args.sizes.split(","))
        for size in sizes:
            fixtures.append(Fixture(folder / f"torus_{size}.vdb", size))
            run(args.bench, "--write", "torus", size, fixtures[-1].path)
        fixtures += [Fixture(path) for path in args.grids]
        for fixture in fixtures:
            progress(f"benchmark.py: {fixture.name}")
            measure_memory(fixture, args, folder)
            measure_stages(fixture, args, folder)
            measure_processes(fixture, args, folder)

        boxes = [Fixture(folder / f"box_{size}.vdb", size) for size in (64, 128, 256)]
        for fixture in boxes:
            progress(f"benchmark.py: {fixture.name}")
            run(args.bench, "--write", "box", fixture.resolution, fixture.path)
            measure_stages(fixture, args, folder)

        balls = [Fixture(folder / f"ball_{size}.vdb", size) for size in sizes]
        for fixture in balls:
            progress(f"benchmark.py: {fixture.name}")
            run(args.bench, "--write", "ball", fixture.resolution, fixture.path)
            measure_graded(fixture, args, folder)

    print_environment(args)
    print_ratios(fixtures)
    print_stages(fixtures)
    print_processes(fixtures)
    print_growth(fixtures)
    print_interior(boxes)
    print_graded(balls)


if __name__ == "__main__":
    main()
