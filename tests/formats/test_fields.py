"""Fields of other grids at the points of the mesh, read back by programs not ours."""
import subprocess

import numpy

from support import VDB_TET, FormatTest, main, need

HEAT = "heat & <light>"


def expected(points):
    """The fields of fields.vdb, which are linear."""
    x, y, z = numpy.asarray(points, numpy.float64).T
    return {HEAT: 2 * x - y + z / 2 + 3, "count": (x + 2 * y - 3 * z) / 0.15,
            "vel": numpy.stack([x, 2 * y, 3 * z], axis=1)}


def read_with_vtk(reader, path):
    support = need("vtkmodules.util.numpy_support")
    reader.SetFileName(path)
    if hasattr(reader, "ReadAllFieldsOn"):
        reader.ReadAllFieldsOn()
    reader.Update()
    grid = reader.GetOutput()
    data = grid.GetPointData()
    arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
    return (support.vtk_to_numpy(grid.GetPoints().GetData()),
            {array.GetName(): support.vtk_to_numpy(array) for array in arrays})


class Fields(FormatTest):
    def check(self, points, fields, names=(HEAT, "count", "vel")):
        self.assertEqual(set(fields), set(names))
        values = expected(points)
        for name in names:
            error = abs(numpy.asarray(fields[name], numpy.float64) - values[name]).max()
            self.assertLess(error, 1e-5 * (1 + abs(values[name]).max()), name)

    def test_fields_in_vtu(self):
        for options in ([], ["--grade"]):
            self.mesh("mesh.vtu", "-n", "ball", "--sample", "all", *options, fixture="fields.vdb")
            self.check(*read_with_vtk(need("vtkmodules.vtkIOXML").vtkXMLUnstructuredGridReader(), "mesh.vtu"))

    def test_fields_in_vtk(self):
        self.mesh("mesh.vtk", "-n", "ball", "--sample", "all", fixture="fields.vdb")
        self.check(*read_with_vtk(need("vtkmodules.vtkIOLegacy").vtkUnstructuredGridReader(), "mesh.vtk"))

    def test_fields_in_npz(self):
        self.mesh("mesh.npz", "-n", "ball", "--sample", "vel,count", fixture="fields.vdb")
        arrays = numpy.load("mesh.npz")
        self.check(arrays["vertices"], {name: arrays["point_" + name] for name in ("vel", "count")},
                   ("vel", "count"))

    def test_fields_from_another_file(self):
        self.mesh("mesh.vtu", "--sample", "count", "--fields-from", "fields.vdb")
        points, fields = read_with_vtk(need("vtkmodules.vtkIOXML").vtkXMLUnstructuredGridReader(), "mesh.vtu")
        self.check(points, fields, ["count"])

    def test_fields_of_any_number_of_threads(self):
        self.mesh("one.vtu", "-n", "ball", "--sample", "all", "-j", "1", fixture="fields.vdb")
        self.mesh("four.vtu", "-n", "ball", "--sample", "all", "-j", "4", fixture="fields.vdb")
        with open("one.vtu", "rb") as one, open("four.vtu", "rb") as four:
            self.assertEqual(one.read(), four.read())

    def test_fields_that_cannot_be(self):
        for code, message, arguments in [
            (1, "no grid named \"warmth\"; it holds: ball", ["mesh.vtu", "--sample", "warmth"]),
            (2, "without fields", ["mesh.inp", "--sample", "count"]),
        ]:
            result = subprocess.run([VDB_TET, "fields.vdb", "-n", "ball", *arguments], capture_output=True, text=True)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(message, result.stderr)


if __name__ == "__main__":
    main()
