"""What the report's page holds, read back without a browser. Usage: see support.py."""
import json
import math
import os
import subprocess

from support import VDB_TET, Page, PageTest, main

MOST_TETS = 1000000


def read_medit(path):
    """Points and tets of a .mesh file."""
    with open(path) as file:
        words = file.read().split()
    def records(keyword, width, kind):
        at = words.index(keyword) + 2
        count = int(words[at - 1])
        flat = [kind(word) for word in words[at:at + count * (width + 1)]]
        return [tuple(flat[i:i + width]) for i in range(0, len(flat), width + 1)]
    return records("Vertices", 3, float), [tuple(i - 1 for i in tet) for tet in records("Tetrahedra", 4, int)]


def smallest_angle(corners):
    """Of the six dihedral angles, in degrees."""
    def minus(a, b):
        return [x - y for x, y in zip(a, b)]
    def cross(a, b):
        return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    def dot(a, b):
        return sum(x * y for x, y in zip(a, b))
    a, b, c, d = corners
    normals = [cross(minus(c, b), minus(d, b)), cross(minus(d, a), minus(c, a)), cross(minus(b, a), minus(d, a)),
               cross(minus(c, a), minus(b, a))]
    cosines = [-dot(n, m) / math.sqrt(dot(n, n) * dot(m, m))
               for i, n in enumerate(normals) for m in normals[:i]]
    return math.degrees(math.acos(max(cosines)))


