#!/bin/sh
# Makes the pictures in docs/ anew, of the sample and of a sequence. Needs Chromium (tools/install_deps.sh --ci), tmux,
# and a build with the tests.
#
# usage: tools/make_pictures.sh
set -eu
cd "$(dirname "$0")/.."

folder=$(mktemp -d)
trap 'rm -r "$folder"' EXIT
build/release/tools/vdbtet_sample "$folder/sample.vdb"
(cd "$folder" && "$OLDPWD/build/release/tools/vdb_tet" -q sample.vdb sample.vtu --voxels 2.5 --report sample.html)
python3 -B tests/support/browser.py "$folder/sample.html" 1260 680 docs/report.png '
    document.getElementsByName("axis")[1].click();
    view.lookAt(new THREE.Vector3(0, -0.3, 0), view.camera.position.length(), new THREE.Vector3(0.3, 0.8, 1));'
tools/make_terminal_picture.sh
