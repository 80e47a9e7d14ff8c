"""Meshes level sets with each version of the method and prints tables in Markdown: angles, parts lost, time.

usage: compare_versions.py --vdb-tet EXE [--voxels 1,2] [--noise N] [GRID.vdb...]

Angles, counts and times are those of a dry run on one thread; volume, components, Euler number and the distance of
points and triangles from the zero set those of the boundary, which a graded mesh has alike, bit for bit, and sooner.
--noise adds so many random solids, as rough as the lattice can hardly resolve. Needs python3-openvdb.
"""

import argparse
import json
import pathlib
import statistics
import subprocess
import tempfile

import numpy as np
import pyopenvdb

RULES = [("1", ["--tiger", "1"]), ("2", ["--tiger", "2"])] + [
    (f"3, τ = {tau}", ["--tiger", "3", "--tau", tau]) for tau in ("0.5", "0.6", "0.7", "0.77")
]
BAND = ("cuts", "labels", "destinations", "flips", "guard")


def read_obj(path):
    """The points and triangles of a boundary."""
    points, triangles = [], []
    with open(path, encoding="ascii") as lines:
        for line in lines:
            if line.startswith("v "):
                points.append(line[2:].split())
            elif line.startswith("f "):
                triangles.append(line[2:].split())
    return np.array(points, float), np.array(triangles, int) - 1


def figures_of(points, triangles):
    """Components, Euler number and volume of a closed surface."""
    edges = np.sort(np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]]), axis=1)
    edges = np.unique(edges, axis=0)
    root = np.arange(len(points))
    while True:  # the lowest point of each component, by hooking and jumping
        low = np.minimum(root[edges[:, 0]], root[edges[:, 1]])
        new = root.copy()
        np.minimum.at(new, root[edges[:, 0]], low)
        np.minimum.at(new, root[edges[:, 1]], low)
        new = new[new]
        if (new == root).all():
            break
        root = new
    used = np.unique(triangles)
    a, b, c = (points[triangles[:, i]] for i in range(3))
    return {
        "components": len(np.unique(root[used])),
        "euler": len(used) - len(edges) + len(triangles),
        "volume": float(np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6),
    }


class LevelSet:
    """The values of a grid, between voxels trilinear."""

    def __init__(self, path):
        grid = pyopenvdb.read(str(path), pyopenvdb.readAllGridMetadata(str(path))[0].name)
        low, high = (np.array(corner) for corner in grid.evalActiveVoxelBoundingBox())
        self.low = low - 1
        self.values = np.empty(high - low + 3, np.float32)
        grid.copyToArray(self.values, ijk=tuple(int(i) for i in self.low))
        self.voxel = min(grid.transform.voxelSize())
        corners = [grid.transform.worldToIndex(c) for c in ((0.0, 0.0, 0.0), *np.eye(3).tolist())]
        self.origin = np.array(corners[0])
        self.axes = np.array(corners[1:]) - self.origin

    def off(self, places):
        """How far places are off the zero set at most, in voxels, as far as values are distances."""
        index = places @ self.axes + self.origin - self.low
        cell = np.clip(np.floor(index).astype(int), 0, np.array(self.values.shape) - 2)
        there = np.zeros(len(places))
        for corner in np.ndindex(2, 2, 2):
            weight = np.where(np.array(corner) == 1, index - cell, 1.0 - index + cell).prod(axis=1)
            there += weight * self.values[tuple((cell + corner).T)]
        return float(np.abs(there).max() / self.voxel)


def mesh(exe, grid, levels, voxels, options, folder):
    """What a version makes of a grid, or None where nothing is left of it."""
    common = [exe, str(grid), "-q", "-v", voxels, *options, "--report", str(folder / "report.json")]
    if subprocess.run([*common, "--dry-run", "-j", "1"], check=False).returncode != 0:
        return None
    result = json.loads((folder / "report.json").read_text())
    surface = folder / "surface.obj"
    outputs = [str(folder / "mesh.vtu"), "--grade", "--surface", str(surface)]
    subprocess.run([*common, *outputs], check=True)
    points, triangles = read_obj(surface)
    result.update(figures_of(points, triangles))
    result["points off"] = levels.off(points[np.unique(triangles)])
    result["centres off"] = levels.off(points[triangles].mean(axis=1))
    result["band"] = sum(stage["seconds"] for stage in result["stages"] if stage["name"] in BAND)
    return result


