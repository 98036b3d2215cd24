#!/usr/bin/env bash
# Formats every C++ file of the tree with clang-format 14, or with --check only says which files differ (exit code 1).
# Other versions format differently: without version 14 (Debian 12: apt-get install clang-format) nothing is done.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

formatter=
for candidate in clang-format-14 clang-format; do
  if "$candidate" --version 2>/dev/null | grep -q ' version 14\.'; then formatter=$candidate && break; fi
done
if [ -z "$formatter" ]; then
  echo "format: SKIPPED, clang-format 14 is not installed" >&2
  exit 0
fi

mode=(-i)
if [ "${1:-}" = --check ]; then mode=(--dry-run -Werror); fi
git ls-files -z '*.h' '*.cpp' | xargs -0 "$formatter" "${mode[@]}"
