"""What vdb_tet promises at the command line.

usage: test_vdb_tet.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
"""
import collections
import json
import os
import re
import resource
import signal
import struct
import subprocess
import sys
import unittest

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from tool import VDB_TET, ToolTest, main, wait_until_writing


def run(*arguments, **options):
    return subprocess.run([VDB_TET, *arguments], capture_output=True, text=True, timeout=240, **options)


def is_cycle(steps):
    """Whether a walk from any key to its value, and so on, comes by all of them."""
    first = at = next(iter(steps))
    seen = set()
    while at in steps and at not in seen:
        seen.add(at)
        at = steps[at]
    return at == first and len(seen) == len(steps)


def read_vtu(path):
    """The four arrays of a file in the form of src/io/formats/Vtu.cc, with the layout checked on the way."""
    with open(path, "rb") as file:
        data = file.read()
    start = data.index(b'<AppendedData encoding="raw">')
    header = data[:start].decode()
    start = data.index(b"_", start) + 1
    assert 'version="1.0"' in header and 'header_type="UInt64"' in header
    points, cells = map(int, re.search(r'NumberOfPoints="(\d+)" NumberOfCells="(\d+)"', header).groups())
    codes = {"Float32": "f", "Float64": "d", "Int32": "i", "Int64": "q", "UInt8": "B"}
    arrays, expected = {}, 0
    for kind, name, offset in re.findall(r'type="(\w+)" Name="(\w+)".*offset="(\d+)"', header):
        assert int(offset) == expected
        at = start + expected
        size = struct.unpack_from("=Q", data, at)[0]
        count = size // struct.calcsize(codes[kind])
        arrays[name] = struct.unpack_from(f"={count}{codes[kind]}", data, at + 8)
        expected += 8 + size
    assert data[start + expected:].split() == [b"</AppendedData>", b"</VTKFile>"]
    assert len(arrays["Points"]) == 3 * points
    assert len(arrays["connectivity"]) == 4 * cells
    assert arrays["offsets"] == tuple(range(4, 4 * cells + 1, 4))
    assert arrays["types"] == (10,) * cells
    return arrays


