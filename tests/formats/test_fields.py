"""Fields at the points and in the tets of the mesh, read back by programs not ours."""
import json
import os
import re
import resource
import shutil
import subprocess
import sys

import numpy

from support import VDB_TET, FormatTest, main, need

HEAT = "heat & <light>"
OWN = ["--boundary-flag", "--min-dihedral", "--distance"]
ALL = ["-n", "ball", "--sample", "all", "--sample-cells", "all", *OWN]
POINT_NAMES = (HEAT, "count", "vel", "distance", "boundary")
CELL_NAMES = (HEAT, "count", "vel", "min_dihedral")
SHARED = os.environ.get("VDBTET_SHARED", os.path.join(os.path.dirname(__file__), "../../../shared"))


def expected(points):
    """The fields of fields.vdb, which are linear."""
    x, y, z = numpy.asarray(points, numpy.float64).T
    return {HEAT: 2 * x - y + z / 2 + 3, "count": (x + 2 * y - 3 * z) / 0.15,
            "vel": numpy.stack([x, 2 * y, 3 * z], axis=1)}


def faces_of(tets):
    return numpy.sort(numpy.concatenate([tets[:, face] for face in ([1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1])]))


def expected_at_points(points, tets):
    """And those of the mesh itself, a ball of radius 1 about the origin."""
    values = expected(points)
    faces, count = numpy.unique(faces_of(tets), axis=0, return_counts=True)
    values["boundary"] = numpy.zeros(len(points))
    values["boundary"][faces[count == 1]] = 1
    values["distance"] = numpy.linalg.norm(points, axis=1) - 1
    return values


def expected_in_tets(points, tets):
    points = numpy.asarray(points, numpy.float64)
    values = expected(points[tets].mean(axis=1))
    values["min_dihedral"] = smallest_angles(points[tets])
    return values


def smallest_angles(corners):
    """By the angles between the normals of all pairs of faces."""
    normals = []
    for a, b, c, d in ((1, 2, 3, 0), (0, 3, 2, 1), (0, 1, 3, 2), (0, 2, 1, 3)):
        a, b, c, d = (corners[:, i] for i in (a, b, c, d))
        normal = numpy.cross(b - a, c - a)
        normal *= numpy.sign(numpy.einsum("ij,ij->i", normal, a - d))[:, None]  # outward
        normals.append(normal / numpy.linalg.norm(normal, axis=1)[:, None])
    cosines = [-numpy.einsum("ij,ij->i", normals[i], normals[j]) for i in range(4) for j in range(i)]
    return numpy.degrees(numpy.arccos(numpy.clip(numpy.max(cosines, axis=0), -1, 1)))


def read_with_vtk(reader, path):
    """Points, tets, and the fields at points and in tets."""
    support = need("vtkmodules.util.numpy_support")
    reader.SetFileName(path)
    if hasattr(reader, "ReadAllFieldsOn"):
        reader.ReadAllFieldsOn()
    errors = []
    reader.AddObserver("ErrorEvent", lambda *event: errors.append(event))
    reader.Update()
    assert not errors
    grid = reader.GetOutput()
    fields = []
    for data in grid.GetPointData(), grid.GetCellData():
        arrays = [data.GetArray(i) for i in range(data.GetNumberOfArrays())]
        fields.append({array.GetName(): support.vtk_to_numpy(array) for array in arrays})
    return (support.vtk_to_numpy(grid.GetPoints().GetData()),
            support.vtk_to_numpy(grid.GetCells().GetConnectivityArray()).reshape(-1, 4), *fields)


def read_vtu_fields(path):
    return read_with_vtk(need("vtkmodules.vtkIOXML").vtkXMLUnstructuredGridReader(), path)


def read_meshio(path):
    mesh = need("meshio").read(path)
    own = lambda fields: {name: fields[name] for name in fields if not name.startswith("gmsh:")}
    return (mesh.points, mesh.cells_dict["tetra"].astype(int), own(mesh.point_data),
            {name: blocks[0] for name, blocks in own(mesh.cell_data).items()})


