"""Scenes for sliced primitives: what they are made for, and what they could get wrong, each at a box and a delta gate, with
and without the camera's leg."""

from darts_bench.scene_words import SweepScene, at, body, camera, facing, frames, gate, lambert, lamp, medium, steady

SLICE_FAST = ("matched-box-warped-delta", "occluders-unwarped-box")
DELTA_WIDTH = 0.1       # of the references' gates about a delta gate, and of its temporal kernel


def _view(**fields):
    return camera((0.3, 0.2, 4.0), fov=22, **fields)


# No light of a single direction scatters here, nor any from a surface: slices but planes bring no beams.
UNBLURRED = dict(blurred=("beams", "planes"))


def _gates(name, shows, media, primitives, view, warped, unwarped, radius=0.06, bounces=12, **fields):
    """The scene at four gates: (start, end) with the camera's leg and without; delta gates lie in their middle."""
    for setting, (start, end) in (("warped", warped), ("unwarped", unwarped)):
        middle = (start + end) / 2
        for kind, ends, switches in (("box", (start, end), {}),
                                     ("delta", (middle - DELTA_WIDTH / 2, middle + DELTA_WIDTH / 2), {"delta_time_gate": True})):
            integrator = gate(*ends, bounces, **switches, camera_unwarped=setting == "unwarped")
            yield SweepScene(f"{name}-{setting}-{kind}", shows, media, primitives, view, integrator, radius, **fields)


FOG = medium("fog", 1.2, 0.1)
CUBE = at(0, 0, 0, (2.0, 1.8, 1.6), 20)


def _point(x, y, z, emission, outside="fog", **fields):
    return lamp("point", at(x, y, z), emission, outside, **fields)


def matched():
    """Bodies behind boundaries that refract nothing."""
    inner = [body("cube", CUBE, "fog"), _point(0.6, 0.5, -0.2, 5.0)]
    yield from _gates("matched-box", "a box of fog around a point light, seen from outside", [FOG], inner, _view(), (5.2, 5.8),
                      (1.2, 1.8), **UNBLURRED)
    outer = [body("cube", CUBE, "fog"), _point(1.2, 1.4, 1.6, 20.0, None)]
    yield from _gates("lit-from-outside", "the same, lit from outside through the boundary", [FOG], outer, _view(), (6.4, 7.2),
                      (2.6, 3.4))
    for name, g in (("forward", 0.7), ("backward", -0.4)):
        yield from _gates(name, f"the box of fog with g {g}", [medium("fog", 1.2, 0.1, g)], inner, _view(), (5.2, 5.8),
                          (1.2, 1.8), **UNBLURRED)
    coloured = [medium("fog", [0.6, 1.2, 2.0], [0.3, 0.1, 0.02], 0.2)]
    yield from _gates("coloured", "the box of coloured fog", coloured, inner, _view(), (5.2, 5.8), (1.2, 1.8),
                      **UNBLURRED)


def refraction():
    milk = medium("milk", [1.5, 2.0, 2.5], 0.1, 0.3, 0.75)
    glass = {"type": "dielectric", "ior": 1.33}
    tank = [body("cube", CUBE, "milk", bsdf=glass), lamp("sphere", at(0.4, 0.3, 0.0, 0.3), 20.0, "milk")]
    yield from _gates("refracting-box", "a lamp in a box of milk behind a refracting boundary, two speeds of light", [milk], tank,
                      _view(), (5.0, 5.8), (1.2, 2.0))
    lens = [body("sphere", at(0.1, 0.2, 0.0, 0.45), outside="fog", bsdf={"type": "dielectric", "ior": 1.5}),
            lamp("sphere", at(-1.4, 0.7, 0.2, 0.35), 30.0, "fog")]
    yield from _gates("caustic", "a caustic through a ball of glass in fog, from a lamp that camera paths can hit",
                      [medium("fog", 0.4, 0.05)], lens, _view(inside="fog"), (5.6, 6.4), (2.0, 2.8))


def occlusion():
    things = [body("cube", CUBE, "fog"), _point(0.6, 0.5, -0.2, 5.0),
              body("quad", facing((-0.2, 0.1, 0.1), (1.0, 0.4, 0.0), 0.8), "fog", "fog", lambert([0.6, 0.5, 0.4])),
              body("sphere", at(0.3, -0.3, 0.2, 0.3), outside="fog", bsdf=lambert(0.7))]
    yield from _gates("occluders", "a card and a ball in a box of fog", [FOG], things, _view(), (5.2, 5.8), (1.2, 1.8), 0.15)
    lights = [body("cube", CUBE, "fog"), _point(0.6, 0.5, -0.2, 3.0), _point(-0.5, -0.3, 0.1, 3.0, emission_time=0.5),
              _point(0.0, -0.6, 0.4, [6, 3, 1], emission_time=-0.4),
              lamp("quad", facing((-0.5, 0.6, 0.0), (0, 0, 0), 0.3), 12.0, "fog", emission_time=0.3)]
    yield from _gates("pulses", "four lamps that flash at different times", [FOG], lights, _view(), (5.4, 6.0), (1.4, 2.0))


def sensors():
    inner = [body("cube", CUBE, "fog"), _point(0.6, 0.5, -0.2, 5.0)]
    for setting, start in (("warped", 4.4), ("unwarped", 0.4)):
        sequence = frames(start, 0.15, 20, 12, camera_unwarped=setting == "unwarped")
        yield SweepScene(f"sequence-{setting}", "twenty frames", [FOG], inner, _view(), sequence, 0.06, **UNBLURRED)
    response = {"max_bounces": 12, "vaccum_speed_of_light": 1.0, 
                "temporal_response": {"type": "gaussian", "center": 5.6, "sigma": 0.2}}
    yield SweepScene("gaussian-response", "a sensor with a Gaussian response", [FOG], inner, _view(), response, 0.06, **UNBLURRED)
    yield SweepScene("steady", "everything that arrives", [FOG], inner, _view(), steady(12), 0.06)


def slice_scenes():
    """In the order of the report; names are unique."""
    return [entry for group in (matched, refraction, occlusion, sensors) for entry in group()]
