"""Limits, values and places that make no sense, and what the system refuses: one line each, and nothing left."""
import json
import os
import shutil
import struct
import subprocess
import sys

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support"))
from tool import MAKE_FIXTURES, VDB_TET, ToolTest, main, wait_until_writing

NOBODY = 65534


def run(*arguments, **options):
    return subprocess.run([VDB_TET, *arguments], capture_output=True, text=True, timeout=240, **options)


def run_in_shell(redirection, *arguments):
    return subprocess.run(["sh", "-c", f'"$@" {redirection}', "sh", VDB_TET, *arguments], capture_output=True, text=True,
                          timeout=240)


class Resources(ToolTest):
    def setUp(self):
        super().setUp()
        subprocess.run([MAKE_FIXTURES, "--hostile"], check=True)
        os.mkdir("out")

    def assert_one_line(self, result, code, pattern):
        self.assertEqual(result.returncode, code, result.stderr)
        self.assertEqual(result.stdout, "")
        self.assertRegex(result.stderr, r"\Avdb_tet: [^\n]+\n\Z")
        self.assertRegex(result.stderr, pattern)

    def assert_refused(self, pattern, *arguments, code=1):
        self.assert_one_line(run(*arguments), code, pattern)
        self.assertEqual(os.listdir("out"), [])

    def test_limits_on_tets_and_memory(self):
        ok = run("sphere.vdb", "--dry-run", "--report", "r.json")
        self.assertEqual((ok.returncode, ok.stderr), (0, ""))
        with open("r.json") as file:
            report = json.load(file)
        tets, memory = report["tets"], report["memoryEstimate"]
        run("sphere.vdb", "out/o.vtu", "-q", "--max-tets", str(tets), "--max-memory", str(memory)).check_returncode()
        os.remove("out/o.vtu")
        self.assert_refused(f"would have {tets} tets, more than the limit of {tets - 1}; ", "sphere.vdb", "out/o.vtu",
                            "--max-tets", str(tets - 1))
        self.assert_refused(r"about \S+ GB of memory, more than the limit of 0.01 GB; ", "sphere.vdb", "out/o.vtu",
                            "--max-memory", "10M")
        self.assertEqual(run("sphere.vdb", "--dry-run", "-q", "--max-memory", "8G").returncode, 0)
        for size in ("8X", "-1", "much", "99999999999G"):
            self.assert_refused("memory", "sphere.vdb", "out/o.vtu", "--max-memory", size, code=2)
        for size in ("0", "-1"):
            self.assert_refused("limit on tets", "sphere.vdb", "out/o.vtu", "--max-tets", size, code=2)

    def test_tile_bombs_are_refused_at_once(self):
        for options in ((), ("--grade",), ("--voxels", "3"), ("--tiger", "3", "--optimize")):
            self.assert_refused("lattice tiles|limit", "bomb_16384.vdb", "out/o.vtu", "-q", *options)
        self.assert_refused("of memory", "bomb_4096.vdb", "out/o.vtu", "-q", "--grade", "--max-memory", "1G")

    def test_values_without_a_sign(self):
        where = r"ball.*: 3 voxels or tiles .*\[9, 0, 0\], in world space \[0\.9, 0, 0\]; .*inside or outside"
        self.assert_refused(where, "nan.vdb", "out/o.vtu")
        self.assert_refused("background", "nan_background.vdb", "out/o.vtu")
        self.assert_refused("no end", "nan_background.vdb", "out/o.vtu", "--nan", "inside")
        self.assert_refused("--nan", "nan.vdb", "out/o.vtu", "--nan", "zero", code=2)
        self.assert_refused("background value -0.3 lies inside", "inside_background.vdb", "out/o.vtu")
        for choice in ("inside", "outside"):
            done = run("nan.vdb", "out/o.vtu", "--nan", choice, "--distance", "--report", "r.json")
            self.assertEqual((done.returncode, done.stderr), (0, ""))
            self.assertRegex(done.stdout, f"replaced +3 values that are NaN or infinite, taken as {choice}\n")
            with open("r.json") as file:
                self.assertEqual(json.load(file)["badValues"], 3)
        run("nan_background.vdb", "out/o.vtu", "-q", "--nan", "outside").check_returncode()

    def test_places_that_make_no_sense(self):
        with open("far_transform.vdb", "rb") as far, open("infinite_place.vdb", "wb") as infinite:
            infinite.write(far.read().replace(struct.pack("=d", 1e15), struct.pack("=d", float("inf"))))
        for name, pattern in (("nan_transform", "transform is singular or not finite"),
                              ("infinite_transform", "transform is singular or not finite"),
                              ("infinite_place", "translation is not finite"),
                              ("far_transform", "double precision cannot resolve its lattice"),
                              ("ends", "ends of the grid's 32-bit coordinates")):
            with self.subTest(name):
                self.assert_refused(pattern, name + ".vdb", "out/o.vtu")
                info = run("info", name + ".vdb")
                self.assertEqual((info.returncode, info.stderr), (0, ""))
                self.assertRegex(info.stdout, "no mesh: .*" + pattern)

    def test_metadata_that_lies(self):
        run("sphere.vdb", "honest.vtu", "-q").check_returncode()
        run("liar.vdb", "lied.vtu", "-q").check_returncode()
        with open("honest.vtu", "rb") as honest, open("lied.vtu", "rb") as lied:
            self.assertEqual(honest.read(), lied.read())
        info = run("info", "liar.vdb")
        self.assertEqual((info.returncode, info.stderr), (0, ""))

    def test_standard_output_that_is_closed_or_full(self):
        calls = (["--help"], ["--help-all"], ["--version"], ["--generate", "man"], ["--generate", "bash"], ["info", "--help"],
                 ["info", "sphere.vdb"], ["info", "--json", "sphere.vdb"], ["sphere.vdb", "--dry-run"],
                 ["sphere.vdb", "fog.vdb", "out/{stem}.vtu"], ["sphere.vdb", "out/o.vtu"])
        for redirection in (">&-", ">/dev/full"):
            for call in calls:
                with self.subTest(call=call, redirection=redirection):
                    self.assert_one_line(run_in_shell(redirection, *call), 1, "cannot write to standard output")
        # What was made is made, and whole.
        self.assertEqual(sorted(os.listdir("out")), ["fog.vtu", "o.vtu", "sphere.vtu"])
        for redirection in ("2>&-", "2>/dev/full", ">&- 2>&-", "<&- >&- 2>&-"):
            self.assertEqual(run_in_shell(redirection, "absent.vdb", "out/a.vtu").returncode, 1)
            self.assertEqual(run_in_shell(redirection, "sphere.vdb", "out/q.vtu", "-q").returncode, 0)

    def test_a_folder_that_vanishes(self):
        process = subprocess.Popen([VDB_TET, "sphere.vdb", "out/o.vtu", "-v", "0.1"], stdout=subprocess.PIPE,
                                   stderr=subprocess.PIPE, text=True)
        wait_until_writing(process)
        shutil.rmtree("out")
        out, err = process.communicate(timeout=240)
        self.assertEqual((process.returncode, out), (1, ""))
        self.assertRegex(err, r"\Avdb_tet: cannot write out/o.vtu: No such file or directory\n\Z")

    def test_a_folder_that_may_not_be_written(self):
        if os.geteuid() == 0:
            os.chmod(".", 0o755)
            drop = {"preexec_fn": lambda: os.setuid(NOBODY)}
        else:
            os.chmod("out", 0o555)
            drop = {}
        os.mkdir("free")
        os.chmod("free", 0o777)
        for arguments in (("out/o.vtu",), ("free/o.vtu", "--report", "out/r.json"),
                          ("free/o.vtu", "--surface", "out/s.ply")):
            self.assert_one_line(run("sphere.vdb", *arguments, **drop), 1, r"cannot write out/\S+: Permission denied")
        self.assertEqual(os.listdir("out") + os.listdir("free"), [])

    def test_a_disk_that_is_full(self):
        mount = subprocess.run(["mount", "-t", "tmpfs", "-o", "size=128k", "none", "out"], capture_output=True)
        if mount.returncode != 0:
            self.skipTest("no right to mount a small file system")
        self.addCleanup(subprocess.run, ["umount", "out"], check=True)
        with open("out/o.vtu", "w") as file:
            file.write("old")
        for options in (("out/o.vtu",), ("out/o.vtu", "--compress"), ("out/o.vtkhdf", "--compress"), ("out/o.msh",),
                        ("out/o.ele",), ("o.vtu", "--surface", "out/s.ply"), ("o.vtu", "--report", "out/r.html")):
            with self.subTest(options):
                self.assert_one_line(run("sphere.vdb", *options, "--voxels", "0.5"), 1,
                                     r"cannot write out/\S+: No space left on device")
                self.assertEqual(os.listdir("out"), ["o.vtu"])
                with open("out/o.vtu") as file:
                    self.assertEqual(file.read(), "old")


if __name__ == "__main__":
    main()
