#!/usr/bin/env bash
# One command from a clean clone to a picture: sets up the renderer, then renders a time-gated view of a foggy Cornell box for up to a
# minute. A preview is there after some seconds, is opened where there is a desktop, and gets better until the render ends.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
picture=data/scenes/cornell-fog/output/cornell-fog.png
preview=${picture%.png}_checkpoint.png

scripts/setup.sh
rm -f "$preview"
# Images are saved every 5 seconds; what they show is all that has been rendered so far.
build/bin/tungsten --restart --checkpoint 5s data/scenes/cornell-fog/scene.json "$@" &
render=$!
trap 'kill -TERM $render 2>/dev/null; wait $render' INT TERM
until [ -e "$preview" ] || ! kill -0 $render 2>/dev/null; do sleep 0.2; done
if [ -e "$preview" ]; then
  echo
  echo "Look at $preview: it is there $SECONDS s after the start, and gets better until the render ends"
  if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ] && command -v xdg-open >/dev/null; then xdg-open "$preview" >/dev/null 2>&1 || true; fi
fi
wait $render
if [ -e "$preview" ] && [ -e "$picture" ]; then cp "$picture" "$preview"; fi # for whoever still looks at it
echo "The picture is $picture; linear values and their standard error are in ${picture%.png}.exr beside it."
