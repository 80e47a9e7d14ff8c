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


def children_of(process):
    """The ids of the processes that it has started, and that are there still."""
    try:
        with open(f"/proc/{process.pid}/task/{process.pid}/children") as file:
            return [int(pid) for pid in file.read().split()]
    except (FileNotFoundError, ProcessLookupError):
        return []


def wait_for_child(process):
    """The id of its first child."""
    while process.poll() is None:
        for pid in children_of(process):
            return pid
        time.sleep(0.001)
    raise AssertionError("it ended before it had a child")


def is_alive(pid):
    """Whether there is such a process that has not ended; nobody may have asked yet how one did."""
    try:
        with open(f"/proc/{pid}/stat") as file:
            return file.read().rpartition(")")[2].split()[0] not in "ZX"
    except (FileNotFoundError, ProcessLookupError):
        return False


def wait_until_writing(process):
    """Until a child has a file of this folder open that is not one it reads; it may have no name.

    Returns the child's id.
    """
    while process.poll() is None:
        for pid in children_of(process):
            try:
                paths = [os.readlink(f"/proc/{pid}/fd/{link}") for link in os.listdir(f"/proc/{pid}/fd")]
            except (FileNotFoundError, ProcessLookupError):
                continue  # closed meanwhile
            if any(path.startswith(os.getcwd() + "/") and not path.endswith((".vdb", ".jsonl")) for path in paths):
                return pid
        time.sleep(0.001)
    raise AssertionError("it ended before it wrote")


class ToolTest(unittest.TestCase):
    """Runs in a folder of its own that holds the fixtures of tests/cli."""

    def setUp(self):
        directory = tempfile.TemporaryDirectory()
        self.addCleanup(directory.cleanup)
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(directory.name)
        subprocess.run([MAKE_FIXTURES], check=True)


def main():
    """Run the test that is named, of whichever case of the script has it, and end as CTest wants it."""
    method = "test_" + sys.argv[3]
    case = next(test for test in vars(sys.modules["__main__"]).values()
                if isinstance(test, type) and issubclass(test, ToolTest) and hasattr(test, method))
    result = unittest.TextTestRunner(verbosity=2).run(case(method))
    for _, reason in result.skipped:
        print("SKIPPED:", reason)
    sys.exit(77 if result.skipped else not result.wasSuccessful())
