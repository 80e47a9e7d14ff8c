"""vdb_tet_mpi writes the file that vdb_tet writes, or none."""
import json
import os
import resource
import signal
import subprocess
import sys
import time

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "support"))
import tool  # noqa: E402

VDB_TET_MPI, MPIEXEC = os.environ["VDB_TET_MPI"], os.environ["MPIEXEC"]


def command(ranks, *arguments):
    return [MPIEXEC, "-n", str(ranks), VDB_TET_MPI, "-j", "1", *arguments]


def read(path):
    with open(path, "rb") as file:
        return file.read()


def our_lines(text):
    """Those that are not mpiexec's about ranks that ended with an error."""
    return [line for line in text.splitlines() if line.startswith("vdb_tet")]


class RanksTest(tool.ToolTest):
    def run_ranks(self, ranks, *arguments, **options):
        return subprocess.run(command(ranks, *arguments), capture_output=True, text=True, **options)

    def require_same(self, name, out, *options):
        one = "one" + os.path.splitext(out)[1]
        subprocess.run([tool.VDB_TET, name, one, "-q", "--report", "one.json", *options], check=True)
        with open("one.json", encoding="utf-8") as file:
            expected = json.load(file)
        for ranks in (1, 2, 3, 4):
            with self.subTest(name=name, out=out, options=options, ranks=ranks):
                result = self.run_ranks(ranks, name, out, "-q", "--report", "many.json", *options)
                self.assertEqual((result.returncode, result.stdout), (0, ""), result.stderr)
                self.assertEqual(read(out), read(one))
                with open("many.json", encoding="utf-8") as file:
                    report = json.load(file)
                self.assertEqual(sum(rank["tets"] for rank in report.pop("ranks")), expected["tets"])
                differs = {"stages", "seconds", "worklistSeconds", "output", "memoryEstimate"}
                for key in set(expected) - differs:
                    self.assertEqual(report[key], expected[key], key)
                os.remove(out)

    def test_the_file_is_that_of_one_process(self):
        self.require_same("sphere.vdb", "out.vtkhdf")
        self.require_same("far.vdb", "out.vtu", "--voxels", "0.4")
        self.require_same("fog.vdb", "out.vtkhdf", "--voxels", "0.3", "--scale", "2.5")
        self.require_same("two_of_a_name.vdb", "out.msh", "-n", "ball[1]")

    def test_graded_insides_are_those_of_one_process(self):
        self.require_same("sphere.vdb", "out.vtkhdf", "--grade", "--voxels", "0.2")
        self.require_same("sphere.vdb", "out.vtu", "--grade", "--voxels", "0.3", "--max-size", "0.06")
        self.require_same("lace.vdb", "out.vtkhdf", "--grade")

    def test_version_3_is_that_of_one_process(self):
        self.require_same("lace.vdb", "out.vtkhdf", "--tiger", "3")
        self.require_same("lace.vdb", "out.vtu", "--tiger", "3", "--tau", "0.5", "--grade")

    def test_points_are_moved_as_in_one_process(self):
        self.require_same("lace.vdb", "out.vtkhdf", "--optimize", "--grade")

    def test_what_the_lattice_does_not_resolve_is_mended_alike(self):
        self.require_same("lace.vdb", "out.vtkhdf")
        self.require_same("lace.vdb", "out.node", "--boundary", "fill", "--tiger", "1")
        self.require_same("lace.vdb", "out.mesh", "--boundary", "raw", "--voxels", "0.8")

    def test_fields_are_those_of_one_process(self):
        self.require_same("fields.vdb", "out.vtkhdf", "-n", "ball", "--sample", "all", "--sample-cells", "all")
        self.require_same("sphere.vdb", "out.msh", "--voxels", "0.3", "--fields-from", "level_set_and_fog.vdb",
                          "--sample", "density,ball", "--boundary-flag", "--min-dihedral", "--scale", "3")

    def test_an_archive_has_the_checksums_of_one_process(self):
        self.require_same("sphere.vdb", "out.npz", "--voxels", "0.3", "--min-dihedral")

    def test_pieces_are_the_mesh_with_their_neighbours_points_marked(self):
        try:
            import numpy
            from vtkmodules.util.numpy_support import vtk_to_numpy
            from vtkmodules.vtkIOXML import vtkXMLUnstructuredGridReader
        except ImportError:
            self.skipTest("python3-vtk9 is not installed")

        def load(path):
            reader = vtkXMLUnstructuredGridReader()
            reader.SetFileName(path)
            reader.Update()
            grid = reader.GetOutput()
            return grid, vtk_to_numpy(grid.GetPoints().GetData()), \
                vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)

        subprocess.run([tool.VDB_TET, "lace.vdb", "one.vtu", "-q", "--grade"], check=True)
        _, points, tets = load("one.vtu")
        for ranks in (1, 3):
            result = self.run_ranks(ranks, "lace.vdb", "out.pvtu", "-q", "--grade")
            self.assertEqual(result.returncode, 0, result.stderr)
            with open("out.pvtu", encoding="utf-8") as file:
                index = file.read()
            found, owned = [], []
            for rank in range(ranks):
                self.assertIn(f'Source="out_{rank}.vtu"', index)
                grid, places, cells = load(f"out_{rank}.vtu")
                data = grid.GetPointData()
                ids = vtk_to_numpy(data.GetArray("GlobalPointIds"))
                self.assertEqual(data.GetGlobalIds().GetName(), "GlobalPointIds")
                self.assertTrue((places == points[ids]).all())
                found.append(ids[cells])
                ghosts = vtk_to_numpy(data.GetArray("vtkGhostType"))
                self.assertEqual((ghosts == 1).any(), ranks > 1)
                owned.append(ids[ghosts == 0])
                os.remove(f"out_{rank}.vtu")
            self.assertTrue((numpy.sort(numpy.concatenate(owned)) == numpy.arange(len(points))).all())
            in_order = [numpy.array(sorted(map(tuple, some))) for some in (numpy.concatenate(found), tets)]
            self.assertTrue((in_order[0] == in_order[1]).all())
            os.remove("out.pvtu")

    def test_a_dry_run_measures_and_writes_nothing(self):
        before = sorted(os.listdir())
        result = self.run_ranks(2, "sphere.vdb", "--dry-run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("dry run", result.stdout)
        self.assertEqual(sorted(os.listdir()), before)

    def test_errors_are_one_line_and_leave_no_file(self):
        before = sorted(os.listdir())
        for code, words, arguments in (
                (1, "none.vdb", ("none.vdb", "out.vtu")),
                (1, "frozen", ("sphere.vdb", "out.vtu", "-n", "frozen")),
                (1, "nowhere", ("sphere.vdb", "nowhere/out.vtu")),
                (2, "compress", ("sphere.vdb", "out.vtu", "--compress")),
                (2, "--distance", ("sphere.vdb", "out.vtu", "--distance")),
                (1, "a rank's part", ("sphere.vdb", "out.vtu", "--max-memory", "1M")),
                (1, "no grid named", ("sphere.vdb", "out.vtu", "--sample", "smoke")),
                (2, "compress", ("sphere.vdb", "out.pvtu", "--compress")),
                (1, "nowhere", ("sphere.vdb", "nowhere/out.pvtu")),
                (2, "fields", ("sphere.vdb", "out.pvtu", "--boundary-flag")),
                (2, "more than one mesh", ("sphere.vdb", "fog.vdb", "{stem}.vtu")),
                (2, "OUT", ("sphere.vdb",))):
            with self.subTest(arguments=arguments):
                result = self.run_ranks(3, *arguments)
                self.assertEqual(result.returncode, code, result.stderr)
                lines = our_lines(result.stderr)
                self.assertEqual(len(lines), 1, result.stderr)
                self.assertIn(words, lines[0])
                self.assertEqual(sorted(os.listdir()), before)

    def start(self):
        """A job of three ranks that has begun its file, and the ranks' process ids in order."""
        before = sorted(os.listdir())
        job = subprocess.Popen(command(3, "sphere.vdb", "out.vtkhdf", "--voxels", "0.15"),
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
        while job.poll() is None and sorted(os.listdir()) == before:
            time.sleep(0.001)
        # Until all ranks have the file open.
        ranks = [pid for pid in tool.children_of(job) if read(f"/proc/{pid}/comm").startswith(b"vdb_tet")]
        while not all(self.has_file(pid) for pid in ranks):
            time.sleep(0.001)
        return job, sorted(ranks)

    def has_file(self, pid):
        for link in os.listdir(f"/proc/{pid}/fd"):
            try:
                if os.readlink(f"/proc/{pid}/fd/{link}").endswith(".tmp"):
                    return True
            except FileNotFoundError:  # closed meanwhile
                pass
        return False

    def test_a_full_disk_ends_all_ranks_with_one_line_and_no_file(self):
        before = sorted(os.listdir())
        for victim in (0, 2):  # at the start of the work, or amid it
            with self.subTest(victim=victim):
                job, ranks = self.start()
                resource.prlimit(ranks[victim], resource.RLIMIT_FSIZE, (100000, 100000))
                _, errors = job.communicate(timeout=120)
                self.assertEqual(job.returncode, 1, errors)
                lines = our_lines(errors)
                self.assertEqual(len(lines), 1, errors)
                self.assertIn("out.vtkhdf", lines[0])
                self.assertEqual(sorted(os.listdir()), before)

    def test_when_a_rank_is_killed_all_end_and_no_file_is_left(self):
        before = sorted(os.listdir())
        for victim in (0, 2):
            with self.subTest(victim=victim):
                job, ranks = self.start()
                os.kill(ranks[victim], signal.SIGKILL)
                job.communicate(timeout=120)
                self.assertNotEqual(job.returncode, 0)
                self.assertEqual(sorted(os.listdir()), before)


if __name__ == "__main__":
    tool.main()
