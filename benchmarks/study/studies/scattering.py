"""Methods from nearly clear to dense fog: six scattering coefficients."""

from darts_bench.program import Bench, Scene
from darts_bench.properties import study

TITLE = "From thin to dense fog"


def run(bench: Bench):
    side = bench.short(48, 16)
    values = bench.short([0.03, 0.1, 0.3, 1.0, 3.0, 6.0], [0.1, 1.0])
    scenes = {value: Scene.own("cornell-fog", side, f"media.fog.sigma_s={value}") for value in values}
    study(bench, TITLE, f"cornell-fog, {side} x {side} pixels, the fog of all space thicker and thicker; the box is 2 wide and "
          "light seen has come 5.6.", "scattering coefficient", scenes)
