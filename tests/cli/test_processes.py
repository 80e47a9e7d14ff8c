"""What vdb_tet promises of its child processes: progress, crashes, Ctrl-C.

usage: test_processes.py VDB_TET MAKE_FIXTURES TEST   (TEST without its leading "test_")
"""
import os
import pty
import resource
import signal
import subprocess
import sys
import time

sys.path.append(os.path.join(os.path.dirname(__file__), "..", "support"))
from tool import VDB_TET, ToolTest, children_of, is_alive, main, wait_for_child, wait_until_writing

LONG = ["sphere.vdb", "o.vtu", "-v", "0.05"]  # takes far longer than a signal needs to arrive


def no_core():
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))


def popen(*arguments, **options):
    streams = {"stdout": subprocess.PIPE, "stderr": subprocess.PIPE, "text": True, "preexec_fn": no_core}
    return subprocess.Popen([VDB_TET, *arguments], **{**streams, **options})


class Terminal:
    """Standard error of a process is a terminal; its output so far is text."""

    def __init__(self, *arguments):
        self.fd, terminal = pty.openpty()
        self.process = popen(*arguments, stderr=terminal, env={**os.environ, "TERM": "xterm"}, start_new_session=True)
        os.close(terminal)
        self.text = ""

    def read(self, until=None):
        """Until that is on the terminal, or until the end."""
        while until is None or until not in self.text:
            try:
                more = os.read(self.fd, 4096)
            except OSError:  # all have closed it
                break
            self.text += more.decode()
        if until is None:
            os.close(self.fd)


