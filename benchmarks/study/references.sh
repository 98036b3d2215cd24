#!/usr/bin/env bash
# Renders references of our own, unbiased best paths, into build/study/reference/: 5 minutes each, or so many as given.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/../.."

minutes=${1:-5}
scenes=../shared/scenes
# NAME RESOLUTION SCENE SETTINGS...: as in studies/common/scenes.json.
reference() {
  build/bin/tungsten --quiet --timeout "${minutes}m" --spp 1000000000 --seed 1 --resolution "$2" \
    --set integrator.type=path_tracer --set integrator.darts=best "${@:4}" \
    -d build/study/reference -o "$1.png" -e "$1.exr" "$3"
}

[ -d "$scenes" ] || { echo "references: the other scenes are expected in $scenes" >&2; exit 1; }
reference cbox-128 128x128 "$scenes/cbox/transient.json" --set media.gas.type=guided_homo
reference dragon-160 160x160 "$scenes/dragon/path_trace.json" --set media.gas.type=guided_homo
reference staircase-160 160x160 "$scenes/staircase/path_trace.json" --set media.gas.type=guided_homo