def write_noise(path, seed):
    """A ball of 20 voxels' radius, eaten by waves of 5 to 12 voxels."""
    random = np.random.default_rng(seed)
    place = np.stack(np.meshgrid(*[np.arange(-28.0, 29.0)] * 3, indexing="ij"), axis=-1)
    values = np.linalg.norm(place, axis=-1) - 20.0
    for _ in range(12):
        way = random.normal(size=3)
        way *= 2.0 * np.pi / random.uniform(5.0, 12.0) / np.linalg.norm(way)
        values = values + 1.2 * np.cos(place @ way + random.uniform(0.0, 2.0 * np.pi))
    grid = pyopenvdb.FloatGrid(3.0)
    grid.copyFromArray(np.clip(values, -3.0, 3.0).astype(np.float32), ijk=(-28, -28, -28))
    grid.gridClass = pyopenvdb.GridClass.LEVEL_SET
    grid.name = "noise"
    pyopenvdb.write(str(path), grids=[grid])


def row(*cells):
    print("| " + " | ".join(str(cell) for cell in cells) + " |")


def print_summary(voxels, results):
    """A line a rule, over all grids that every rule has a mesh of."""
    grids = [grid for grid in results if all(results[grid].values())]
    print(f"\n{voxels} voxels, {len(grids)} grids:\n")
    row("version", "angles", "0.01 %", "0.1 %", "1 %", "volume", "other topology", "off", "flagged", "rounds",
        "band")
    row("---", *["--:"] * 10)
    for rule, _ in RULES:
        runs = [results[grid][rule] for grid in grids]
        base = [results[grid]["2"] for grid in grids]
        tails = [
            f"{min(r['angles']['low'][i] for r in runs):.1f}, {max(r['angles']['high'][i] for r in runs):.1f}"
            for i in range(3)
        ]
        volumes = [100 * r["volume"] / b["volume"] for r, b in zip(runs, base)]
        differ = sum(
            (r["components"], r["euler"]) != (b["components"], b["euler"]) for r, b in zip(runs, base)
        )
        times = [r["band"] / b["band"] for r, b in zip(runs, base)]
        row(
            rule,
            f"{min(r['angles']['min'] for r in runs):.2f}, {max(r['angles']['max'] for r in runs):.2f}",
            *tails,
            f"{min(volumes):.2f} … {max(volumes):.2f} %",
            differ,
            f"{max(r['points off'] for r in runs):.1g}, {max(r['centres off'] for r in runs):.2f}",
            sum(r["flagged"] for r in runs),
            max(r["guardRounds"] for r in runs),
            f"{statistics.median(times):.1f}",
        )


def print_grids(results):
    """A line a grid: versions 2 and 3, at the default threshold."""
    print()
    row("grid", "voxels", "version 2", "version 3", "components, Euler number", "volume")
    row("---", *["--:"] * 5)
    for voxels, grids in results.items():
        for grid, runs in grids.items():
            two, three = runs["2"], runs["3, τ = 0.7"]
            if not (two and three):
                row(grid, voxels, *["nothing" if not r else "some" for r in (two, three)], "", "")
                continue
            angles = [f"{r['angles']['min']:.2f}, {r['angles']['max']:.2f}" for r in (two, three)]
            parts = [f"{r['components']}, {r['euler']}" for r in (two, three)]
            text = parts[0] if parts[0] == parts[1] else " → ".join(parts)
            row(grid, voxels, *angles, text, f"{100 * three['volume'] / two['volume']:.2f} %")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--vdb-tet", required=True)
    parser.add_argument("--voxels", default="1,2")
    parser.add_argument("--noise", type=int, default=0)
    parser.add_argument("grids", nargs="*", type=pathlib.Path)
    args = parser.parse_args()
    results = {}
    with tempfile.TemporaryDirectory() as name:
        for seed in range(1, args.noise + 1):
            args.grids.append(pathlib.Path(name) / f"noise_{seed}.vdb")
            write_noise(args.grids[-1], seed)
        for voxels in args.voxels.split(","):
            for grid in args.grids:
                levels = LevelSet(grid)
                results.setdefault(voxels, {})[grid.stem] = {
                    rule: mesh(args.vdb_tet, grid, levels, voxels, options, pathlib.Path(name))
                    for rule, options in RULES
                }
    for voxels, grids in results.items():
        print_summary(voxels, grids)
    print_grids(results)


if __name__ == "__main__":
    main()
