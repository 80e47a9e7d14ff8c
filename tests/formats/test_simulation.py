"""Formats that simulators read, each read back by a program that is not ours and compared to the .vtu."""
import json
import re
import shutil
import subprocess
import sys
import zipfile

from support import FormatTest, main, need

# One that float32 is enough for, and one that it is not.
FIXTURES = ("sphere.vdb", "far.vdb")


class Simulation(FormatTest):
    def cases(self):
        for fixture in FIXTURES:
            yield fixture, self.reference(fixture=fixture)

    def assert_reads(self, points, tets, expected):
        """The same mesh to the bit, where text that stands for a float32 was read as float64."""
        self.assert_same(points.astype(expected[0].dtype), tets, expected)

    def assert_outward(self, triangles, points, tets):
        """Each triangle is a face of a tet whose fourth corner is behind it, and they are the whole boundary."""
        numpy = need("numpy")
        faces = tets[:, [[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]]].reshape(-1, 3)  # outward
        _, where, count = numpy.unique(numpy.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
        start = lambda rows: numpy.array([numpy.roll(row, -row.argmin()) for row in rows])
        order = lambda rows: rows[numpy.lexsort(rows.T[::-1])]
        expected = order(start(faces[where[count == 1]]))
        self.assertTrue(numpy.array_equal(order(start(triangles)), expected))

    def test_tetgen(self):
        numpy = need("numpy")
        meshio = need("meshio")
        for fixture, expected in self.cases():
            self.mesh("mesh.ele", fixture=fixture)
            mesh = meshio.read("mesh.node")
            self.assert_reads(mesh.points, mesh.cells_dict["tetra"], expected)
            face = numpy.loadtxt("mesh.face", skiprows=1, dtype=int)
            self.assertTrue((face[:, 0] == 1 + numpy.arange(len(face))).all())
            self.assertTrue((face[:, 4] == 1).all())
            self.assert_outward(face[:, 1:4] - 1, *expected)

    def test_tetgen_by_tetgen(self):
        numpy = need("numpy")
        if not shutil.which("tetgen"):
            print("SKIPPED: tetgen is missing; see tools/install_deps.sh --ci")
            sys.exit(77)
        rows = lambda path: numpy.loadtxt(path, skiprows=1)
        for fixture, (points, tets) in self.cases():
            self.mesh("mesh.node", fixture=fixture)
            subprocess.run(["tetgen", "-rQ", "mesh"], stdout=subprocess.DEVNULL, check=True, timeout=240)
            read_points = rows("mesh.1.node")[:, 1:4].astype(points.dtype)
            self.assertTrue(numpy.array_equal(read_points, points))
            # TetGen turns tets about, and swaps corners of those it finds inside out.
            read_tets = rows("mesh.1.ele")[:, 1:5].astype(int) - 1
            self.assertEqual(numpy.sort(read_tets).tolist(), numpy.sort(tets).tolist())
            orientation = lambda ids: numpy.linalg.det(points[ids][:, 1:] - points[ids][:, :1]) > 0
            self.assertTrue((orientation(read_tets) == orientation(tets)).all())
            sides = lambda path: {tuple(sorted(row)) for row in rows(path)[:, 1:4].astype(int).tolist()}
            self.assertEqual(sides("mesh.1.face"), sides("mesh.face"))

    def test_npz(self):
        numpy = need("numpy")
        for fixture, expected in self.cases():
            self.mesh("mesh.npz", fixture=fixture)
            with zipfile.ZipFile("mesh.npz") as archive:
                self.assertIsNone(archive.testzip())
                self.assertEqual(archive.namelist(), ["vertices.npy", "tet_indices.npy"])
            mesh = numpy.load("mesh.npz", allow_pickle=False)
            self.assertEqual(mesh["vertices"].dtype, expected[0].dtype)
            self.assertEqual(mesh["tet_indices"].dtype, numpy.int32)
            self.assert_same(mesh["vertices"], mesh["tet_indices"], expected)

    def test_inp(self):
        meshio = need("meshio")
        for fixture, expected in self.cases():
            self.mesh("mesh.inp", fixture=fixture)
            mesh = meshio.read("mesh.inp")
            self.assertEqual([block.type for block in mesh.cells], ["tetra"])
            self.assertEqual(list(mesh.cell_sets), ["TETS"])
            self.assert_reads(mesh.points, mesh.cells[0].data, expected)
            with open("mesh.inp") as file:
                lines = file.read().split("\n")
            # What Abaqus' manual has on the lengths of lines and numbers.
            self.assertLessEqual(max(map(len, lines)), 256)
            fields = [field.strip() for line in lines if line[:1] == " " for field in line.split(",")]
            self.assertLessEqual(max(map(len, fields)), 20)
            self.assertNotIn("", fields)

    def test_geo(self):
        numpy = need("numpy")
        for fixture, expected in self.cases():
            self.mesh("mesh.geo", fixture=fixture)
            with open("mesh.geo") as file:
                text = file.read()
            # Unreal's own parser knows no space before a comma that ends a value.
            self.assertNotRegex(text, r"\s,")
            pairs = lambda array: dict(zip(array[::2], array[1::2], strict=True))
            geo = pairs(json.loads(text, parse_constant=self.fail))
            self.assertEqual(list(geo), ["fileversion", "hasindex", "pointcount", "vertexcount", "primitivecount",
                                         "info", "topology", "attributes", "primitives"])
            points, tets = expected
            self.assertEqual(geo["hasindex"], False)
            self.assertEqual(geo["pointcount"], len(points))
            self.assertEqual(geo["vertexcount"], 4 * len(tets))
            self.assertEqual(geo["primitivecount"], len(tets))
            self.assertEqual(geo["primitives"], [[["type", "Tetrahedron_run"],
                                                  ["startvertex", 0, "nprimitives", len(tets)]]])
            bounds = numpy.array(geo["info"]["bounds"], points.dtype).reshape(3, 2)
            self.assertTrue((bounds == numpy.stack([points.min(0), points.max(0)], axis=1)).all())

            (attribute,) = pairs(geo["attributes"])["pointattributes"]
            definition, content = map(pairs, attribute)
            self.assertEqual(definition, {"scope": "public", "type": "numeric", "name": "P",
                                          "options": {"type": {"type": "string", "value": "point"}}})
            storage = "fpreal32" if points.dtype == numpy.float32 else "fpreal64"
            self.assertEqual((content["size"], content["storage"]), (3, storage))
            values = pairs(content["values"])
            self.assertEqual((values["size"], values["storage"]), (3, storage))
            indices = pairs(pairs(geo["topology"])["pointref"])["indices"]
            self.assertEqual({type(index) for index in indices}, {int})
            self.assert_reads(numpy.array(values["tuples"], float), numpy.array(indices).reshape(-1, 4), expected)

    def test_usda(self):
        numpy = need("numpy")
        for fixture, (points, tets) in self.cases():
            self.mesh("mesh.usda", fixture=fixture)
            with open("mesh.usda") as file:
                text = file.read()
            metadata, name, properties = re.fullmatch(
                r'#usda 1\.0\n\(\n(.*?)\n\)\n\ndef TetMesh "(\w+)"\n{\n(.*)\n}\n', text, re.DOTALL).groups()
            self.assertEqual(dict(line.strip().split(" = ") for line in metadata.split("\n")),
                             {"defaultPrim": f'"{name}"', "metersPerUnit": "1", "upAxis": '"Y"'})

            number = r" *-?\d+(?:\.\d+)?(?:e[+-]\d+)?"
            element = rf'(?:"[\w:]+"|{number}|\({number}(?:,{number})*\))'
            # Line ends are fine behind brackets and commas, nowhere else.
            array = rf"\[\s*{element}(?:,\s*{element})*\]"
            one = re.compile(rf" {{4}}((?:uniform )?\w+(?:\[\])?) ([\w:]+) = ({array}|{element})(?:\n|\Z)")
            found, at = {}, 0
            while at < len(properties):
                match = one.match(properties, at)
                self.assertIsNotNone(match, properties[at:at + 100])
                kind, key, value = match.groups()
                found[key] = kind, value
                at = match.end()
            types = {key: kind for key, (kind, _) in found.items()}
            far = points.dtype == numpy.float64
            placed = {"xformOp:translate": "double3", "xformOpOrder": "uniform token[]"} if far else {}
            self.assertEqual(types, {"extent": "float3[]", "orientation": "uniform token", "points": "point3f[]",
                                     "tetVertexIndices": "int4[]", "surfaceFaceVertexIndices": "int3[]", **placed})
            self.assertEqual(found["orientation"][1], '"rightHanded"')
            rows = lambda key, kind: numpy.array(
                [row.split(",") for row in re.findall(r"\(([^()]*)\)", found[key][1])]).astype(kind)

            local = rows("points", numpy.float32)
            self.assertTrue((rows("extent", numpy.float32) == [local.min(0), local.max(0)]).all())
            self.assert_outward(rows("surfaceFaceVertexIndices", int), points, tets)
            if not far:
                self.assert_same(local, rows("tetVertexIndices", int), (points, tets))
                continue
            self.assertEqual(found["xformOpOrder"][1], '["xformOp:translate"]')
            place = rows("xformOp:translate", float)
            # To the float32 rounding of a sphere of radius 1, and the float64 rounding of where it is.
            self.assert_same(local.astype(float) + place, rows("tetVertexIndices", int), (points, tets),
                             (2.0 ** -25 + 2.0 ** -31) / abs(points).max())


if __name__ == "__main__":
    main()
