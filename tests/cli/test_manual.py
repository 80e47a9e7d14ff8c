"""What vdb_tet tells of its options and of files: help, man page, completion, info."""
import json
import os
import re
import shutil
import subprocess
import sys

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support"))
from tool import VDB_TET, ToolTest, main


def say(*arguments):
    """What vdb_tet prints."""
    return subprocess.run([VDB_TET, *arguments], capture_output=True, text=True, check=True).stdout


def all_options():
    """The long names of all options, from the longest help."""
    names = re.findall(r"^  (?:-\w,)?(--[a-z-]+)", say("--help-all"), re.MULTILINE)
    assert len(names) > 30, names
    return names


class Manual(ToolTest):
    def test_help_fits_on_a_screen(self):
        lines = say("--help").splitlines()
        self.assertLessEqual(len(lines), 40)
        self.assertLessEqual(max(map(len, lines)), 100)
        self.assertTrue(any(line.startswith("  vdb_tet ") for line in lines), "an example")

    def test_man_page_has_every_option(self):
        page = say("--generate", "man")
        for name in all_options():
            self.assertIn(name.replace("-", r"\-"), page)
        if not shutil.which("man"):
            self.skipTest("there is no man")
        done = subprocess.run(["man", "--warnings", "-l", "-"], input=page, capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("EXIT STATUS", done.stdout)

    def complete(self, *words):
        """What bash offers for the last of these words."""
        script = say("--generate", "bash") + (
            'COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _vdb_tet; printf "%s\\n" "${COMPREPLY[@]}"')
        done = subprocess.run(["bash", "-c", script, "bash", *words], capture_output=True, text=True, check=True)
        self.assertEqual(done.stderr, "")
        return set(done.stdout.split())

    def test_bash_completes_options_values_and_files(self):
        self.assertEqual(self.complete("vdb_tet", "--"), set(all_options()))
        self.assertEqual(self.complete("vdb_tet", "--spac"), {"--spacing"})
        self.assertEqual(self.complete("vdb_tet", "--boundary", ""), {"manifold", "fill", "surface", "raw"})
        self.assertEqual(self.complete("vdb_tet", "--boundary", "f"), {"fill"})
        self.assertEqual(self.complete("vdb_tet", "inf"), {"info"})
        self.assertIn("sphere.vdb", self.complete("vdb_tet", "sphere.v"))
        self.assertIn("sphere.vdb", self.complete("vdb_tet", "--fields-from", "sphere.v"))

    def test_zsh_and_fish_take_their_scripts(self):
        shells = [shell for shell in ("zsh", "fish") if shutil.which(shell)]
        for shell in shells:
            with open("script", "w") as file:
                file.write(say("--generate", shell))
            subprocess.run([shell, "-n", "script"], check=True)
        if not shells:
            self.skipTest("there is neither zsh nor fish")

    def test_info_counts_what_a_run_makes(self):
        told = json.loads(say("info", "--json", "sphere.vdb"))
        self.assertEqual([grid["name"] for grid in told["grids"]], ["ball"])
        self.assertEqual(told["grids"][0]["class"], "level set")
        for kind, options in (("uniform", ()), ("graded", ("--grade",))):
            say("sphere.vdb", "mesh.vtu", "--report", "mesh.json", *options)
            with open("mesh.json") as file:
                report = json.load(file)
            for key in ("tets", "points", "boundaryTriangles", "spacing"):
                self.assertEqual(told[kind][key], report[key])
            self.assertEqual(told[kind]["vtuBytes"], os.path.getsize("mesh.vtu"))
        text = say("info", "sphere.vdb")
        self.assertIn(str(told["uniform"]["tets"]), text)
        self.assertIn(str(told["grids"][0]["activeVoxels"]), text)

    def test_info_goes_on_after_a_bad_file(self):
        done = subprocess.run([VDB_TET, "info", "missing.vdb", "two_of_a_name.vdb"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("missing.vdb", done.stderr)
        self.assertEqual(done.stderr.count("\n"), 1)
        self.assertIn("ball[0]", done.stdout)
        self.assertIn("no mesh:", done.stdout)

    def test_surfaces_are_meshed_and_their_faults_told(self):
        corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
        sides = [(1, 2, 4, 3), (5, 7, 8, 6), (1, 5, 6, 2), (3, 4, 8, 7), (1, 3, 7, 5), (2, 6, 8, 4)]

        def write(name, count):
            with open(name, "w") as file:
                file.writelines("v %d %d %d\n" % corner for corner in corners)
                file.writelines("f %d %d %d %d\n" % side for side in sides[:count])

        write("box.obj", 6)
        write("open.obj", 5)
        done = subprocess.run([VDB_TET, "box.obj", "box.vtu", "--voxel-size", "0.05"], capture_output=True, text=True)
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertIn("12 triangles, closed; voxels of 0.05", done.stdout)
        self.assertGreater(os.path.getsize("box.vtu"), 1000)

        done = subprocess.run([VDB_TET, "open.obj", "open.vtu", "--voxel-size", "0.05"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 1)
        self.assertIn("open.obj: the surface encloses nothing, for it is open: 1 hole (4 open edges)", done.stderr)
        self.assertFalse(os.path.exists("open.vtu"))

        with open("box.obj", "a") as file:  # a second one, through the first
            file.writelines("v %g %g %g\n" % (x + 0.5, y / 2 + 0.2, z / 2 + 0.2) for x, y, z in corners)
            file.writelines("f %d %d %d %d\n" % tuple(corner + 8 for corner in side) for side in sides)
        done = subprocess.run([VDB_TET, "box.obj", "box.vtu", "--voxel-size", "0.05"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 0)
        self.assertRegex(done.stderr, "^vdb_tet: warning: box.obj: [0-9]+ triangles that pass through others; ")

        done = subprocess.run([VDB_TET, "sphere.vdb", "b.vtu", "--voxel-size", "1"], capture_output=True, text=True)
        self.assertEqual(done.returncode, 2)
        self.assertIn("--voxel-size is for surfaces", done.stderr)


if __name__ == "__main__":
    main()
