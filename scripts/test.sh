#!/usr/bin/env bash
# Installs what the tests need, builds them into build/ and runs them. Other arguments go to ctest (such as -R scene).
#   --fast          only those that answer within a minute in all, for between two edits
# The environment's TUNGSTEN_WERROR=ON makes warnings errors.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
. scripts/packages.sh

target=all
if [ "${1:-}" = --fast ]; then
  shift
  target=fast_tests
  set -- -L fast "$@"
fi
options=(-DTUNGSTEN_TESTS=ON -DTUNGSTEN_PYTHON=ON)
if [ -n "${TUNGSTEN_WERROR:-}" ]; then options+=("-DTUNGSTEN_WERROR=$TUNGSTEN_WERROR"); fi

install_missing "${renderer_packages[@]}" "${test_packages[@]}"
configure default "${options[@]}"
cmake --build --preset default --target "$target"
ctest --preset default "$@"