class Processes(ToolTest):
    def setUp(self):
        super().setUp()
        self.inputs = sorted(os.listdir())

    def assert_nothing_left(self, *children):
        self.assertEqual(sorted(os.listdir()), self.inputs)
        for child in children:
            self.assertFalse(is_alive(child))

    def test_crash_is_one_line(self):
        process = popen(*LONG)
        child = wait_until_writing(process)
        os.kill(child, signal.SIGABRT)
        out, err = process.communicate(timeout=120)
        self.assertEqual((process.returncode, out), (1, ""))
        self.assertRegex(err, r"\Avdb_tet: sphere\.vdb: [^\n]+ crashed \(signal 6\); [^\n]+\n\Z")
        self.assert_nothing_left(child)

    def test_killed_child_is_one_line(self):
        process = popen(*LONG)
        child = wait_until_writing(process)
        os.kill(child, signal.SIGKILL)
        out, err = process.communicate(timeout=120)
        self.assertEqual((process.returncode, out), (1, ""))
        self.assertRegex(err, r"\Avdb_tet: sphere\.vdb: killed \(signal 9\) in the stage [^\n]+ memory [^\n]+\n\Z")
        self.assert_nothing_left(child)

    def test_crash_spares_the_other_frames(self):
        process = popen("sphere.vdb", "fog.vdb", "{stem}.vtu", "-v", "0.1", "--jobs", "1")
        os.kill(wait_for_child(process), signal.SIGABRT)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 1)
        self.assertRegex(err, r"\Avdb_tet: sphere\.vdb: [^\n]+ crashed \(signal 6\); [^\n]+\n\Z")
        self.assertRegex(out, r"sphere.vdb +failed[^\n]*\nfog.vdb +written")
        self.assertTrue(os.path.exists("fog.vtu"))

    def test_damaged_files_end_in_a_line(self):
        shared = os.environ.get("VDBTET_SHARED",
                                os.path.join(os.path.dirname(__file__), "..", "..", "..", "shared"))
        folder = os.path.join(shared, "data", "corrupt")
        if not os.path.isdir(folder):
            self.skipTest("no shared folder with damaged files")
        inputs = sorted(os.path.join(folder, name) for name in os.listdir(folder) if name.endswith(".vdb"))
        self.assertGreater(len(inputs), 10)
        process = popen(*inputs, "--dry-run")
        out, err = process.communicate(timeout=280)
        self.assertEqual(process.returncode, 1)
        statuses = [line[len(name):].split()[0] for line, name in zip(out.splitlines()[1:-1], inputs)]
        self.assertEqual(len(out.splitlines()), 1 + len(inputs) + 1)
        self.assertEqual(set(statuses), {"counted", "failed"})
        told = [line for line in err.splitlines() if line.startswith("vdb_tet: ") and " running, " not in line]
        self.assertEqual(len(told), statuses.count("failed"))

    def test_interrupt_in_any_stage(self):
        for stage, options in [("emit", ["-v", "0.05"]),
                               ("optimize", ["-v", "0.05", "--optimize", "38", "--sweeps", "1000"]),
                               ("measure", ["-v", "0.04", "--dry-run"])]:
            with self.subTest(stage):
                terminal = Terminal("sphere.vdb", "o.vtu", "-j", "1", *options)
                child = wait_for_child(terminal.process)
                terminal.read(until=stage)
                os.killpg(terminal.process.pid, signal.SIGINT)
                terminal.read()
                out, _ = terminal.process.communicate(timeout=120)
                self.assertEqual((terminal.process.returncode, out), (130, ""))
                self.assertTrue(terminal.text.endswith("\r\x1b[Kvdb_tet: interrupted; nothing was written\r\n"))
                self.assert_nothing_left(child)

    def test_interrupt_of_a_child_that_does_not_listen(self):
        for interrupts in [1, 2]:
            process = popen(*LONG)
            child = wait_for_child(process)
            os.kill(child, signal.SIGSTOP)  # as one that reads from a server that is gone
            for _ in range(interrupts):
                process.send_signal(signal.SIGINT)
                time.sleep(0.01)
            out, err = process.communicate(timeout=120)
            self.assertEqual((process.returncode, out, err),
                             (130, "", "vdb_tet: interrupted; nothing was written\n"))
            self.assert_nothing_left(child)

    def test_interrupted_batch(self):
        process = popen("sphere.vdb", "fog.vdb", "far.vdb", "{stem}.vtu", "-v", "0.05", "--jobs", "2", "--log", "l.jsonl")
        while len(children_of(process)) < 2:
            time.sleep(0.001)
        process.send_signal(signal.SIGTERM)
        out, err = process.communicate(timeout=120)
        self.assertEqual(process.returncode, 143)
        self.assertEqual(err, "vdb_tet: interrupted; 0 of 3 are done, and --resume does the others\n")
        self.assertRegex(out, r"sphere.vdb +interrupted[^\n]*\nfog.vdb +interrupted[^\n]*\nfar.vdb +not begun\n")
        os.remove("l.jsonl")
        self.assert_nothing_left()

    def test_live_line(self):
        terminal = Terminal("sphere.vdb", "o.vtu", "-v", "0.1")
        child = wait_for_child(terminal.process)
        os.kill(child, signal.SIGSTOP)  # long enough for a line, on any machine
        terminal.read(until=" %")
        os.kill(child, signal.SIGCONT)
        terminal.read()
        out, _ = terminal.process.communicate(timeout=120)
        self.assertEqual(terminal.process.returncode, 0)
        self.assertIn("\ntails ", out)
        self.assertRegex(terminal.text, r"\A(\r\x1b\[Kvdb_tet: (\w+, )?\d+ %[^\r\n]*)+\r\x1b\[K\Z")

    def test_quiet_terminal(self):
        terminal = Terminal("sphere.vdb", "o.vtu", "-v", "0.06", "-q")
        terminal.read()
        out, _ = terminal.process.communicate(timeout=120)
        self.assertEqual((terminal.process.returncode, out, terminal.text), (0, "", ""))

    def test_lines_elsewhere(self):
        process = popen("sphere.vdb", "o.vtu", "-v", "0.1")
        child = wait_for_child(process)
        os.kill(child, signal.SIGSTOP)
        line = process.stderr.readline()
        os.kill(child, signal.SIGCONT)
        self.assertRegex(line, r"\Avdb_tet: (\w+, )?\d+ %[^\r\n]*\n\Z")
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0)

    def test_closed_streams(self):
        for fd in range(3):
            with self.subTest(fd):
                process = popen("sphere.vdb", "o.vtu", "-v", "2", preexec_fn=lambda: os.close(fd))
                out, err = process.communicate(timeout=120)
                expected = {0: (0, ""), 1: (1, "vdb_tet: cannot write to standard output\n"), 2: (0, "")}[fd]
                self.assertEqual((process.returncode, err), expected)
                with open("o.vtu", "rb") as file:
                    self.assertTrue(file.read().startswith(b"<?xml"))

    def test_reader_gone(self):
        read, write = os.pipe()
        os.close(read)
        process = popen("sphere.vdb", "o.vtu", "-v", "2", stdout=write)
        os.close(write)
        _, err = process.communicate(timeout=120)
        self.assertEqual(err, "")
        self.assertIn(process.returncode, (-signal.SIGPIPE, 1))
        self.assertTrue(os.path.exists("o.vtu"))


if __name__ == "__main__":
    main()
