#!/bin/sh
# Builds the benchmarks and runs them; the results are tables in Markdown, on standard output. Installs nothing:
# tools/install_deps.sh --bench does. The full run takes some minutes, 12 GB of memory and 10 GB of disk.
#
# usage: tools/bench.sh [--quick] [GRID.vdb...]
#
# --quick       a smoke test: small fixtures, few repetitions
# GRID.vdb...   more level sets; default: those of resolution 256 in the shared folder, where there is one
set -eu

options=
if [ "${1-}" = --quick ]; then
    options='--sizes 128,256 --repetitions 2'
    shift
fi
for grid in "$@"; do # absolute, as the folder changes
    shift
    case $grid in
    -*) echo "usage: tools/bench.sh [--quick] [GRID.vdb...]" >&2 && exit 2 ;;
    /*) set -- "$@" "$grid" ;;
    *) set -- "$@" "$PWD/$grid" ;;
    esac
done
cd "$(dirname "$0")/.."
if [ $# -eq 0 ]; then
    for grid in "${VDBTET_SHARED:-../shared}"/data/levelset/*_256.vdb; do
        [ ! -e "$grid" ] || set -- "$@" "$grid"
    done
fi

for command in cmake ninja python3; do
    command -v "$command" >/dev/null || {
        echo "bench.sh: $command is missing; see tools/install_deps.sh --bench" >&2
        exit 1
    }
done
cmake --preset release -B build/bench -DVDBTET_BUILD_TESTS=OFF -DVDBTET_BUILD_BENCHMARKS=ON >&2
cmake --build build/bench --target vdbtet_bench vdb_tet >&2
# shellcheck disable=SC2086 # a list
exec python3 tests/bench/benchmark.py --bench build/bench/tests/bench/vdbtet_bench \
    --vdb-tet build/bench/tools/vdb_tet --folder build/bench $options "$@"
