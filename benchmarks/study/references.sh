#!/usr/bin/env bash
# Renders references of our own, unbiased best paths, into build/study/reference/: 5 minutes each, or so many as given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

minutes=${1:-5}
scenes=../shared/scenes
[ -d "$scenes" ] || { echo "references: the scenes are expected in $scenes" >&2; exit 1; }

# NAME RESOLUTION SCENE: as in studies/common/scenes.json.
reference() {
  build/bin/tungsten --quiet --timeout "${minutes}m" --spp 1000000000 --seed 1 --resolution "$2" \
    --set integrator.type=path_tracer --set integrator.darts=best --set media.gas.type=guided_homo \
    -d build/study/reference -o "$1.png" -e "$1.exr" "$3"
}
reference cbox-128 128x128 "$scenes/cbox/transient.json"
reference dragon-160 160x160 "$scenes/dragon/path_trace.json"
reference staircase-160 160x160 "$scenes/staircase/path_trace.json"
