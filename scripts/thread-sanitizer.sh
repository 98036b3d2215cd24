#!/usr/bin/env bash
# Small renders of every integrator and primitive under ThreadSanitizer: scripts/thread-sanitizer.sh ONETBB_SOURCE
# oneTBB has to be built with the sanitizer, which takes every handing over of work for a race otherwise: its source is
# Debian's (`apt-get source onetbb`, with deb-src in the list of sources).
set -euo pipefail
source=$(realpath "${1:?usage: scripts/thread-sanitizer.sh ONETBB_SOURCE}")
cd "$(dirname "${BASH_SOURCE[0]}")/.."

cmake -S "$source" -B build-threads/tbb -G Ninja -DCMAKE_BUILD_TYPE=RelWithDebInfo -DCMAKE_CXX_FLAGS="-fsanitize=thread -O1 -g1" \
  -DTBB_TEST=OFF -DTBB_STRICT=OFF -DTBB_DISABLE_HWLOC_AUTOMATIC_SEARCH=ON
cmake --build build-threads/tbb --target tbb
# Where it is built depends on its version. Without it the system's would be loaded, and all handing over be a race.
tbb=$(find "$PWD/build-threads/tbb" -name libtbb.so.12 -printf '%h\n' -quit)
test -n "$tbb"
cmake --preset threads
cmake --build --preset threads
LD_LIBRARY_PATH="$tbb" ctest --preset threads