class Data(PageTest):
    def test_page_holds_the_mesh(self):
        self.report("sphere.vdb")
        page, (points, tets) = Page("report.html"), read_medit("o.mesh")
        picture = page.data["picture"]
        self.assertEqual(picture["kind"], "whole")
        self.assertEqual((picture["points"], picture["tets"]), (len(points), len(tets)))
        self.assertEqual(page.tets, tets)
        self.assertEqual(len(page.points), len(points))
        for shown, point in zip(page.points, points):
            for axis in range(3): # both are float32, here from the middle and there from the origin
                self.assertAlmostEqual(shown[axis] + picture["center"][axis], point[axis], delta=2e-7)
        self.assertEqual(len(page.quality), len(tets))
        for tet in range(0, len(tets), 37):
            angle = smallest_angle([points[corner] for corner in tets[tet]])
            self.assertAlmostEqual(page.quality[tet] * 72 / 255, angle, delta=0.15)
        outer = sum(len(owners) == 1 for owners in page.faces().values())
        self.assertEqual(outer, page.data["run"]["boundaryTriangles"])
        self.assertEqual(outer, picture["triangles"])

    def test_page_holds_the_json(self):
        self.report("sphere.vdb", "--optimize", "--grade")
        subprocess.run([VDB_TET, "-q", "sphere.vdb", "o.mesh", "--optimize", "--grade", "--report", "r.json"],
                       check=True, timeout=240)
        page = Page("report.html")
        with open("r.json") as file:
            json_report = json.load(file)
        self.assertEqual(page.data["run"].keys(), json_report.keys())
        for key, value in json_report.items():
            if key not in ("stages", "seconds", "worklistSeconds"):
                self.assertEqual(page.data["run"][key], value, key)
        self.assertEqual([stage["name"] for stage in page.data["run"]["stages"]],
                         [stage["name"] for stage in json_report["stages"]])

    def test_angles_of_the_page(self):
        self.report("sphere.vdb")
        data = Page("report.html").data
        angles, bins = data["run"]["angles"], data["angleBins"]
        self.assertEqual(sum(count for _, _, count in bins), 6 * data["run"]["tets"])
        self.assertEqual(bins, sorted(bins, key=lambda one: one[0] + one[1]))
        self.assertLessEqual(bins[0][0], angles["min"])
        self.assertGreaterEqual(bins[-1][1], angles["max"])
        self.assertAlmostEqual(data["worst"]["small"][0]["min"], angles["min"], places=5)
        self.assertAlmostEqual(data["worst"]["large"][0]["max"], angles["max"], places=5)
        smallest = [tet["min"] for tet in data["worst"]["small"]]
        self.assertEqual(smallest, sorted(smallest))

    def test_large_mesh_with_its_surface(self):
        self.report("sphere.vdb", "--dry-run", "-v", "0.25", out=None)
        page = Page("report.html")
        run, picture = page.data["run"], page.data["picture"]
        self.assertGreater(run["tets"], MOST_TETS)
        self.assertEqual(picture["kind"], "same surface")
        self.assertEqual(len(page.tets), picture["tets"])
        self.assertLessEqual(len(page.tets), MOST_TETS)
        self.assertEqual(picture["triangles"], run["boundaryTriangles"])
        self.assertAlmostEqual(page.data["worst"]["small"][0]["min"], run["angles"]["min"], places=5)
        self.assertAlmostEqual(page.data["worst"]["large"][0]["max"], run["angles"]["max"], places=5)

    def test_very_large_mesh_is_shown_coarser(self):
        self.report("sphere.vdb", "--dry-run", "-v", "0.07", out=None)
        self.assertLess(os.path.getsize("report.html"), 30e6)
        page = Page("report.html")
        run, picture = page.data["run"], page.data["picture"]
        self.assertEqual(picture["kind"], "coarser")
        self.assertLessEqual(len(page.tets), MOST_TETS)
        self.assertGreater(len(page.tets), MOST_TETS / 20)
        doublings = math.log2(picture["spacing"] / run["spacing"])
        self.assertAlmostEqual(doublings, round(doublings))
        self.assertGreaterEqual(doublings, 1)
        self.assertLess(max(map(max, page.points)), 1.01)

    def test_places(self):
        self.report("lace.vdb", "--scale", "10")
        data = Page("report.html").data
        self.assertGreater(data["run"]["ambiguous"], 0)
        self.assertGreater(data["run"]["boundary"]["found"], 0)
        for kind, count in [("ambiguous", data["run"]["ambiguous"]), ("conflicts", data["run"]["conflicts"]),
                            ("pinched", data["run"]["boundary"]["found"])]:
            places = data["places"][kind]
            self.assertEqual(len(places), min(count, 1000))
            for place in places: # within the ball, in the unit of the file
                self.assertLess(math.hypot(*place), 10 * 1.3)
        self.assertGreater(max(math.hypot(*place) for place in data["places"]["ambiguous"]), 10 * 0.3)

    def test_scaled_page(self):
        self.report("sphere.vdb", "--scale", "100")
        page, (points, _) = Page("report.html"), read_medit("o.mesh")
        for shown, point in zip(page.points, points):
            for axis in range(3):
                self.assertAlmostEqual(shown[axis] + page.data["picture"]["center"][axis], point[axis], delta=2e-5)

    def test_input_of_the_page(self):
        self.report("hostile.vdb")
        page = Page("report.html")
        rows = dict(page.data["input"])
        self.assertTrue(page.data["run"]["gridName"].startswith("</script><script>"))
        self.assertEqual(rows["class"], "level set")
        self.assertEqual(rows["voxel size"], "0.1, 0.1, 0.1")
        self.assertEqual(rows["grid's: <b>key</b>"], "{{page.css}} <i>value</i>")
        self.assertEqual(rows["creator"], rows["grid's: creator"])
        self.assertEqual(rows["file's: made by"], "</script>")
        self.assertIn("spacing", dict(page.data["options"]))

    def test_page_is_whole_or_not_there(self):
        before = sorted(os.listdir())
        os.mkdir("report.html")
        failed = subprocess.run([VDB_TET, "sphere.vdb", "o.mesh", "--report", "report.html"], capture_output=True,
                                text=True, timeout=240)
        self.assertEqual((failed.returncode, failed.stderr), (1, "vdb_tet: cannot write report.html: Is a directory\n"))
        os.rmdir("report.html")
        self.report("sphere.vdb")
        self.assertEqual(sorted(os.listdir()), sorted(before + ["o.mesh", "report.html"]))
        same = subprocess.run([VDB_TET, "sphere.vdb", "--dry-run", "--report", "sphere.vdb"], capture_output=True,
                              text=True, timeout=240)
        self.assertEqual(same.returncode, 2)

    def test_licence_and_library_are_in_the_page(self):
        self.report("sphere.vdb")
        text = Page("report.html").text
        self.assertIn("Permission is hereby granted, free of charge", text)
        self.assertIn("THREE", text)
        self.assertNotRegex(text, r"\{\{[\w.-]+\}\}(?!\s*<i>)")
        self.assertNotRegex(text, r"<(script|link|img)[^>]+(src|href)=\"(?!data:)")


if __name__ == "__main__":
    main()
