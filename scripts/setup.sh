#!/usr/bin/env bash
# Makes a fresh Debian 12 or 13 ready: installs missing packages, configures and builds into build/. Safe to run again.
# Arguments go to the build (such as --target tungsten-app).
#   TUNGSTEN_WERROR=ON    warnings are errors (continuous integration)
#   TUNGSTEN_MPI=ON       installs Open MPI too, so that mpirun can be used (without it: whether it is there)
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

packages=(
  g++ cmake ninja-build
  libembree-dev libopenexr-dev libimath-dev zlib1g-dev libminizip-dev libhdf5-dev rapidjson-dev libcli11-dev libxsimd-dev libtbb-dev libtinygltf-dev
  libstb-dev libboost-dev libboost-math-dev
  libgtest-dev libbenchmark-dev
  python3-dev pybind11-dev python3-numpy python3-matplotlib
)

if [ "${TUNGSTEN_MPI:-OFF}" = ON ]; then packages+=(libopenmpi-dev openmpi-bin); fi

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    echo "setup: not a Debian system; assuming these are installed by other means: ${packages[*]}" >&2
    return
  fi
  local missing=()
  for package in "${packages[@]}"; do is_installed "$package" || missing+=("$package"); done
  [ ${#missing[@]} -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
    echo "setup: neither root nor sudo; please have these installed: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  echo "setup: installing ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
}

install_missing
launcher=()
if command -v ccache >/dev/null; then
  launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
  export CCACHE_SLOPPINESS=pch_defines,time_macros # else it leaves files with precompiled headers alone
fi
cmake --preset default "-DTUNGSTEN_WERROR=${TUNGSTEN_WERROR:-OFF}" "${launcher[@]}"
cmake --build --preset default "$@"
