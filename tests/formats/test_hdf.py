"""The .vtkhdf format and compression: read back by VTK, h5py and meshio, and what is left of files that fail."""
import json
import os
import resource
import signal
import subprocess

from support import VDB_TET, FormatTest, main, need, read_vtu, read_with_vtk
from tool import wait_until_writing

np = need("numpy")

# All that compresses, with and without.
KINDS = [("mesh.vtkhdf",), ("mesh.vtkhdf", "--compress"), ("mesh.vtu", "--compress"), ("mesh.vtu", "--compress=9")]


def read_vtkhdf(path):
    reader = need("vtkmodules.vtkIOHDF").vtkHDFReader()
    if not reader.CanReadFile(path):
        raise ValueError("VTK does not take it for VTKHDF")
    return read_with_vtk(reader, path)


def read_meshio(path):
    mesh = need("meshio").read(path)
    return mesh.points, mesh.cells[0].data.astype(np.int64)


def content(path):
    with open(path, "rb") as file:
        return file.read()


class Hdf(FormatTest):
    def assert_reads(self, read, out, *options):
        """read(out) has the points and tets of the .vtu; of a mesh far from the origin, too, and a fine one."""
        for fixture, more in (("sphere.vdb", []), ("far.vdb", []), ("sphere.vdb", ["-v", "0.4"])):
            with self.subTest(fixture=fixture, more=more, options=options):
                self.mesh(out, *options, *more, fixture=fixture)
                points, tets = read(out)
                self.assert_same(points, tets, self.reference(*more, fixture=fixture))

    def test_vtkhdf(self):
        self.assert_reads(read_vtkhdf, "mesh.vtkhdf")

    def test_vtkhdf_compressed(self):
        self.assert_reads(read_vtkhdf, "mesh.vtkhdf", "--compress")

    def test_vtu_compressed(self):
        self.assert_reads(read_vtu, "mesh.vtu", "--compress")

    def test_vtu_compressed_meshio(self):
        self.assert_reads(read_meshio, "mesh.vtu", "--compress=9")

    def test_vtkhdf_schema(self):
        h5py = need("h5py")
        for options in ([], ["--compress"]):
            self.mesh("mesh.vtkhdf", "-n", "ball", "--sample", "count,vel", *options, fixture="fields.vdb")
            with h5py.File("mesh.vtkhdf", "r") as file:
                root = file["VTKHDF"]
                self.assertEqual(list(root.attrs["Version"]), [1, 0])
                kind = root.attrs.get_id("Type")
                self.assertEqual((kind.dtype, kind.shape), (np.dtype("S16"), ()))
                self.assertEqual(root.attrs["Type"], b"UnstructuredGrid")
                points, cells, ids = (int(root["NumberOf" + name][0]) for name in ("Points", "Cells", "ConnectivityIds"))
                self.assertEqual(ids, 4 * cells)
                shapes = {"Points": (points, 3), "Connectivity": (ids,), "Offsets": (cells + 1,), "Types": (cells,),
                          "PointData/count": (points,), "PointData/vel": (points, 3)}
                for name, shape in shapes.items():
                    self.assertEqual(root[name].shape, shape, name)
                    self.assertEqual(root[name].compression, "gzip" if options else None)
                self.assertEqual(root["Offsets"].dtype, root["Connectivity"].dtype)
                self.assertTrue((root["Offsets"][:] == 4 * np.arange(cells + 1)).all())
                self.assertTrue((root["Types"][:] == 10).all())

    def test_any_number_of_threads_gives_the_same_bytes(self):
        for out, *options in KINDS[:3]:
            contents = set()
            for threads in "1", "2", "4", "4":
                self.mesh(out, *options, "-v", "0.5", "-j", threads)
                contents.add(content(out))
            self.assertEqual(len(contents), 1, (out, options))

    def test_compressed_is_smaller(self):
        for out in "mesh.vtkhdf", "mesh.vtu":
            self.mesh("plain-" + out)
            self.mesh("small-" + out, "--compress")
            self.assertLess(os.path.getsize("small-" + out), 0.5 * os.path.getsize("plain-" + out))

    def test_sizes_that_are_told(self):
        def report(out, *options):
            self.mesh(out, *options, "--report", "report.json")
            with open("report.json") as file:
                return json.load(file)
        for out, *options in KINDS:
            real = report(out, *options)["bytes"]
            self.assertEqual(real, os.path.getsize(out))
            dry = report(out, *options, "--dry-run")
            if options:
                self.assertNotIn("bytes", dry)
                self.assertGreater(dry["bytesAtMost"], real)
            else:
                self.assertEqual(dry["bytes"], real)
        text = subprocess.run([VDB_TET, "sphere.vdb", "--dry-run", "--compress"], capture_output=True, text=True)
        self.assertIn("it would take at most", text.stdout)

    def test_compression_that_cannot_be(self):
        for message, arguments in [
            ("the format npz is written without compression; those with it are vtu, vtkhdf", ["mesh.npz", "--compress"]),
            ("the format vtu-inline is", ["mesh.vtu", "--format", "vtu-inline", "--compress"]),
            ("--compress: ", ["mesh.vtu", "--compress=0"]),
            ("--compress: ", ["mesh.vtu", "--compress=10"]),
            ("--compress", ["mesh.vtu", "--compress=best"]),
        ]:
            result = subprocess.run([VDB_TET, "sphere.vdb", *arguments], capture_output=True, text=True)
            self.assertEqual(result.returncode, 2, result.stderr)
            self.assertIn(message, result.stderr)

    def assert_nothing_new(self, before):
        """The old file stands, and no other has come."""
        for name in before:
            if name.startswith("mesh."):
                self.assertEqual(content(name), b"old")
        self.assertEqual(sorted(os.listdir()), before)

    def old_files(self):
        for name in "mesh.vtu", "mesh.vtkhdf":
            with open(name, "w") as file:
                file.write("old")
        return sorted(os.listdir())

    def test_full_disk_leaves_the_old_file(self):
        before = self.old_files()
        for out, *options in KINDS[:3]:
            for limit in 0, 100, 5000, 400_000:
                result = subprocess.run(
                    [VDB_TET, "sphere.vdb", out, *options, "-v", "0.5"], capture_output=True, text=True,
                    preexec_fn=lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (limit, limit)))
                with self.subTest(out=out, options=options, limit=limit):
                    self.assertEqual((result.returncode, result.stdout, result.stderr),
                                     (1, "", f"vdb_tet: cannot write {out}: File too large\n"))
                    self.assert_nothing_new(before)

    def test_signals_leave_the_old_file(self):
        before = self.old_files()
        for out, *options in KINDS:
            with self.subTest(out=out, options=options):
                # Fine enough to take far longer than the signal needs to arrive.
                process = subprocess.Popen([VDB_TET, "sphere.vdb", out, "-v", "0.05", *options],
                                           stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
                wait_until_writing(process)
                process.send_signal(signal.SIGTERM)
                out, err = process.communicate(timeout=120)
                self.assertEqual((process.returncode, out, err),
                                 (143, "", "vdb_tet: interrupted; nothing was written\n"))
                self.assert_nothing_new(before)


if __name__ == "__main__":
    main()
