#!/usr/bin/env bash
# One command from a clean clone to a picture: sets up the renderer without tests and benchmarks, then renders a
# time-gated view of a foggy Cornell box.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

scripts/setup.sh --target tungsten-app tungsten-photon tungsten-path
echo
echo "Rendering data/scenes/cornell-fog (one minute) ..."
build/bin/tungsten data/scenes/cornell-fog/scene.json "$@"
echo
echo "Look at data/scenes/cornell-fog/output/cornell-fog.png"
echo "(linear values and their standard error are in cornell-fog.exr beside it)"
