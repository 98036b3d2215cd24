#!/usr/bin/env bash
# clang-tidy over src/ and tungsten/ as .clang-tidy says: about half an hour of CPU. scripts/tidy.sh [FILE...]
# Configures build-tidy and builds nothing: GCC's precompiled headers are none of clang's.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mkdir -p build-tidy
cmake -S . -B build-tidy -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_DISABLE_PRECOMPILE_HEADERS=ON -DTUNGSTEN_NATIVE=OFF \
  -DTUNGSTEN_TESTS=OFF -DTUNGSTEN_BENCHMARKS=OFF -DTUNGSTEN_PYTHON=OFF >build-tidy/configure.log
if [[ $# -gt 0 ]]; then
  files=("$@")
else
  mapfile -t files < <(git ls-files src tungsten | grep '[.]cpp$' | grep -v -e tungsten/python -e src/darts/python -e tungsten/mpi)
fi
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p build-tidy --quiet
