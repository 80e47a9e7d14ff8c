#!/bin/sh
# Measures which lines of the library the unit tests run, slow ones left out. Prints a table of files, and the sum;
# details are in build/coverage/lines.
#
# usage: tools/coverage.sh
set -eu
cd "$(dirname "$0")/.."

tools/install_deps.sh --tests --coverage
cmake --preset coverage
cmake --build --preset coverage
find build/coverage -name '*.gcda' -delete
build/coverage/tests/vdbtet_tests '~[slow]'
mkdir -p build/coverage/lines
gcovr --root . --object-directory build/coverage --filter src/ --filter include/ --exclude-throw-branches \
    --txt build/coverage/lines/table.txt --html-details build/coverage/lines/index.html --print-summary
cat build/coverage/lines/table.txt
