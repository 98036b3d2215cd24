#!/bin/sh
# Writes docs/scene-fields.md from the declarations in the code; --check only compares, and fails where they differ.
set -e
cd "$(dirname "$0")/.."
tungsten=${TUNGSTEN:-build/bin/tungsten}
page=docs/scene-fields.md
unset TUNGSTEN_PLUGIN_PATH

if [ "$1" = --check ]; then
    "$tungsten" --describe --markdown | diff -u "${2:-$page}" - || {
        echo "$page is stale: run scripts/scene-fields.sh" >&2
        exit 1
    }
else
    mkdir -p docs
    "$tungsten" --describe --markdown > "$page.new"
    mv "$page.new" "$page"
fi
