"""Runs that are killed leave the old file or the new one, whole, and nothing else; damaged files end in a line."""
import os
import random
import subprocess
import sys
import time

sys.path.append(os.path.join(os.path.dirname(os.path.abspath(__file__)), "../support"))
from tool import VDB_TET, ToolTest, main


class Robustness(ToolTest):
    def test_killed_at_two_hundred_moments(self):
        os.mkdir("out")
        command = [VDB_TET, "-q", "sphere.vdb", "out/mesh.vtu", "--voxels"]

        def whole(voxels):
            subprocess.run(command + [voxels], check=True)
            with open("out/mesh.vtu", "rb") as file:
                return file.read()

        start = time.monotonic()
        new = whole("0.2")
        duration = time.monotonic() - start
        old = whole("0.5")
        rng = random.Random(1)
        replaced = 0
        for _ in range(200):
            process = subprocess.Popen(command + ["0.2"])
            time.sleep(rng.uniform(0, 1.2 * duration))
            process.kill()
            process.wait()
            with open("out/mesh.vtu", "rb") as file:
                now = file.read()
            self.assertIn(now, (old, new))
            replaced += now == new
            if now == new:
                self.assertEqual(whole("0.5"), old)
            self.assertEqual([name for name in os.listdir("out") if not name.startswith(".")], ["mesh.vtu"])
        self.assertEqual(whole("0.2"), new)
        self.assertEqual(os.listdir("out"), ["mesh.vtu"])
        self.assertGreater(replaced, 0)
        self.assertLess(replaced, 200)

    def test_damaged_copies_end_in_a_line(self):
        batter = os.path.join(os.path.dirname(os.path.abspath(__file__)), "batter.py")
        files = ["sphere.vdb", "level_set_and_fog.vdb", "two_of_a_name.vdb"]
        done = subprocess.run([sys.executable, "-B", batter, VDB_TET, *files, "--mutations", "150", "--seconds", "60"],
                              capture_output=True, text=True)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        self.assertRegex(done.stdout, "[0-9]+ refused")


if __name__ == "__main__":
    main()