def read_gmsh(path):
    """Each field is a view of one step."""
    gmsh = need("gmsh")
    gmsh.initialize()
    try:
        gmsh.option.setNumber("General.Terminal", 0)
        gmsh.open(path)
        point_tags, coordinates, _ = gmsh.model.mesh.getNodes()
        types, tet_tags, ids = gmsh.model.mesh.getElements()
        assert list(types) == [4]
        order = numpy.argsort(point_tags)
        fields = {"NodeData": {}, "ElementData": {}}
        for view in gmsh.view.getTags():
            name = gmsh.option.getString(f"View[{gmsh.view.getIndex(view)}].Name")
            kind, tags, values, _, components = gmsh.view.getModelData(view, 0)
            values = numpy.array(values)[numpy.argsort(tags)]
            assert len(tags) == len(point_tags if kind == "NodeData" else tet_tags[0])
            fields[kind][name] = values[:, 0] if components == 1 else values
    finally:
        gmsh.finalize()
    assert (numpy.diff(tet_tags[0]) > 0).all()
    return (coordinates.reshape(-1, 3)[order], ids[0].astype(int).reshape(-1, 4) - 1,
            fields["NodeData"], fields["ElementData"])


def pairs(array):
    return dict(zip(array[::2], array[1::2], strict=True))


def read_geo(path):
    with open(path) as file:
        text = file.read()
    assert not re.search(r"\s,", text)  # Unreal's own parser knows no space before a comma
    geo = pairs(json.loads(text))
    attributes = pairs(geo["attributes"])
    fields = []
    for scope in "pointattributes", "primitiveattributes":
        fields.append({})
        for attribute in attributes[scope]:
            definition, content = map(pairs, attribute)
            values = pairs(content["values"])
            assert values["size"] == content["size"] and values["storage"] == content["storage"]
            fields[-1][definition["name"]] = numpy.array(
                values["arrays"][0] if content["size"] == 1 else values["tuples"])
    points = fields[0].pop("P")
    tets = numpy.array(pairs(pairs(geo["topology"])["pointref"])["indices"]).reshape(-1, 4)
    return points, tets, *fields


def usd_numbers(text, width):
    return numpy.array(re.findall(r"[-+.\w]+", text), float).reshape(-1, width).squeeze()


def read_usda(path):
    with open(path) as file:
        text = file.read()
    attribute = lambda name: re.search(rf" {name} = \[(.*?)\]", text, re.DOTALL).group(1)
    fields = {"vertex": {}, "uniform": {}}
    for kind, name, values, interpolation in re.findall(
            r'    (float3?)\[\] primvars:(\w+) = \[(.*?)\] \(\n        interpolation = "(\w+)"\n    \)\n',
            text, re.DOTALL):
        fields[interpolation][name] = usd_numbers(values, 3 if kind == "float3" else 1)
    return (usd_numbers(attribute("points"), 3), usd_numbers(attribute("tetVertexIndices"), 4).astype(int),
            fields["vertex"], fields["uniform"])


def read_npz(path):
    arrays = numpy.load(path, allow_pickle=False)
    of = lambda prefix: {name[len(prefix):]: arrays[name] for name in arrays if name.startswith(prefix)}
    return arrays["vertices"], arrays["tet_indices"], of("point_"), of("cell_")


def split(columns):
    """Attributes without names, in the order of those of fields.vdb."""
    widths = {HEAT: 1, "count": 1, "vel": 3}
    names = [*widths, *("x" * (columns.shape[1] - 5))]
    fields, at = [], 0
    for name in names:
        width = widths.get(name, 1)
        fields.append(columns[:, at] if width == 1 else columns[:, at:at + width])
        at += width
    assert at == columns.shape[1]
    return fields


def read_tetgen(stem):
    rows = lambda path: numpy.array([line.split() for line in open(path).read().split("\n")[1:]
                                     if line.strip() and line[0] != "#"], float)
    node, ele = rows(stem + ".node"), rows(stem + ".ele")
    return (node[:, 1:4], ele[:, 1:5].astype(int) - 1, dict(zip(POINT_NAMES, split(node[:, 4:]), strict=True)),
            dict(zip(CELL_NAMES, split(ele[:, 5:]), strict=True)))


