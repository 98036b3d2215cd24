#!/usr/bin/env bash
# Makes a fresh Debian 12 or 13 ready to render: installs what is missing, builds command and plugins into build/. Safe to run
# again, at any time: what it is asked for is added to what is there.
#   --python        Python's module darts_tungsten, too
#   --studies       numpy and matplotlib for benchmarks/study, too
#   --benchmarks    the programs of benchmarks/, too
#   --mpi           Open MPI and what mpirun needs, too
# The environment's TUNGSTEN_WERROR=ON makes warnings errors. Tests: scripts/test.sh.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/packages.sh

packages=("${renderer_packages[@]}")
options=()
targets=(renderer)
for option in "$@"; do
  case "$option" in
    --python) packages+=("${python_packages[@]}") options+=(-DTUNGSTEN_PYTHON=ON) targets+=(python) ;;
    --studies) packages+=("${study_packages[@]}") ;;
    --benchmarks) packages+=("${benchmark_packages[@]}") options+=(-DTUNGSTEN_BENCHMARKS=ON) targets+=(benchmarks) ;;
    --mpi) packages+=("${mpi_packages[@]}") options+=(-DTUNGSTEN_MPI=ON) targets+=(tungsten-mpi) ;;
    *) echo "setup: unknown option $option; known are --python, --studies, --benchmarks and --mpi" >&2 && exit 2 ;;
  esac
done
if [ -n "${TUNGSTEN_WERROR:-}" ]; then options+=("-DTUNGSTEN_WERROR=$TUNGSTEN_WERROR"); fi

install_missing "${packages[@]}"
configure default "${options[@]}"
cmake --build --preset default --target "${targets[@]}"
