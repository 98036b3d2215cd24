#!/usr/bin/env bash
# The fast tests under AddressSanitizer and UndefinedBehaviorSanitizer, every file compiled by itself and without precompiled headers,
# so that a missing include is found, too: about half an hour of CPU. Arguments go to ctest.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/packages.sh

install_missing "${renderer_packages[@]}" "${test_packages[@]}"
configure sanitize
cmake --build --preset sanitize --target fast_tests
ctest --preset sanitize "$@"
