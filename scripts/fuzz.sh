#!/usr/bin/env bash
# Fuzzes each format that is read for SECONDS (default 60), by other inputs every time, with sanitizers and Clang:
#   scripts/fuzz.sh [SECONDS [FORMAT]]        such as scripts/fuzz.sh 600 gltf
# What it finds is written to build-fuzz/fuzz/; what is worth keeping goes to tests/fuzz/corpus.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/packages.sh

install_missing "${renderer_packages[@]}" "${test_packages[@]}" "${sanitizer_packages[@]}"
configure fuzz -DTUNGSTEN_FUZZ_REPEAT=OFF "-DTUNGSTEN_FUZZ_SECONDS=${1:-60}"
cmake --build --preset fuzz
ctest --preset fuzz ${2:+-R "^fuzz[.]$2$"}