class Fields(FormatTest):
    def compare(self, fields, values, names):
        self.assertEqual(sorted(fields), sorted(names))
        for name in names:
            values_read = numpy.asarray(fields[name], numpy.float64)
            self.assertEqual(values_read.shape, values[name].shape, name)
            # Distances are to polygons within the ball, as far as they reach.
            tolerance = 0.02 if name == "distance" else 1e-3 if name == "min_dihedral" else \
                1e-5 * (1 + abs(values[name]).max())
            near = values["distance"] > -0.1 if name == "distance" else ...
            self.assertLess(abs(values_read - values[name])[near].max(), tolerance, name)

    def check(self, out, read, *options, renamed=None):
        """All fields, uniform and graded."""
        rename = lambda names: [renamed(name) if renamed else name for name in names]
        for more in ([], ["--grade"]):
            self.mesh(out, *ALL, *options, *more, fixture="fields.vdb")
            points, tets, at_points, in_tets = read(out)
            self.assertEqual(points.shape[1:], (3,))
            for fields, values, names in ((at_points, expected_at_points(points, tets), POINT_NAMES),
                                          (in_tets, expected_in_tets(points, tets), CELL_NAMES)):
                self.compare(fields, {renamed(name) if renamed else name: v for name, v in values.items()},
                             rename(names))

    def test_fields_in_vtu(self):
        self.check("mesh.vtu", read_vtu_fields)

    def test_fields_in_vtu_inline(self):
        self.check("mesh.vtu", read_vtu_fields, "--format", "vtu-inline")

    def test_fields_in_vtu_inline_by_meshio(self):
        self.check("mesh.vtu", read_meshio, "--format", "vtu-inline")

    def test_fields_in_vtkhdf_and_compressed(self):
        read_hdf = lambda path: read_with_vtk(need("vtkmodules.vtkIOHDF").vtkHDFReader(), path)
        self.check("mesh.vtkhdf", read_hdf)
        self.check("mesh.vtkhdf", read_hdf, "--compress")
        self.check("mesh.vtu", read_vtu_fields, "--compress")

    def test_fields_in_vtk(self):
        self.check("mesh.vtk", lambda path: read_with_vtk(
            need("vtkmodules.vtkIOLegacy").vtkUnstructuredGridReader(), path))

    def test_fields_in_msh(self):
        self.check("mesh.msh", read_gmsh)

    def test_fields_in_msh_by_meshio(self):
        self.check("mesh.msh", read_meshio)

    def test_fields_in_msh22(self):
        self.check("mesh.msh", read_gmsh, "--format", "msh22")

    def test_fields_in_msh22_by_meshio(self):
        self.check("mesh.msh", read_meshio, "--format", "msh22")

    def test_fields_in_npz(self):
        self.check("mesh.npz", read_npz)

    def test_fields_in_geo(self):
        self.check("mesh.geo", read_geo, renamed=lambda name: re.sub(r"\W", "_", name))

    def test_fields_in_usda(self):
        # One namespace for both: what the tets have of a name that a point field has gets a "_".
        def read(path):
            points, tets, at_points, in_tets = read_usda(path)
            return points, tets, at_points, {re.sub("^(heat.*|count|vel)_$", r"\1", name): values
                                             for name, values in in_tets.items()}
        self.check("mesh.usda", read, renamed=lambda name: re.sub(r"\W", "_", name))
        self.assertEqual(sorted(read_usda("mesh.usda")[3]),
                         ["count_", "heat____light__", "min_dihedral", "vel_"])

    def test_fields_in_tetgen(self):
        self.check("mesh.node", lambda path: read_tetgen("mesh"))

    def test_fields_in_tetgen_by_tetgen(self):
        if not shutil.which("tetgen"):
            print("SKIPPED: tetgen is missing; see tools/install_deps.sh --ci")
            sys.exit(77)
        self.mesh("mesh.node", *ALL, fixture="fields.vdb")
        _, _, at_points, _ = read_tetgen("mesh")
        subprocess.run(["tetgen", "-rQ", "mesh"], stdout=subprocess.DEVNULL, check=True, timeout=240)
        with open("mesh.1.node") as node, open("mesh.1.ele") as ele:
            self.assertEqual(node.readline().split()[2], "7")
            self.assertEqual(ele.readline().split()[2], "6")
        points, tets, read_at_points, in_tets = read_tetgen("mesh.1")
        for name in POINT_NAMES:
            self.assertTrue(numpy.allclose(read_at_points[name], at_points[name], 1e-5, 1e-6), name)
        self.compare(in_tets, expected_in_tets(points, tets), CELL_NAMES)

    def test_fields_of_a_few_points(self):
        """Every position of chunks and values in groups of three bytes."""
        for voxels in ("3", "5", "7"):
            self.mesh("mesh.vtu", *ALL, "-v", voxels, fixture="fields.vdb")
            self.mesh("inline.vtu", *ALL, "-v", voxels, "--format", "vtu-inline", fixture="fields.vdb")
            for raw, inline in zip(read_vtu_fields("mesh.vtu")[2:], read_vtu_fields("inline.vtu")[2:], strict=True):
                for name, values in raw.items():
                    self.assertTrue((inline[name] == values).all())

    def test_fields_from_another_file(self):
        self.mesh("mesh.vtu", "--sample", "count", "--sample-cells", "vel", "--fields-from", "fields.vdb")
        points, tets, at_points, in_tets = read_vtu_fields("mesh.vtu")
        self.compare(at_points, expected(points), ["count"])
        self.compare(in_tets, expected_in_tets(points, tets), ["vel"])

    def test_fields_of_real_files(self):
        """Several grids of a file that is not ours, as far as we can know their values."""
        path = os.path.join(SHARED, "data/real/PixarAnimationStudios__densityAndHeat__52d01502.vdb")
        if not os.path.exists(path):
            print("SKIPPED: there is no " + path + "; set VDBTET_SHARED to the shared folder")
            sys.exit(77)
        self.mesh("mesh.vtu", "-n", "density", "-i", "0.3", "--sample", "density,heat", "--sample-cells", "heat",
                  *OWN, fixture=path)
        points, tets, at_points, in_tets = read_vtu_fields("mesh.vtu")
        self.assertEqual(sorted(at_points), ["boundary", "density", "distance", "heat"])
        self.assertEqual(sorted(in_tets), ["heat", "min_dihedral"])
        on_surface = at_points["boundary"] == 1
        # Points on the surface lie on the isosurface, and at a distance of less than half a voxel.
        self.assertLess(numpy.quantile(abs(at_points["density"][on_surface] - 0.3), 0.9), 0.02)
        self.assertLess(numpy.quantile(abs(at_points["distance"][on_surface]), 0.9), 0.35)
        self.assertGreater(at_points["density"][~on_surface].min(), 0.29)
        self.assertLess(at_points["distance"][~on_surface].max(), 0.35)
        self.assertGreater(at_points["heat"].max(), 0.5)
        # A tet's value is near those of its corners.
        corners = at_points["heat"][tets]
        self.assertLess(abs(in_tets["heat"] - corners.mean(axis=1)).mean(), 0.02)
        self.assertLess(abs(in_tets["min_dihedral"] - smallest_angles(points[tets].astype(float))).max(), 0.05)

    def test_fields_of_a_name(self):
        """Grids that share a name, and have transforms of their own."""
        path = os.path.join(SHARED, "data/real/Autodesk__grids__c042818e.vdb")
        if not os.path.exists(path):
            print("SKIPPED: there is no " + path + "; set VDBTET_SHARED to the shared folder")
            sys.exit(77)
        names = ",".join(f"density[{i}]" for i in range(3))
        self.mesh("mesh.vtu", "-n", "density[1]", "--sample", names, "--sample-cells", names, fixture=path)
        points, tets, at_points, in_tets = read_vtu_fields("mesh.vtu")
        self.assertEqual(sorted(at_points), ["density", "density_", "density__"])
        self.assertEqual(sorted(in_tets), ["density", "density_", "density__"])
        self.assertGreater(at_points["density_"].min(), 0.4) # the one that is meshed, where it is above 0.5
        self.assertGreater(in_tets["density_"].min(), 0.3)

    def test_fields_of_any_number_of_threads(self):
        formats = ["vtu", "vtu-inline", "vtk", "msh", "msh22", "tetgen", "npz", "geo", "usda"]
        for name in formats:
            for threads in "1", "2", "4":
                # Many chunks.
                self.mesh(threads + ".node", *ALL, "-v", "0.7", "--format", name, "-j", threads,
                          fixture="fields.vdb")
            for extension in [".node", ".ele", ".face"] if name == "tetgen" else [".node"]:
                files = []
                for threads in "1", "2", "4":
                    with open(threads + extension, "rb") as file:
                        files.append(file.read())
                self.assertEqual(files[0], files[1], name)
                self.assertEqual(files[0], files[2], name)

    def test_fields_that_cannot_be(self):
        for code, message, arguments in [
            (1, "no grid named \"warmth\"; it holds: ball", ["mesh.vtu", "--sample", "warmth"]),
            (1, "no grid named \"warmth\"; it holds: ball", ["mesh.vtu", "--sample-cells", "count,warmth"]),
            (2, "without fields", ["mesh.inp", "--sample", "count"]),
            (2, "without fields", ["mesh.mesh", "--sample-cells", "count"]),
            (2, "without fields", ["mesh.meshb", "--distance"]),
            (2, "without fields", ["mesh.inp", "--min-dihedral", "--dry-run"]),
            (2, "without fields", ["mesh.inp", "--boundary-flag"]),
            (2, "not a positive number", ["mesh.vtu", "--distance", "0"]),
            (2, "--fields-from", ["mesh.vtu", "--fields-from", "fields.vdb"]),
            (2, "not a positive number", ["mesh.vtu", "--scale", "-1"]),
            (2, "states no up axis", ["mesh.vtu", "--up-axis", "z"]),
            (2, "states no up axis", ["mesh.geo", "--meters-per-unit", "0.01"]),
            (2, "states no up axis", ["mesh.vtu", "--usd-surface"]),
        ]:
            result = subprocess.run([VDB_TET, "fields.vdb", "-n", "ball", *arguments], capture_output=True, text=True)
            self.assertEqual(result.returncode, code, result.stderr)
            self.assertIn(message, result.stderr)
            self.assertEqual([name for name in os.listdir() if name.startswith("mesh")], [])

    def test_fields_on_a_full_disk(self):
        limit = lambda: resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
        for name in ["vtu", "vtu-inline", "vtk", "msh", "msh22", "tetgen", "npz", "geo", "usda"]:
            files = ["mesh.node", "mesh.ele", "mesh.face"] if name == "tetgen" else ["mesh.node"]
            for path in files:
                with open(path, "w") as file:
                    file.write("old")
            before = sorted(os.listdir())
            result = subprocess.run([VDB_TET, "fields.vdb", "mesh.node", *ALL, "--format", name],
                                    capture_output=True, text=True, preexec_fn=limit)
            self.assertEqual(result.returncode, 1, name)
            self.assertIn("File too large", result.stderr)
            self.assertEqual(sorted(os.listdir()), before)
            for path in files:
                with open(path) as file:
                    self.assertEqual(file.read(), "old")

    def test_fields_that_are_as_they_were_when_scaled(self):
        self.mesh("mesh.vtu", *ALL, "--surface", "mesh.ply", fixture="fields.vdb")
        self.mesh("scaled.vtu", *ALL, "--scale", "4", "--surface", "scaled.ply", fixture="fields.vdb")
        points, tets, *fields = read_vtu_fields("mesh.vtu")
        scaled_points, scaled_tets, *scaled_fields = read_vtu_fields("scaled.vtu")
        self.assertTrue((scaled_points == 4 * points).all())
        self.assertTrue((scaled_tets == tets).all())
        for one, other in zip(fields, scaled_fields):
            for name in one:
                self.assertTrue((one[name] == other[name]).all(), name)
        meshio = need("meshio")
        self.assertTrue((meshio.read("scaled.ply").points == 4 * meshio.read("mesh.ply").points).all())

    def test_usd_stage(self):
        """What a stage states, and the boundary as a prim of its own."""
        for fixture in "fields.vdb", "far.vdb":
            sample = ALL if fixture == "fields.vdb" else OWN
            self.mesh("mesh.usda", *sample, "--up-axis", "z", "--meters-per-unit", "0.01", "--usd-surface",
                      fixture=fixture)
            with open("mesh.usda") as file:
                text = file.read()
            head = '#usda 1.0\n(\n    defaultPrim = "mesh"\n    metersPerUnit = 0.01\n    upAxis = "Z"\n)\n\n'
            self.assertTrue(text.startswith(head + 'def Xform "mesh"\n{\ndef TetMesh "tets"\n{\n'))
            tets, surface = text.split('def Mesh "surface"')
            self.assertTrue(surface.startswith(" (\n    references = </mesh/tets>\n)\n{\n"))
            self.assertTrue(surface.endswith("]\n}\n}\n"))
            self.assertIn('uniform token subdivisionScheme = "none"', surface)
            for name in re.findall(r'primvars:(\w+) = \[[^]]*\] \(\n        interpolation = "uniform"', tets):
                self.assertRegex(surface, rf"primvars:{name} = None\n")
            numbers = lambda text, name: usd_numbers(re.search(rf" {name} = \[(.*?)\]", text, re.DOTALL).group(1), 1)
            triangles = numbers(tets, "surfaceFaceVertexIndices")
            self.assertTrue((numbers(surface, "faceVertexIndices") == triangles).all())
            counts = numbers(surface, "faceVertexCounts")
            self.assertEqual(len(counts), len(triangles) // 3)
            self.assertTrue((counts == 3).all())


if __name__ == "__main__":
    main()
