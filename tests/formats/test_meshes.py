"""The formats of mesh generators and solvers, each read back by a program that is not ours."""
import numpy as np

from support import FormatTest, main, need

# A volume far from the origin, whose coordinates need float64.
FAR = "far.vdb"


class MeshesTest(FormatTest):
    def assert_reads(self, read, out, *options, tolerance=0.0):
        """read(out) has the points and tets of the .vtu, near the origin and far from it."""
        for fixture, precision in (("sphere.vdb", np.float32), (FAR, np.float64)):
            with self.subTest(fixture):
                self.mesh(out, *options, fixture=fixture)
                points, tets = read(out)
                expected = self.reference(fixture=fixture)
                self.assertEqual(expected[0].dtype, precision)
                self.assert_same(np.asarray(points).astype(precision), tets, expected, tolerance)

    def test_vtk(self):
        self.assert_reads(read_vtk, "mesh.vtk")


def read_vtk(path):
    """Points and tets as VTK reads them from a legacy file."""
    numpy_support = need("vtkmodules.util.numpy_support")
    reader = need("vtkmodules.vtkIOLegacy").vtkUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    if set(numpy_support.vtk_to_numpy(grid.GetCellTypesArray())) != {10}:
        raise ValueError("not tets alone")
    points = numpy_support.vtk_to_numpy(grid.GetPoints().GetData())
    return points, numpy_support.vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)


if __name__ == "__main__":
    main()
