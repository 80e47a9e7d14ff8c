#!/bin/sh
# Installs what vdbtet is built from, on Debian 12, Ubuntu 24.04 and later. Packages that are there already are left
# alone, and when none is missing neither the network nor root is needed.
#
# usage: tools/install_deps.sh [--tests] [--bench] [--fuzz] [--coverage] [--ci]
set -eu

packages="g++ cmake ninja-build libopenvdb-dev libtbb-dev libblosc-dev zlib1g-dev libhdf5-dev libboost-iostreams-dev
    libboost-dev libcgal-dev libcli11-dev libfmt-dev nlohmann-json3-dev libjs-three"
for option in "$@"; do
    case $option in
    --tests) packages="$packages catch2 python3 libopenmpi-dev openmpi-bin" ;;
    --bench) packages="$packages libbenchmark-dev python3" ;;
    --fuzz) packages="$packages clang libclang-rt-dev llvm" ;;
    --coverage) packages="$packages gcovr" ;;
    --ci)
        packages="$packages clang-format-14 python3-vtk9 python3-h5py python3-meshio python3-gmsh tetgen
            dpkg-dev man-db zsh fish"
        # Ubuntu has Chromium as a snap only; there what needs a browser is skipped.
        grep -qx 'ID=ubuntu' /etc/os-release || packages="$packages chromium chromium-driver"
        ;;
    *) echo "usage: tools/install_deps.sh [--tests] [--bench] [--fuzz] [--coverage] [--ci]" >&2 && exit 2 ;;
    esac
done

missing=
for package in $packages; do
    dpkg-query --show --showformat='${db:Status-Status}\n' "$package" 2>/dev/null | grep -qx installed ||
        missing="$missing $package"
done
[ -n "$missing" ] || exit 0

sudo=
[ "$(id -u)" -eq 0 ] || sudo=sudo
$sudo apt-get update
# shellcheck disable=SC2086 # a list
$sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y --no-install-recommends $missing
