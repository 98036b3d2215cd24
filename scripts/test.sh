#!/usr/bin/env bash
# Sets up, then runs every test; arguments go to ctest (such as -R scene).
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh
ctest --preset default "$@"
