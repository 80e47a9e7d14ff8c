"""What the tests of the formats have in common: meshes written by vdb_tet, and the same ones as VTK reads them.

usage of such a test: test_X.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
Exit code 77 tells that the format's reader is not installed.
"""
import importlib
import os
import subprocess
import sys
import tempfile
import time
import unittest

VDB_TET, MAKE_FIXTURES = map(os.path.abspath, sys.argv[1:3])


def need(module):
    """Import the reader of a format, or skip the test, loudly."""
    try:
        return importlib.import_module(module)
    except ImportError:
        print(f"SKIPPED: python module {module} is missing; see tools/install_deps.sh --ci")
        sys.exit(77)


def read_vtu(path):
    """Points and tets as VTK reads them."""
    numpy_support = need("vtkmodules.util.numpy_support")
    reader = need("vtkmodules.vtkIOXML").vtkXMLUnstructuredGridReader()
    reader.SetFileName(path)
    reader.Update()
    grid = reader.GetOutput()
    points = numpy_support.vtk_to_numpy(grid.GetPoints().GetData())
    tets = numpy_support.vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4)
    return points, tets


def wait_until_writing(process):
    """Until the process, which reads sphere.vdb, has another file of this folder open; it may have no name."""
    links = f"/proc/{process.pid}/fd"
    while process.poll() is None:
        for link in os.listdir(links):
            try:
                path = os.readlink(os.path.join(links, link))
            except FileNotFoundError:
                continue  # closed meanwhile
            if path.startswith(os.getcwd() + "/") and not path.endswith("sphere.vdb"):
                return
        time.sleep(0.001)


class FormatTest(unittest.TestCase):
    """Runs in a folder of its own that holds the fixtures of tests/cli."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(directory.name)
        subprocess.run([MAKE_FIXTURES], check=True)

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


def main():
    method = "test_" + sys.argv[3]
    case = next(test for test in vars(sys.modules["__main__"]).values()
                if isinstance(test, type) and issubclass(test, FormatTest) and hasattr(test, method))
    result = unittest.TextTestRunner(verbosity=2).run(case(method))
    sys.exit(not result.wasSuccessful())
