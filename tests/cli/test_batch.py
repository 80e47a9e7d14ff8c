"""What vdb_tet promises of many inputs: sequences, batches, grids, resuming, the log.

usage: test_batch.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
"""
import json
import os
import shutil
import signal
import subprocess
import sys
import time

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from tool import MAKE_FIXTURES, VDB_TET, ToolTest, children_of, is_alive, main

BAD = "0007"  # the frame that is cut short
FRAMES = [f"{i:04}" for i in range(1, 25)]
GOOD = [frame for frame in FRAMES if frame != BAD]


def run(*arguments, code=0, **options):
    result = subprocess.run([VDB_TET, *arguments], capture_output=True, text=True, timeout=240, **options)
    assert result.returncode == code, (result.returncode, result.stdout, result.stderr)
    return result


def read(path):
    with open(path, "rb") as file:
        return file.read()


def log(path):
    """Its lines, each of which must be JSON; none if there is no such file yet."""
    if not os.path.exists(path):
        return []
    return [json.loads(line) for line in read(path).decode().splitlines()]


def events(path, name):
    return [line["frame"] for line in log(path) if line["event"] == name]


class Batch(ToolTest):
    def sequence(self):
        subprocess.run([MAKE_FIXTURES, "--sequence"], check=True)

    def usage_error(self, pattern, *arguments):
        result = run(*arguments, code=2)
        self.assertRegex(result.stderr, r"\Avdb_tet: [^\n]+\n\Z")
        self.assertRegex(result.stderr, pattern)
        self.assertEqual(result.stdout, "")

    def test_killed_sequence_resumes_to_the_same_bytes(self):
        self.sequence()
        for folder in "ab":
            os.mkdir(folder)
        options = ["frame.####.vdb", "--frames", "1-24", "-v", "0.25"]
        whole = run(*options, "a/{frame}.vtu", "--log", "a.jsonl", code=1)
        self.assertEqual(whole.stderr, "vdb_tet: frame.0007.vdb ends before its grid does: it is truncated or "
                                       "damaged\n")
        self.assertEqual(sorted(os.listdir("a")), [frame + ".vtu" for frame in GOOD])
        self.assertEqual(sorted(events("a.jsonl", "start")), FRAMES)
        self.assertEqual(sorted(events("a.jsonl", "end")), GOOD)
        self.assertEqual(events("a.jsonl", "fail"), [BAD])

        process = subprocess.Popen([VDB_TET, *options, "b/{frame}.vtu", "--log", "b.jsonl", "--jobs", "2"],
                                   stderr=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        while len(events("b.jsonl", "end")) < 10 and process.poll() is None:
            time.sleep(0.001)
        children = children_of(process)
        process.kill()
        self.assertEqual(process.wait(timeout=60), -signal.SIGKILL)
        while any(map(is_alive, children)):
            time.sleep(0.001)
        finished = events("b.jsonl", "end")
        self.assertLess(len(finished), len(GOOD))
        left = sorted(os.listdir("b"))
        self.assertLessEqual({frame + ".vtu" for frame in finished}, set(left))
        for name in left:  # whole files, and nothing else
            self.assertEqual(read("a/" + name), read("b/" + name))

        resumed = run(*options, "b/{frame}.vtu", "--log", "b.jsonl", "--resume", code=1)
        self.assertEqual(resumed.stderr, whole.stderr)
        self.assertEqual(sorted(os.listdir("b")), sorted(os.listdir("a")))
        for name in os.listdir("a"):
            self.assertEqual(read("a/" + name), read("b/" + name))
        self.assertEqual([frame + ".vtu" for frame in sorted(events("b.jsonl", "skip"))], left)

        shutil.copy("frame.0008.vdb", "frame.0007.vdb")
        text = run(*options, "b/{frame}.vtu", "--resume").stdout
        self.assertIn("1 written, 23 skipped, in", text)
        self.assertEqual(read("b/0007.vtu"), read("b/0008.vtu"))

    def test_batch_of_files(self):
        os.mkdir("out")
        shutil.copy("sphere.vdb", "other.vdb")
        result = run("sphere.vdb", "other.vdb", "absent.vdb", "out/{stem}.vtu", "--report", "out/{stem}.json",
                     "--surface", "out/{stem}.ply", code=1)
        self.assertEqual(sorted(os.listdir("out")), ["other.json", "other.ply", "other.vtu", "sphere.json",
                                                     "sphere.ply", "sphere.vtu"])
        self.assertEqual(result.stderr, "vdb_tet: cannot read absent.vdb: No such file or directory\n")
        run("sphere.vdb", "alone.vtu", "-q")
        self.assertEqual(read("alone.vtu"), read("out/sphere.vtu"))
        with open("out/other.json") as file:
            report = json.load(file)
        self.assertEqual((report["input"], report["output"]), ("other.vdb", "out/other.vtu"))
        head, *rows, last = result.stdout.splitlines()
        self.assertEqual(head.split(), ["input", "status", "tets", "angles", "time", "memory"])
        self.assertRegex(rows[0], rf"^sphere\.vdb +written +{report['tets']} +[\d.]+ to [\d.]+ +[\d.]+ s +[\d.]+ MB$")
        self.assertRegex(rows[2], r"^absent\.vdb +failed")
        self.assertRegex(last, r"^2 written, 1 failed, in [\d.]+ s$")

    def test_quiet_batch(self):
        result = run("sphere.vdb", "fog.vdb", "{stem}.vtu", "-q")
        self.assertEqual((result.stdout, result.stderr), ("", ""))

    def test_dry_batch(self):
        before = os.listdir()
        text = run("sphere.vdb", "fog.vdb", "--dry-run").stdout  # the last is no output
        self.assertIn("2 counted, in", text)
        self.assertEqual(os.listdir(), before)

    def test_all_grids(self):
        run("level_set_and_fog.vdb", "{grid}.vtu", "--all-grids")
        for name in ["density", "ball"]:
            run("level_set_and_fog.vdb", "one.vtu", "-n", name)
            self.assertEqual(read(name + ".vtu"), read("one.vtu"))
        text = run("two_of_a_name.vdb", "sphere.vdb", "{stem}_{grid}.vtu", "--all-grids", "--log", "l.jsonl").stdout
        self.assertIn("two_of_a_name.vdb ball[1]  written", text)
        self.assertTrue(os.path.exists("two_of_a_name_ball[0].vtu") and os.path.exists("sphere_ball.vtu"))
        self.assertEqual([line["grid"] for line in log("l.jsonl") if line["event"] == "start"],
                         ["ball[0]", "ball[1]", "ball"])
        result = run("vectors.vdb", "sphere.vdb", "{stem}_{grid}.vtu", "--all-grids", code=1)
        self.assertIn("no float or double grid, only: vel", result.stderr)
        self.usage_error("--name", "sphere.vdb", "{grid}.vtu", "--all-grids", "-n", "ball")
        self.usage_error(r"ball\[0\] and two_of_a_name.vdb ball\[1\] would both be written to o.vtu; put {grid}",
                         "two_of_a_name.vdb", "o.vtu", "--all-grids")

    def test_batch_usage_errors(self):
        self.sequence()
        before = sorted(os.listdir())
        for pattern, arguments in [
            ("would both be written to o.vtu; put {stem} or {frame} into OUT", ["sphere.vdb", "fog.vdb", "o.vtu"]),
            ("same file", ["frame.%04d.vdb", "frame.{frame}.vdb", "--format", "vtu", "--frames", "1-3"]),
            ("would both be written to r.json", ["sphere.vdb", "fog.vdb", "{stem}.vtu", "--report", "r.json"]),
            ("same file", ["sphere.vdb", "o.vtu", "--log", "o.vtu"]),
            ("'2-' is neither", ["frame.%04d.vdb", "{frame}.vtu", "--frames", "1,2-"]),
            ("no place for a frame's number", ["sphere.vdb", "{frame}.vtu", "--frames", "1-3"]),
            ("--frames, such as", ["frame.%04d.vdb", "{frame}.vtu"]),
            ("no number in its name", ["sphere.vdb", "{frame}.vtu"]),
            ("--all-grids or --name", ["sphere.vdb", "{grid}.vtu"]),
            ("there is no option --sapcing; did you mean --spacing?", ["sphere.vdb", "o.vtu", "--sapcing", "3"]),
            ("did you mean --resume?", ["--resmue"]),
            ("did you mean --frames?", ["--frame=1-4", "sphere.vdb", "o.vtu"]),
        ]:
            with self.subTest(arguments):
                self.usage_error(pattern.replace("?", r"\?"), *arguments)
        self.assertEqual(sorted(os.listdir()), before)

    def test_frames_that_are_missing_fail(self):
        self.sequence()
        result = run("frame.%04d.vdb", "{frame}.vtu", "--frames", "24-26", code=1)
        self.assertIn("1 written, 2 failed", result.stdout)
        self.assertIn("vdb_tet: cannot read frame.0026.vdb: No such file or directory\n", result.stderr)

    def test_fail_fast(self):
        self.sequence()
        text = run("frame.%04d.vdb", "{frame}.vtu", "--frames", "7-24", "--fail-fast", "--jobs", "1", code=1).stdout
        self.assertIn("1 failed, 17 not begun, in", text)

    def test_jobs_change_no_byte(self):
        self.sequence()
        for jobs in ["1", "3"]:
            os.mkdir(jobs)
            run("frame.%04d.vdb", jobs + "/{frame}.vtu", "--frames", "8-16", "--jobs", jobs, "-j", "2")
        for name in os.listdir("1"):
            self.assertEqual(read("1/" + name), read("3/" + name))

    def test_log(self):
        self.sequence()
        run("frame.%04d.vdb", "{frame}.vtu", "--frames", "6-7", "--log", "l.jsonl", "--jobs", "1", code=1)
        run("frame.%04d.vdb", "{frame}.vtu", "--frames", "6-7", "--log", "l.jsonl", "--resume", code=1)
        lines = log("l.jsonl")
        self.assertEqual([(line["event"], line["frame"]) for line in lines],
                         [("start", "0006"), ("end", "0006"), ("start", "0007"), ("fail", "0007"),
                          ("skip", "0006"), ("start", "0007"), ("fail", "0007")])
        end = lines[1]
        self.assertEqual((end["input"], end["output"], end["job"]), ("frame.0006.vdb", "0006.vtu", 1))
        self.assertEqual(end["bytes"], os.path.getsize("0006.vtu"))
        self.assertGreater(end["peakMemory"], 1 << 20)
        self.assertRegex(end["time"], r"^\d{4}-\d\d-\d\dT\d\d:\d\d:\d\d\.\d{3}Z$")
        self.assertIn("truncated", lines[3]["error"])
        self.assertEqual(lines[3]["code"], 1)
        for path, code in [("nowhere/l.jsonl", 1), ("/dev/full", 0)]:
            result = run("sphere.vdb", "o.vtu", "-q", "--log", path, code=code)
            self.assertRegex(result.stderr, rf"\Avdb_tet: cannot write {path}[^\n]+\n\Z")

    def test_resume_of_one(self):
        options = ["sphere.vdb", "o.vtu", "--report", "r.json", "--resume"]
        self.assertIn("tets", run(*options).stdout)
        self.assertEqual(run(*options).stdout, "sphere.vdb: skipped, as its outputs are newer\n")
        os.remove("r.json")
        self.assertIn("tets", run(*options).stdout)
        os.utime("sphere.vdb")
        self.assertIn("tets", run(*options).stdout)


if __name__ == "__main__":
    main()
