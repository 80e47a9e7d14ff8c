"""The program vdbtet_prove.

usage: test_vdbtet_prove.py VDBTET_PROVE
"""
import subprocess
import sys
import unittest

PROVE = sys.argv.pop(1)


def prove(*options):
    return subprocess.run([PROVE, *options], capture_output=True, text=True)


class ProveTest(unittest.TestCase):
    def test_proves_a_bound(self):
        result = prove("--only", "29,13")
        self.assertEqual(result.returncode, 0)
        self.assertIn("(13.39, 156.68)", result.stdout)
        self.assertIn("All of this is proved.", result.stdout)

    def test_refutes_a_wrong_bound(self):
        for bound in "21=8.6", "21=,164.1", "21=8.6,164.1":
            result = prove("--only", "21", "--bound", bound)
            self.assertEqual(result.returncode, 1)
            self.assertIn("counter-example, all of this box: [0.49", result.stdout)
            self.assertIn("Not all of this is proved.", result.stdout)

    def test_refuses_what_makes_no_sense(self):
        for options in ("--only", "20"), ("--bound", "21"), ("--bound", "21=x"), ("--bound", "20=1"), ("--bund", "1"):
            result = prove(*options)
            self.assertEqual(result.returncode, 2)
            self.assertEqual(result.stdout, "")
            self.assertNotEqual(result.stderr, "")


if __name__ == "__main__":
    unittest.main()
