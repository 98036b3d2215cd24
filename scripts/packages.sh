# Sourced by the other scripts, in the project's folder: what Debian 12 or 13 needs, and how it is installed and configured.
# shellcheck shell=bash

# What the renderer is built from.
renderer_packages=(
  g++ cmake ninja-build
  libembree-dev libopenexr-dev libimath-dev zlib1g-dev libminizip-dev libhdf5-dev rapidjson-dev libcli11-dev libxsimd-dev libtbb-dev libtinygltf-dev
  libstb-dev libboost-dev libboost-math-dev
)
python_packages=(python3-dev pybind11-dev python3-numpy)
mpi_packages=(libopenmpi-dev openmpi-bin)
study_packages=(python3-numpy python3-matplotlib)
test_packages=(libgtest-dev "${python_packages[@]}" "${study_packages[@]}")
sanitizer_packages=(clang libclang-rt-dev)
benchmark_packages=(libgtest-dev libbenchmark-dev "${study_packages[@]}")

is_installed() { [ "$(dpkg-query -W -f '${db:Status-Status}' "$1" 2>/dev/null)" = installed ]; }

as_root() {
  if [ "$(id -u)" -eq 0 ]; then "$@"; else sudo "$@"; fi
}

# Installs those of the named packages that are missing.
install_missing() {
  if ! command -v dpkg-query >/dev/null; then
    echo "setup: not a Debian system; assuming these are installed by other means: $*" >&2
    return
  fi
  local package missing=()
  for package in "$@"; do is_installed "$package" || missing+=("$package"); done
  [ ${#missing[@]} -eq 0 ] && return
  if [ "$(id -u)" -ne 0 ] && ! command -v sudo >/dev/null; then
    echo "setup: neither root nor sudo; please have these installed: apt-get install ${missing[*]}" >&2
    exit 1
  fi
  echo "setup: installing ${missing[*]}"
  as_root env DEBIAN_FRONTEND=noninteractive apt-get update -qq
  # Files of a package are not forced to the disk one by one: a machine that loses power here is set up again.
  as_root env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends -o Dpkg::Options::=--force-unsafe-io "${missing[@]}"
}

# Configures the preset that is named first, with further options; by ccache where there is one.
configure() {
  local launcher=()
  if command -v ccache >/dev/null; then
    launcher=(-DCMAKE_CXX_COMPILER_LAUNCHER=ccache)
    export CCACHE_SLOPPINESS=pch_defines,time_macros # else it leaves files with precompiled headers alone
  fi
  cmake --preset "$@" "${launcher[@]}"
}