class VdbTet(ToolTest):
    def setUp(self):
        super().setUp()
        self.inputs = sorted(os.listdir())

    def created(self):
        return [name for name in sorted(os.listdir()) if name not in self.inputs]

    def assert_fails(self, code, pattern, *arguments, **options):
        result = run(*arguments, **options)
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, r"\Avdb_tet: [^\n]+\n\Z")
        self.assertRegex(result.stderr, pattern)

    def assert_meshes(self, *arguments, **options):
        result = run(*arguments, **options)
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return result.stdout

    def tets(self, *arguments):
        self.assert_meshes(*arguments, "--dry-run", "-q", "--report", "tets.json")
        with open("tets.json") as file:
            return json.load(file)["tets"]

    def test_help_and_version(self):
        self.assertIn("--isovalue", self.assert_meshes("--help"))
        self.assertRegex(self.assert_meshes("--version"), r"^vdb_tet \d+\.\d+\.\d+, OpenVDB \d+\.\d+\.\d+\n$")

    def test_usage_errors(self):
        for pattern, arguments in [
            ("IN is required", []),
            ("IN is empty", ["", "o.vtu"]),
            ("OUT is missing", ["sphere.vdb"]),
            ("--nonsense", ["sphere.vdb", "o.vtu", "--nonsense"]),
            ("--voxels", ["sphere.vdb", "o.vtu", "-s", "1", "-v", "1"]),
            ("--spacing", ["sphere.vdb", "o.vtu", "-s", "0"]),
            ("--spacing", ["sphere.vdb", "o.vtu", "-s", "wide"]),
            ("--voxels", ["sphere.vdb", "o.vtu", "-v", "-1"]),
            ("--tiger", ["sphere.vdb", "o.vtu", "--tiger", "4"]),
            ("--tau", ["sphere.vdb", "o.vtu", "--tiger", "3", "--tau", "0.9"]),
            ("only version 3", ["sphere.vdb", "o.vtu", "--tau", "0.6"]),
            ("--inside", ["sphere.vdb", "o.vtu", "--inside", "out"]),
            ("--threads", ["sphere.vdb", "o.vtu", "-j", "-1"]),
            ("cannot tell the format of o.wav", ["sphere.vdb", "o.wav"]),
            ("cannot tell the format of o ", ["sphere.vdb", "o"]),
            ("--format", ["sphere.vdb", "o.vtu", "--format", "wav"]),
            ("format of the surface o.wav", ["sphere.vdb", "o.vtu", "--surface", "o.wav"]),
            ("--grade", ["sphere.vdb", "o.vtu", "--max-size", "4"]),
            ("--max-size", ["sphere.vdb", "o.vtu", "--grade", "--max-size", "0"]),
            ("--sweeps", ["sphere.vdb", "o.vtu", "--sweeps", "4"]),
            ("--sweeps", ["sphere.vdb", "o.vtu", "--optimize", "--sweeps", "0"]),
            ("from 1 to 38", ["sphere.vdb", "o.vtu", "--optimize", "39"]),
            ("--optimize", ["sphere.vdb", "o.vtu", "--optimize=much"]),
            ("smaller than the spacing", ["sphere.vdb", "o.vtu", "--grade", "--max-size", "1e-6"]),
        ]:
            with self.subTest(arguments):
                self.assert_fails(2, re.escape(pattern), *arguments)
        self.assertEqual(self.created(), [])

    def test_optimize(self):
        for arguments, target in [
            (["sphere.vdb", "o.vtu", "--optimize"], 30),
            (["--optimize", "sphere.vdb", "o.vtu"], 30),
            (["--optimize", "33", "sphere.vdb", "o.vtu"], 33),
            (["sphere.vdb", "--optimize=33", "o.vtu", "--sweeps", "9"], 33),
        ]:
            with self.subTest(arguments):
                text = self.assert_meshes(*arguments, "--report", "o.json")
                with open("o.json") as file:
                    report = json.load(file)
                self.assertGreaterEqual(report["angles"]["min"], target)
                self.assertLess(report["angles"]["minBefore"], 30)
                self.assertGreater(report["verticesMoved"], 0)
                self.assertIn("optimize", [stage["name"] for stage in report["stages"]])
                self.assertRegex(text, r"\noptimized +from \d+\.\d\d to \d+\.\d\d degrees; \d+ points moved")

    def test_bad_input(self):
        with open("text.vdb", "w") as file:
            file.write("no volume at all\n")
        with open("sphere.vdb", "rb") as whole, open("short.vdb", "wb") as short:
            short.write(whole.read()[:-1])
        self.inputs += ["text.vdb", "short.vdb"]
        for pattern, name in [
            ("No such file", "absent.vdb"),
            ("Is a directory", "."),
            ("not a regular file", "/dev/null"),
            ("not a .vdb file", "text.vdb"),
            ("truncated", "short.vdb"),
            ("no float or double grid, only: vel", "vectors.vdb"),
        ]:
            with self.subTest(name):
                self.assert_fails(1, pattern, name, "o.vtu")
        self.assertEqual(self.created(), [])

    def test_version_3(self):
        self.assert_meshes("sphere.vdb", "two.vtu", "-q", "--report", "two.json")
        text = self.assert_meshes("sphere.vdb", "three.vtu", "--tiger", "3", "--report", "three.json")
        self.assertRegex(text, r"flips +\d+ active, [1-9]\d* for quality\n")
        self.assertRegex(text, r"guard +\d+ points flagged in \d+ rounds\n")
        self.assert_meshes("sphere.vdb", "low.vtu", "--tiger", "3", "--tau", "0.55", "-q", "--report", "low.json")
        reports = []
        for name in ("two.json", "three.json", "low.json"):
            with open(name) as file:
                reports.append(json.load(file))
        two, three, low = reports
        self.assertEqual((two["tiger"], three["tiger"], low["tiger"]), (2, 3, 3))
        self.assertGreater(three["angles"]["min"], two["angles"]["min"])
        self.assertLess(three["angles"]["max"], two["angles"]["max"])
        for report, proven in (two, (11.47, 157.59)), (three, (18.0, 146.0)), (low, (18.0, 146.0)):
            self.assertEqual((report["angles"]["provenMin"], report["angles"]["provenMax"]), proven)
        self.assertIn("proven to lie between 18.00 and 146.00\n", text)
        self.assertEqual((two["qualityFlips"], two["flagged"], two["guardRounds"]), (0, 0, 0))
        self.assertGreater(three["qualityFlips"], 0)
        self.assertNotEqual(three["tets"], low["tets"])

    def test_graded_meshes(self):
        self.assert_meshes("sphere.vdb", "u.vtu", "-q", "--report", "u.json")
        self.assertIn("graded", self.assert_meshes("sphere.vdb", "g.vtu", "-g", "--report", "g.json"))
        with open("u.json") as u, open("g.json") as g:
            uniform, graded = json.load(u), json.load(g)
        self.assertLess(graded["tets"], uniform["tets"])
        self.assertEqual(graded["boundaryTriangles"], uniform["boundaryTriangles"])
        self.assertEqual(sum(graded["tetsOfLevel"]), graded["tets"])
        self.assertEqual(uniform["tetsOfLevel"], [uniform["tets"]])
        self.assertEqual(len(read_vtu("g.vtu")["types"]), graded["tets"])

    def test_formats_by_name(self):
        self.assert_meshes("sphere.vdb", "mesh.wav", "-q", "--format", "vtu")
        self.assert_meshes("sphere.vdb", "mesh.vtu", "-q")
        with open("mesh.wav", "rb") as one, open("mesh.vtu", "rb") as other:
            self.assertEqual(one.read(), other.read())

    def test_grid_choice(self):
        ball = self.tets("sphere.vdb")
        self.assertEqual(self.tets("level_set_and_fog.vdb"), ball)
        self.assertEqual(self.tets("two_of_a_name.vdb", "-n", "ball[0]"), ball)
        self.assertLess(self.tets("two_of_a_name.vdb", "-n", "ball[1]"), ball)
        self.assertEqual(self.tets("two_unnamed.vdb", "-n", "[0]"), ball)
        self.assertLess(self.tets("two_unnamed.vdb", "-n", "[1]"), ball)
        self.assertEqual(self.tets("level_set_and_fog.vdb", "-n", "density"), self.tets("fog.vdb"))
        self.assert_fails(1, r"ball\[0\] \(float, level set\), ball\[1\]", "two_of_a_name.vdb", "o.vtu")
        self.assert_fails(1, r"2 grids named", "two_of_a_name.vdb", "o.vtu", "-n", "ball")
        self.assert_fails(1, r"no grid named", "two_of_a_name.vdb", "o.vtu", "-n", "ball[2]")
        self.assert_fails(1, r"it holds: density \(float, fog volume\), ball", "level_set_and_fog.vdb", "o.vtu",
                          "-n", "smoke")
        self.assert_fails(1, r"vel|vec3s", "level_set_and_fog.vdb", "o.vtu", "-n", "vel")

    def test_mesh_file(self):
        text = self.assert_meshes("sphere.vdb", "o.vtu")
        self.assertEqual(self.created(), ["o.vtu"])
        arrays = read_vtu("o.vtu")
        counts = f"{len(arrays['Points']) // 3} points, {len(arrays['types'])} tets"
        self.assertIn(counts, text)
        self.assertIn(f"({os.path.getsize('o.vtu')} bytes)", text)
        self.assertEqual(sorted(set(arrays["connectivity"])), list(range(len(arrays["Points"]) // 3)))
        self.assertLess(max(map(abs, arrays["Points"])), 1.1)

    def test_options_reach_the_mesher(self):
        plain = self.tets("sphere.vdb")
        self.assertEqual(self.tets("sphere.vdb", "-v", "1", "-i", "0", "--inside", "below", "-j", "1"), plain)
        self.assertEqual(self.tets("sphere.vdb", "-s", "0.2"), self.tets("sphere.vdb", "-v", "2"))
        self.assertLess(self.tets("sphere.vdb", "-v", "2"), plain)
        self.assertLess(self.tets("sphere.vdb", "-i", "-0.1"), plain)
        self.assert_fails(1, "background", "sphere.vdb", "o.vtu", "--inside", "above")
        self.assert_fails(1, "more than 2 lattice tiles", "sphere.vdb", "o.vtu", "--max-tiles", "2")
        self.assert_fails(2, "limit", "sphere.vdb", "o.vtu", "--max-tiles", "0")
        self.assertEqual(self.created(), ["tets.json"])

    def test_surface_of_its_own_points(self):
        points = {}
        for mode in ["fill", "surface"]:
            self.assert_meshes("lace.vdb", f"{mode}.vtu", "--surface", f"{mode}.obj", "--boundary", mode,
                               "--report", f"{mode}.json")
            with open(f"{mode}.json") as report:
                counts = json.load(report)["boundary"]
            with open(f"{mode}.obj") as surface:
                lines = surface.read().splitlines()
            points[mode] = [line for line in lines if line[0] == "v"]
            links = collections.defaultdict(dict)
            for line in lines[len(points[mode]):]:
                a, b, c = line.split()[1:]
                links[a][b], links[b][c], links[c][a] = c, a, b
            self.assertEqual(all(map(is_cycle, links.values())), mode == "surface")
            self.assertGreater(counts["left"], 0)
            self.assertEqual(counts["surfaceSplit"], len(points[mode]) - len(points["fill"]))
        self.assertGreater(counts["surfaceSplit"], 0)
        with open("fill.vtu", "rb") as fill, open("surface.vtu", "rb") as surface:
            self.assertEqual(fill.read(), surface.read())
        self.assert_fails(2, "--surface", "lace.vdb", "o.vtu", "--boundary", "surface")

    def test_dry_run(self):
        text = self.assert_meshes("sphere.vdb", "--dry-run", "--report", "dry.json")
        self.assertEqual(self.created(), ["dry.json"])
        self.assert_meshes("sphere.vdb", "o.vtu", "--report", "real.json")
        with open("dry.json") as dry, open("real.json") as real:
            dry, real = json.load(dry), json.load(real)
        self.assertIn(f"({os.path.getsize('o.vtu')} bytes)", text)
        for changing in ["output", "stages", "worklistSeconds", "seconds"]:
            del dry[changing], real[changing]
        self.assertEqual(dry, real)

    def test_report(self):
        self.assert_meshes("sphere.vdb", "o.vtu", "-q", "--report", "r.json")
        with open("r.json") as file:
            report = json.load(file)
        arrays = read_vtu("o.vtu")
        self.assertEqual(report["input"], "sphere.vdb")
        self.assertEqual(report["output"], "o.vtu")
        self.assertEqual(report["bytes"], os.path.getsize("o.vtu"))
        self.assertEqual(report["gridName"], "ball")
        self.assertEqual(report["tets"], len(arrays["types"]))
        self.assertEqual(report["points"], len(arrays["Points"]) // 3)
        self.assertEqual(sum(report["angles"]["histogram"]), 6 * report["tets"])
        self.assertGreater(report["angles"]["min"], report["angles"]["provenMin"])
        self.assertLess(report["angles"]["max"], report["angles"]["provenMax"])
        self.assertEqual(report["stages"][0]["name"], "read")

    def test_quiet(self):
        self.assertEqual(self.assert_meshes("sphere.vdb", "o.vtu", "-q"), "")

    def test_stdout_full(self):
        with open("/dev/full", "w") as full:
            result = subprocess.run([VDB_TET, "sphere.vdb", "o.vtu"], stdout=full, stderr=subprocess.PIPE, text=True)
        self.assertEqual((result.returncode, result.stderr), (1, "vdb_tet: cannot write to standard output\n"))

    def test_input_is_safe(self):
        with open("sphere.vdb", "rb") as file:
            before = file.read()
        os.symlink("sphere.vdb", "symlink.vtu")
        os.link("sphere.vdb", "hardlink.vtu")
        for name in ["symlink.vtu", "hardlink.vtu"]:
            self.assert_fails(2, "same file", "sphere.vdb", name)
            self.assert_fails(2, "same file", "sphere.vdb", "o.vtu", "--report", name)
        os.symlink("sphere.vdb", "symlink.ply")
        self.inputs.append("symlink.ply")
        self.assert_fails(2, "same file", "sphere.vdb", "o.vtu", "--surface", "symlink.ply")
        self.assert_fails(2, "same file", "sphere.vdb", "o.vtu", "--surface", "b.ply", "--report", "./b.ply")
        self.assert_fails(2, "same file", "sphere.vdb", "o.vtu", "--report", "./o.vtu")
        with open("sphere.vdb", "rb") as file:
            self.assertEqual(file.read(), before)
        self.assertEqual(self.created(), ["hardlink.vtu", "symlink.vtu"])

    def test_unwritable_output(self):
        os.mkdir("directory.vtu")
        os.mkfifo("fifo.vtu")
        os.symlink("loop.vtu", "loop.vtu")
        os.symlink("/dev/full", "full.vtu")
        before = self.created()
        for pattern, name in [
            ("Is a directory", "directory.vtu"),
            ("not a regular file", "fifo.vtu"),
            ("not a regular file", "full.vtu"),
            ("symbolic links", "loop.vtu"),
            ("No such file", "nowhere/o.vtu"),
        ]:
            with self.subTest(name):
                self.assert_fails(1, f"cannot write {name}: .*{pattern}", "sphere.vdb", name)
        self.assertEqual(self.created(), before)

    def test_replacing_keeps_mode_and_link(self):
        with open("old.vtu", "w") as file:
            file.write("old")
        os.chmod("old.vtu", 0o640)
        os.symlink("old.vtu", "link.vtu")
        self.assert_meshes("sphere.vdb", "link.vtu")
        self.assertTrue(os.path.islink("link.vtu"))
        self.assertEqual(os.stat("old.vtu").st_mode & 0o777, 0o640)
        read_vtu("old.vtu")
        self.assert_meshes("sphere.vdb", "new.vtu", umask=0o027)
        self.assertEqual(os.stat("new.vtu").st_mode & 0o777, 0o640)

    def test_full_disk(self):
        with open("o.vtu", "w") as file:
            file.write("old")
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        self.assert_fails(1, "cannot write o.vtu: File too large", "sphere.vdb", "o.vtu", preexec_fn=limit)
        self.assertEqual(self.created(), ["o.vtu"])
        with open("o.vtu") as file:
            self.assertEqual(file.read(), "old")

    def test_signals(self):
        with open("o.vtu", "w") as file:
            file.write("old")
        for number, code in [(signal.SIGINT, 130), (signal.SIGTERM, 143)]:
            with self.subTest(number):
                # Fine enough to take far longer than the signal needs to arrive.
                process = subprocess.Popen([VDB_TET, "sphere.vdb", "o.vtu", "-v", "0.05"],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                wait_until_writing(process)
                process.send_signal(number)
                out, err = process.communicate(timeout=120)
                self.assertEqual((process.returncode, out), (code, ""))
                self.assertEqual(err, "vdb_tet: interrupted; nothing was written\n")
                self.assertEqual(self.created(), ["o.vtu"])
                with open("o.vtu") as file:
                    self.assertEqual(file.read(), "old")

    def test_killed(self):
        try:
            os.close(os.open(".", os.O_RDWR | os.O_TMPFILE))
        except OSError:
            self.skipTest("the file system has no files without a name, so a killed run leaves its file")
        with open("o.vtu", "w") as file:
            file.write("old")
        process = subprocess.Popen([VDB_TET, "sphere.vdb", "o.vtu", "-v", "0.05"])
        wait_until_writing(process)
        process.kill()
        self.assertEqual(process.wait(timeout=120), -signal.SIGKILL)
        self.assertEqual(self.created(), ["o.vtu"])
        with open("o.vtu") as file:
            self.assertEqual(file.read(), "old")

    def test_vtk_reads_the_file(self):
        try:
            import vtk
        except ImportError:
            self.skipTest("no vtk module (Debian: python3-vtk9), so no reader but our own was tried")
        self.assert_meshes("sphere.vdb", "o.vtu", "-q")
        arrays = read_vtu("o.vtu")
        reader = vtk.vtkXMLUnstructuredGridReader()
        errors = []
        reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
        reader.SetFileName("o.vtu")
        reader.Update()
        grid = reader.GetOutput()
        self.assertEqual(errors, [])
        self.assertEqual(grid.GetNumberOfPoints(), len(arrays["Points"]) // 3)
        self.assertEqual(grid.GetNumberOfCells(), len(arrays["types"]))
        for cell in 0, grid.GetNumberOfCells() - 1:
            self.assertEqual(grid.GetCellType(cell), vtk.VTK_TETRA)
            ids = [grid.GetCell(cell).GetPointId(i) for i in range(4)]
            self.assertEqual(tuple(ids), arrays["connectivity"][4 * cell:4 * cell + 4])


if __name__ == "__main__":
    main()
