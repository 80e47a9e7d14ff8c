"""The boundary alone, read back by VTK and meshio."""
import numpy

from support import FormatTest, main, need, read_vtu


def boundary_of(points, tets):
    """The corners of the faces of exactly one tet, each turned such that the least one is first, sorted."""
    faces = numpy.concatenate([tets[:, face] for face in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])])
    _, first, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    return corners_of(points, faces[first[count == 1]])


def corners_of(points, triangles):
    corners = []
    for triangle in numpy.asarray(points, numpy.float32)[triangles].tolist():
        least = triangle.index(min(triangle))
        corners.append(triangle[least:] + triangle[:least])
    return sorted(corners)


def read_with_vtk(reader, path):
    support = need("vtkmodules.util.numpy_support")
    reader.SetFileName(path)
    reader.Update()
    surface = reader.GetOutput()
    points = support.vtk_to_numpy(surface.GetPoints().GetData())
    return points, support.vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3)


class Surfaces(FormatTest):
    def check(self, extension, read):
        for options in ([], ["--grade"]):
            self.mesh("mesh.vtu", "--surface", "surface" + extension, *options)
            points, tets = read_vtu("mesh.vtu")
            surface, triangles = read("surface" + extension)
            self.assertEqual(corners_of(surface, triangles), boundary_of(points, tets))
            self.assertEqual(len(numpy.unique(triangles)), len(surface))
            # Closed: each directed edge comes once, and so does its reverse.
            edges = {(a, b) for t in triangles.tolist() for a, b in zip(t, t[1:] + t[:1])}
            self.assertEqual(len(edges), triangles.size)
            self.assertTrue(all((b, a) in edges for a, b in edges))

    def test_obj_surface(self):
        self.check(".obj", lambda path: read_with_vtk(need("vtkmodules.vtkIOGeometry").vtkOBJReader(), path))

    def test_ply_surface(self):
        self.check(".ply", lambda path: read_with_vtk(need("vtkmodules.vtkIOPLY").vtkPLYReader(), path))

    def test_ply_surface_in_meshio(self):
        def read(path):
            mesh = need("meshio").read(path)
            return mesh.points, mesh.cells_dict["triangle"]
        self.check(".ply", read)

    def test_stl_surface(self):
        self.check(".stl", lambda path: read_with_vtk(need("vtkmodules.vtkIOGeometry").vtkSTLReader(), path))


if __name__ == "__main__":
    main()
