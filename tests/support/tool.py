"""What all tests of vdb_tet in Python have in common.

usage of such a test: test_X.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
"""
import os
import subprocess
import sys
import tempfile
import time
import unittest

VDB_TET, MAKE_FIXTURES = map(os.path.abspath, sys.argv[1:3])


def wait_until_writing(process):
    """Until the process, which reads sphere.vdb, has another file of this folder open; it may have no name."""
    links = f"/proc/{process.pid}/fd"
    while process.poll() is None:
        for link in os.listdir(links):
            try:
                path = os.readlink(os.path.join(links, link))
            except FileNotFoundError:
                continue  # closed meanwhile
            if path.startswith(os.getcwd() + "/") and not path.endswith("sphere.vdb"):
                return
        time.sleep(0.001)


class ToolTest(unittest.TestCase):
    """Runs in a folder of its own that holds the fixtures of tests/cli."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(directory.name)
        subprocess.run([MAKE_FIXTURES], check=True)
