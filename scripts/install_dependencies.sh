#!/bin/sh
# SPDX-License-Identifier: Apache-2.0
# Installs whatever Debian 12 packages are missing; does nothing where all are there. The one list of packages of the project.
set -eu

packages="
  git ca-certificates g++ cmake ninja-build ccache pkg-config
  libopenvdb-dev libnanovdb-dev libopenvdb-tools python3-openvdb libboost-dev libboost-iostreams-dev libblosc-dev
  libcgal-dev libgmp-dev libmpfr-dev libeigen3-dev
  libopenimageio-dev libopenexr-dev libpng-dev libfreetype-dev libtbb-dev libembree-dev libassimp-dev
  libplplot-dev plplot-driver-cairo python3-matplotlib
  libtomlplusplus-dev libcli11-dev libfmt-dev nlohmann-json3-dev libgtest-dev libnanoflann-dev
  fonts-dejavu-core
"

missing=""
for package in $packages; do
    status=$(dpkg-query -W -f='${db:Status-Status}' "$package" 2>/dev/null || true)
    [ "$status" = installed ] || missing="$missing $package"
done
[ -n "$missing" ] || exit 0

echo "installing:$missing"
as_root=""
if [ "$(id -u)" -ne 0 ]; then
    command -v sudo >/dev/null || { echo "error: packages are missing and there is no sudo; as root run: apt-get install$missing" >&2; exit 1; }
    as_root=sudo
fi
export DEBIAN_FRONTEND=noninteractive
$as_root apt-get update -qq
# shellcheck disable=SC2086  # the list is meant to split into words
$as_root apt-get install -y -qq --no-install-recommends $missing
