"""What the tests of the formats have in common: meshes written by vdb_tet, and the same ones as VTK reads them.

usage of such a test: test_X.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
Exit code 77 tells that the format's reader is not installed.
"""
import importlib
import os
import subprocess
import sys

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from tool import VDB_TET, ToolTest, main


def need(module):
    """Import the reader of a format, or skip the test, loudly."""
    try:
        return importlib.import_module(module)
    except ImportError:
        print(f"SKIPPED: python module {module} is missing; see tools/install_deps.sh --ci")
        sys.exit(77)


def read_with_vtk(reader, path):
    """Points and tets."""
    numpy_support = need("vtkmodules.util.numpy_support")
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    if set(numpy_support.vtk_to_numpy(grid.GetCellTypesArray())) != {10}:
        raise ValueError("not tets alone")
    points = numpy_support.vtk_to_numpy(grid.GetPoints().GetData())
    tets = numpy_support.vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return points, tets


def read_vtu(path):
    return read_with_vtk(need("vtkmodules.vtkIOXML").vtkXMLUnstructuredGridReader(), path)


class FormatTest(ToolTest):
    def mesh(self, out, *options, fixture="sphere.vdb"):
        """Write a mesh, quietly."""
        subprocess.run([VDB_TET, "-q", fixture, out, *options], check=True, timeout=240)

    def reference(self, *options, fixture="sphere.vdb"):
        """The same mesh by way of VTK: points and tets."""
        self.mesh("reference.vtu", *options, fixture=fixture)
        return read_vtu("reference.vtu")

    def assert_same(self, points, tets, expected, tolerance=0.0):
        """The same tets, and points within so much of the largest coordinate."""
        expected_points, expected_tets = expected
        self.assertEqual(points.shape, expected_points.shape)
        self.assertTrue((abs(points - expected_points) <= tolerance * abs(expected_points).max()).all())
        self.assertEqual(tets.shape, expected_tets.shape)
        self.assertTrue((tets == expected_tets).all())
