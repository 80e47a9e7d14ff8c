#!/usr/bin/env python3
"""Batters vdb_tet with damaged files, and counts what comes of it.

usage: batter.py VDB_TET FOLDER_OR_FILE... [--mutations N] [--seed S] [--limit-gib G] [--seconds T]
                 [--arguments A] [--check COMMAND] [--extension E] [--keep FOLDER]

Every .vdb is meshed as it is; with --mutations, so many damaged copies of the valid ones are, too. A run is bad that
ends by a signal, takes too long or too much memory, leaves a file behind that it says it has not written, says nothing
or more than a line of why, or writes a mesh that COMMAND MESH, such as build/release/tests/robustness/vdbtet_check_mesh
with the extension meshb, does not end with 0 for. The exit code is 1 if any run is bad. Ctrl-C shows the counts so far.

A damaged file may hold a large tile, whose mesh takes its time; so mutations want a limit among the arguments, such as
"--voxels 2 --max-tiles 1000".
"""
import argparse
import collections
import os
import random
import shlex
import signal
import subprocess
import sys
import tempfile


def mutated(whole, rng):
    """A copy of some bytes, damaged in one of the ways that files come to be."""
    data = bytearray(whole)
    kind = rng.choice(("cut", "bits", "bits", "head", "head", "number", "block", "swap"))
    if kind == "cut":
        del data[rng.randrange(len(data)):]
    elif kind == "bits":
        for _ in range(rng.choice((1, 1, 2, 8, 64))):
            data[rng.randrange(len(data))] ^= 1 << rng.randrange(8)
    elif kind == "head":  # where the names, types, offsets and topology are
        for _ in range(rng.choice((1, 2, 4))):
            data[rng.randrange(min(len(data), 1500))] = rng.choice((0, 1, 0x7F, 0x80, 0xFF, rng.randrange(256)))
    elif kind == "number":
        at = rng.randrange(len(data))
        data[at:at + 4] = rng.choice((0, 1, 0x7FFFFFFF, 0xFFFFFFFF, 0x80000000, rng.getrandbits(32))).to_bytes(4, "little")
    elif kind == "block":
        at, size = rng.randrange(len(data)), rng.choice((16, 256, 4096))
        data[at:at + size] = rng.choice((bytes(size), b"\xff" * size, rng.randbytes(size)))
    else:
        a, b, size = rng.randrange(len(data)), rng.randrange(len(data)), rng.choice((8, 64, 1024))
        data[a:a + size], data[b:b + size] = data[b:b + size], data[a:a + size]
    return bytes(data)


def check(command, mesh):
    """@return what a command says against a mesh, or nothing"""
    done = subprocess.run(shlex.split(command) + [mesh], capture_output=True, text=True, errors="replace")
    return "" if done.returncode == 0 else done.stdout + done.stderr or f"exit {done.returncode}"


Done = collections.namedtuple("Done", "returncode stdout stderr gib")


def run_limited(command, seconds):
    """@return how a command ended, and the memory of the largest of its processes; None where it takes too long"""
    def expire(*_):
        raise TimeoutError

    with tempfile.TemporaryFile() as out, tempfile.TemporaryFile() as err:
        process = subprocess.Popen(command, stdout=out, stderr=err)
        signal.signal(signal.SIGALRM, expire)
        try:
            signal.setitimer(signal.ITIMER_REAL, seconds)
            _, status, usage = os.wait4(process.pid, 0)
        except TimeoutError:
            process.kill()
            process.wait()
            return None
        finally:
            signal.setitimer(signal.ITIMER_REAL, 0)
        process.returncode = os.waitstatus_to_exitcode(status)
        texts = []
        for stream in (out, err):
            stream.seek(0)
            texts.append(stream.read().decode(errors="replace"))
        return Done(process.returncode, *texts, usage.ru_maxrss / (1 << 20))


def run(vdb_tet, path, folder, options):
    """@return the outcome of meshing one file: a word, what was said, and the GiB it took"""
    name = "out." + options.extension
    out = os.path.join(folder, name)
    done = run_limited([vdb_tet, path, out, "-q", *shlex.split(options.arguments)], options.seconds)
    left = sorted(os.listdir(folder))
    judged = ""
    if os.path.exists(out):
        if done and done.returncode == 0 and options.check:
            judged = check(options.check, out)
        os.remove(out)
    if not done:
        return "HANG", f"more than {options.seconds} s", 0
    outcome, said = judge(done, left, name, judged, options.limit_gib)
    return outcome, said, done.gib


def judge(done, left, name, judged, limit):
    """@return a word for how a run ended, in capitals where it is bad, and what was said"""
    said = done.stderr.strip()
    if done.gib > limit:
        return "HEAVY", f"{done.gib:.2f} GiB"
    if done.returncode < 0:
        return "CRASH", signal.Signals(-done.returncode).name
    if done.returncode == 0:
        if left != [name] or said:
            return "ODD SUCCESS", f"{left} {said}"
        return ("WRONG MESH", judged) if judged else ("accepted", said)
    if left:
        return "LEFT FILES", str(left)
    if done.stdout or said.count("\n") or not said:
        return "NOT ONE LINE", done.stdout + said
    return ("ended by a signal" if "signal" in said else f"refused, exit {done.returncode}"), said


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("vdb_tet")
    parser.add_argument("paths", nargs="+")
    parser.add_argument("--mutations", type=int, default=0)
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--limit-gib", type=float, default=2)
    parser.add_argument("--seconds", type=float, default=20)
    parser.add_argument("--arguments", default="--voxels 2", help="of vdb_tet")
    parser.add_argument("--check", help="a command that judges the meshes")
    parser.add_argument("--extension", default="vtu", help="of the meshes")
    parser.add_argument("--keep", help="a folder to put copies of what came out bad into")
    options = parser.parse_args()

    files = []
    for path in options.paths:
        files += [os.path.join(path, name) for name in sorted(os.listdir(path))] if os.path.isdir(path) else [path]
    files = [path for path in files if path.endswith(".vdb")]
    counts, bad, heaviest = collections.Counter(), [], 0

    def batter(name, path, folder):
        nonlocal heaviest
        outcome, said, gib = run(options.vdb_tet, path, folder, options)
        heaviest = max(heaviest, gib)
        counts[outcome] += 1
        if outcome.isupper():
            bad.append(name)
            print(f"{outcome}: {name}: {said[:200]}", flush=True)
            if options.keep:
                with open(path, "rb") as source, open(os.path.join(options.keep, name.replace("/", "_")), "wb") as copy:
                    copy.write(source.read())

    with tempfile.TemporaryDirectory() as top:
        folder = os.path.join(top, "out")
        os.mkdir(folder)
        try:
            for path in files:
                batter(os.path.basename(path), path, folder)
            rng = random.Random(options.seed)
            sources = [open(path, "rb").read() for path in files] if options.mutations else []
            damaged = os.path.join(top, "damaged.vdb")
            for number in range(options.mutations):
                with open(damaged, "wb") as stream:
                    stream.write(mutated(sources[number % len(sources)], rng))
                batter(f"seed{options.seed}_{number}.vdb", damaged, folder)
        except KeyboardInterrupt:
            pass

    for outcome, count in sorted(counts.items()):
        print(f"{count:7} {outcome}")
    print(f"{heaviest:7.2f} GiB at most")
    return 1 if bad else 0


if __name__ == "__main__":
    sys.exit(main())
