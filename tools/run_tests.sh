#!/bin/sh
# From a fresh clone to passed tests: installs what is needed, builds, runs the tests. With --ci also checks the
# format, treats warnings as errors, and first runs all but the slow tests under the sanitizers, those of faults and
# threads under the thread sanitizer, and the fuzzers for a minute.
#
# usage: tools/run_tests.sh [--ci]
set -eu
cd "$(dirname "$0")/.."

build_and_test() {
    preset=$1
    shift
    cmake --preset "$preset" -DVDBTET_BUILD_TESTS=ON "$@"
    cmake --build --preset "$preset"
    ctest --preset "$preset" -j "$(nproc)"
}

case ${1-} in
'')
    tools/install_deps.sh --tests
    build_and_test release
    ;;
--ci)
    tools/install_deps.sh --tests --ci --bench --fuzz
    git ls-files '*.h' '*.cc' | xargs clang-format-14 --dry-run --Werror
    build_and_test asan -DVDBTET_WERROR=ON
    build_and_test tsan -DVDBTET_WERROR=ON
    tools/fuzz.sh 60
    build_and_test release -DVDBTET_WERROR=ON -DVDBTET_BUILD_BENCHMARKS=ON
    ;;
*)
    echo "usage: tools/run_tests.sh [--ci]" >&2
    exit 2
    ;;
esac
