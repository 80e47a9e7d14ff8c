"""The formats of mesh generators and solvers, each read back by a program that is not ours."""
from support import FormatTest, main, need, read_vtu, read_with_vtk

np = need("numpy")

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

    def test_vtk_meshio(self):
        self.assert_reads(read_meshio, "mesh.vtk")

    def test_msh(self):
        self.assert_reads(read_gmsh, "mesh.msh")

    def test_msh_meshio(self):
        self.assert_reads(read_meshio, "mesh.msh")

    def test_msh22(self):
        self.assert_reads(read_gmsh, "mesh.msh", "--format", "msh22")

    def test_msh22_meshio(self):
        self.assert_reads(read_meshio, "mesh.msh", "--format", "msh22")

    def test_mesh(self):
        self.assert_reads(read_gmsh, "mesh.mesh")

    def test_mesh_meshio(self):
        self.assert_reads(read_meshio, "mesh.mesh")

    def test_meshb(self):
        self.assert_reads(read_meshio, "mesh.meshb")

    def test_vtu_inline(self):
        self.assert_reads(read_vtu, "mesh.vtu", "--format", "vtu-inline")

    def test_vtu_inline_meshio(self):
        self.assert_reads(read_meshio, "mesh.vtu", "--format", "vtu-inline")


def read_vtk(path):
    return read_with_vtk(need("vtkmodules.vtkIOLegacy").vtkUnstructuredGridReader(), path)


def read_gmsh(path):
    """Points and tets as Gmsh reads them: one volume, which is the physical group 1."""
    gmsh = need("gmsh")
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        entities = gmsh.model.getEntities()
        if entities != [(3, 1)]:
            raise ValueError(f"entities {entities}")
        if not path.endswith(".mesh") and gmsh.model.getPhysicalGroups() != [(3, 1)]:
            raise ValueError(f"physical groups {gmsh.model.getPhysicalGroups()}")
        point_tags, coordinates, _ = gmsh.model.mesh.getNodes()
        types, _, ids = gmsh.model.mesh.getElements()
    finally:
        gmsh.finalize()
    if list(types) != [4]:
        raise ValueError(f"element types {types}")
    points = coordinates.reshape(-1, 3)[np.argsort(point_tags)]
    return points, ids[0].astype(np.int64).reshape(-1, 4) - 1


def read_meshio(path):
    """Points and tets as meshio reads them."""
    mesh = need("meshio").read(path)
    if [block.type for block in mesh.cells] != ["tetra"]:
        raise ValueError("not tets alone")
    return mesh.points, mesh.cells[0].data.astype(np.int64)


if __name__ == "__main__":
    main()
