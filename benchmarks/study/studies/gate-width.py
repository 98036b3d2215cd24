"""Methods from nearly a single moment to nearly the steady state: six widths of the time gate."""

from darts_bench.program import Bench, Scene
from darts_bench.properties import study

TITLE = "From a moment to the steady state"


def run(bench: Bench):
    side = bench.short(48, 16)
    values = bench.short([0.003, 0.02, 0.1, 0.5, 2.5, 11.0], [0.02, 2.5])
    scenes = {value: Scene.own("cornell-fog", side, f"integrator.transient_time_width={value}") for value in values}
    study(bench, TITLE, f"cornell-fog, {side} x {side} pixels, gates of six widths about the time 5.6; the widest holds nearly all of the light.",
          "width of the gate", scenes)
