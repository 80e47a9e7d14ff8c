#!/bin/sh
# Builds the fuzzers and runs each for some seconds, side by side, from corpora that grow in build/fuzz/corpus. Ends with
# what each did; what it found is in build/fuzz/findings, and "build/fuzz/tests/fuzz/fuzz_NAME FILE" runs it again.
#
# usage: tools/fuzz.sh SECONDS [NAME...]    NAME: vdb, mesh or options; all unless given
set -eu
cd "$(dirname "$0")/.."

[ $# -ge 1 ] || { echo "usage: tools/fuzz.sh SECONDS [vdb] [mesh] [options]" >&2; exit 2; }
seconds=$1
shift
[ $# -gt 0 ] || set -- vdb mesh options

tools/install_deps.sh --fuzz
cmake --preset fuzz -DVDBTET_WERROR=ON
cmake --build --preset fuzz
programs=$PWD/build/fuzz/tests/fuzz
cd build/fuzz
mkdir -p corpus findings logs empty
"$programs/fuzz_seeds" seeds

# The tool's children may take what they need (ForkedRun.cc); leaks are no finding in a process that ends at once.
export ASAN_OPTIONS=detect_leaks=0:max_allocation_size_mb=1024
running=
for name in "$@"; do
    mkdir -p "corpus/$name"
    (
        cd empty # for names of files on command lines
        exec "$programs/fuzz_$name" ../corpus/$name ../seeds/$name -max_total_time="$seconds" -max_len=65536 \
            -timeout=60 -rss_limit_mb=2048 -close_fd_mask=1 -print_final_stats=1 -artifact_prefix="../findings/$name-" \
            >"../logs/$name" 2>&1
    ) &
    running="$running $name:$!"
done
status=0
for one in $running; do
    wait "${one#*:}" || status=1
    echo "fuzz_${one%:*}:"
    grep -E '^(stat::number_of_executed_units|stat::peak_rss_mb|Done|[0-9]+ meshed|==.*ERROR|SUMMARY|not so|the mesh)' \
        "logs/${one%:*}" || true
done
exit $status
