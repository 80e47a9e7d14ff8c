#!/bin/sh
# From a fresh clone to a mesh: installs what is needed, builds the tools, and meshes the sample into sample.vtu, with
# a picture in sample.html.
#
# usage: tools/quickstart.sh
set -eu
cd "$(dirname "$0")/.."

tools/install_deps.sh
cmake --preset release -DVDBTET_BUILD_TESTS=OFF
cmake --build --preset release
build/release/tools/vdbtet_sample sample.vdb
build/release/tools/vdb_tet sample.vdb sample.vtu --report sample.html
