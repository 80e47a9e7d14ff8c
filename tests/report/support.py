"""What the tests of the report's page have in common: a page, and what it holds.

usage of such a test: test_X.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
Exit code 77 tells that the test could not be made.
"""
import base64
import itertools
import json
import os
import re
import struct
import subprocess
import sys

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from tool import VDB_TET, ToolTest, main

FACES = [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]


class Page:
    """The data in a page, read without a browser."""

    def __init__(self, path):
        with open(path, encoding="utf-8") as file:
            self.text = file.read()
        self.data = json.loads(self.element("data"))
        self.points = list(struct.iter_unpack("<3f", base64.b64decode(self.element("points"))))
        self.tets = list(struct.iter_unpack("<4I", base64.b64decode(self.element("tets"))))
        self.quality = base64.b64decode(self.element("quality"))

    def element(self, name):
        """The text of the script element of that id, which ends at the first end tag, as for a browser."""
        return re.search(f'<script type="[a-z/]+" id="{name}">(.*?)</script', self.text, re.DOTALL).group(1)

    def faces(self):
        """For each face, by its corners, the tets that have it."""
        faces = {}
        for number, tet in enumerate(self.tets):
            for face in itertools.combinations(sorted(tet), 3):
                faces.setdefault(face, []).append(number)
        return faces


class PageTest(ToolTest):
    def setUp(self):
        super().setUp()
        probe = subprocess.run([VDB_TET, "sphere.vdb", "--dry-run", "-q", "--report", "probe.html"],
                               capture_output=True, text=True, timeout=240)
        if "without three.js" in probe.stderr:
            print("SKIPPED: vdb_tet was built without three.js; see tools/install_deps.sh")
            sys.exit(77)
        os.remove("probe.html")

    def report(self, grid, *options, out="o.mesh"):
        """Mesh a fixture, and write report.html."""
        subprocess.run([VDB_TET, "-q", grid, *([out] if out else []), "--report", "report.html", *options],
                       check=True, timeout=240)
