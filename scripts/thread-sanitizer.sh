#!/usr/bin/env bash
# Small renders of every integrator and primitive under ThreadSanitizer: scripts/thread-sanitizer.sh ONETBB_SOURCE
# oneTBB has to be built with the sanitizer, which takes every handing over of work for a race otherwise: its source is
# Debian's (`apt-get source onetbb`, with deb-src in the list of sources).
set -euo pipefail
source=$(realpath "${1:?usage: scripts/thread-sanitizer.sh ONETBB_SOURCE}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake -S "$source" -B build-threads/tbb -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS="-fsanitize=thread -O1 -g1" \
  -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON -DCMAKE_LIBRARY_OUTPUT_DIRECTORY="$PWD/build-threads/tbb/lib"
cmake --build build-threads/tbb --target tbb
cmake --preset threads
cmake --build --preset threads
LD_LIBRARY_PATH="$PWD/build-threads/tbb/lib" ctest --preset threads
