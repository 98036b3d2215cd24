"""Scenes of light that awaits a balance of guided and plain ways (awaits_balance_test.py)."""

import copy

PATHS = {"type": "path_tracer"}
LIGHT = {"type": "light_tracer"}
FORWARD = {"type": "forward"}
GLOW = {"type": "null"}


def points(photons, radius, stored=300000, steady=False):
    """The integrator's fields of photon points of one radius; `stored` is above what a pass deposits, so that none is thrown away."""
    return {"type": "progressive_photon_map" if steady else "progressive_transient_photon_map", "photon_count": photons,
            "volume_photon_count": stored, "gather_radius": radius, "volume_gather_radius": radius, "fixed_volume_radius": True,
            "alpha": 1}


def pinhole(position, look_at, fov, resolution=(3, 3), **fields):
    return {"type": "pinhole", "resolution": list(resolution), "fov": fov, "reconstruction_filter": "box",
            "transform": {"position": position, "look_at": look_at, "up": [0, 1, 0]}, **fields}


def medium(sigma_s, sigma_a, g=0, **fields):
    return {"name": "medium", "type": "homogeneous", "sigma_s": sigma_s, "sigma_a": sigma_a, "speed_of_light": 1,
            "phase_function": {"type": "henyey_greenstein", "g": g} if g else {"type": "isotropic"}, **fields}


def gate(begin, end):
    return {"transient_time_center": 0.5 * (begin + end), "transient_time_width": end - begin}


def film(begin, width, frames):
    return {"start_time": begin, "transient_time_width": width, "frame_num": frames}


def with_integrator(scene, *fields):
    """A copy of the scene whose integrator has further fields."""
    scene = copy.deepcopy(scene)
    for more in fields:
        scene["integrator"].update(more)
    return scene


def lamp_in_hole(lamp):
    """A turned cube of fog with a spherical hole, in which a lamp of some extent (`lamp`: "sphere" or "cube") hangs."""
    extent = {"sphere": {"scale": 0.15}, "cube": {"scale": 0.3, "rotation": [20, 40, 10]}}[lamp]
    return {"media": [medium(3, 0.02)],
            "primitives": [
                {"type": "cube", "bsdf": FORWARD, "int_medium": "medium", "transform": {"scale": 1.8, "rotation": [0, 30, 0]}},
                {"type": "sphere", "bsdf": FORWARD, "ext_medium": "medium", "transform": {"position": [0.1, 0, 0], "scale": 0.6}},
                {"type": lamp, "emission": 60, "bsdf": GLOW, "transform": {"position": [0.1, 0.1, -0.1], **extent}}],
            "camera": pinhole([0, 0, 5], [0, 0, 0], 20),
            "integrator": {"max_bounces": 64, **gate(4.6, 6.8)}}


def forward_peak():
    """A ball of g 0.99, 60 mean free paths across, before a lamp, in a gate of the light that has hardly turned."""
    return {"media": [medium(50, 0, g=0.99)],
            "primitives": [{"type": "sphere", "bsdf": FORWARD, "int_medium": "medium", "transform": {"scale": 0.6}},
                           {"type": "sphere", "emission": 40, "bsdf": GLOW, "transform": {"position": [0.2, 0.5, -1.8], "scale": 0.4}}],
            "camera": pinhole([0, 0, 5], [0, 0, 0], 15),
            "integrator": {"max_bounces": 600, **gate(6.3, 6.8)}}


def lamp_in_endless_fog():
    """A point lamp of power 1 ten mean free paths before the camera, filmed for 20 times as long as light takes straight."""
    return {"media": [medium(1, 0.01)],
            "primitives": [{"type": "point", "power": 1, "ext_medium": "medium"}],
            "camera": pinhole([0, 0, 10], [0, 0, 0], 60, (2, 2), medium="medium"),
            "integrator": {"max_bounces": 20000, **film(0, 5, 40)}}


def milk(sigma_s):
    """A ball without absorption, lit by a spot from above and seen from beside, in steady state."""
    return {"media": [medium(sigma_s, 0)],
            "primitives": [{"type": "sphere", "bsdf": FORWARD, "int_medium": "medium"},
                           {"type": "spot", "power": 10, "cone_angle": 14,
                            "transform": {"position": [0, 3, 0], "look_at": [0, 0, 0], "up": [1, 0, 0]}}],
            "camera": pinhole([0, -1, 6], [0, 0, 0], 18),
            "integrator": {"max_bounces": 1000}}


def lit_by_mirror():
    """A turned cube of fog; a wall hides the lamp, whose light comes by a mirror on the other side."""
    return {"media": [medium(4, 0.02)],
            "primitives": [
                {"type": "cube", "bsdf": FORWARD, "int_medium": "medium", "transform": {"rotation": [0, -30, 0]}},
                {"type": "quad", "bsdf": {"type": "mirror", "albedo": 0.95},
                 "transform": [0, 1.96, 0.39, -1.8, -2, 0, 0, 0, 0, -0.39, 1.96, 0.4, 0, 0, 0, 1]},
                {"type": "cube", "bsdf": GLOW, "transform": {"position": [0.95, 0, 0], "scale": [0.05, 1.6, 1.6]}},
                {"type": "sphere", "emission": 40, "bsdf": GLOW, "transform": {"position": [1.6, 0, 0.9], "scale": 0.3}}],
            "camera": pinhole([0, 0.5, 5], [0, 0, 0], 20),
            "integrator": {"max_bounces": 64, **gate(8.4, 10)}}


def fog_under_glass():
    """A block of fog beneath a block of glass, seen and lit from above."""
    return {"media": [medium(4, 0.02)],
            "primitives": [
                {"type": "cube", "bsdf": FORWARD, "int_medium": "medium", "transform": {"position": [0, -0.25, 0], "scale": [1, 0.5, 1]}},
                {"type": "cube", "bsdf": {"type": "dielectric", "ior": 1.5},
                 "transform": {"position": [0, 0.251, 0], "scale": [1, 0.5, 1]}},
                {"type": "sphere", "emission": 40, "bsdf": GLOW, "transform": {"position": [1.2, 1.2, 1.4], "scale": 0.3}}],
            "camera": pinhole([0.5, 1.2, 4.5], [0, 0, 0], 20),
            "integrator": {"max_bounces": 64, **gate(6, 7.4)}}


def tissue(sigma_s, g):
    """An index-matched slab of 20 mm under a collimated fibre of energy 1, and a fibre of radius 1 mm that is 10 mm off; mm and ps."""
    return {"media": [{**medium(sigma_s, 0.01, g), "speed_of_light": 0.214137, "max_bounces": 1000000}],
            "primitives": [
                {"type": "cube", "bsdf": FORWARD, "int_medium": "medium", "transform": {"position": [0, 0, -10], "scale": [200, 200, 20]}},
                {"type": "collimated", "radius": 0.2, "emission": 7.957747,
                 "transform": {"position": [0, 0, 0.5], "look_at": [0, 0, -1], "up": [0, 1, 0]}}],
            "camera": {"type": "detectors", "detectors": [
                {"name": "10 mm", "position": [10, 0, 0.05], "direction": [0, 0, -1], "radius": 1, "numerical_aperture": 1}]},
            "integrator": {"max_bounces": 20000, "vacuum_speed_of_light": 0.214137, **film(0, 250, 8)}}


def room_of_thin_fog():
    """A grey room with a block and a small lamp, in fog of a mean free path of about its size; 20 frames."""
    def wall(albedo, *matrix):
        return {"type": "quad", "bsdf": {"type": "lambert", "albedo": albedo}, "transform": [*matrix, 0, 0, 0, 1]}

    return {"media": [medium(0.25, 0.005, g=0.5)],
            "primitives": [
                wall(0.6, 4, 0, 0, 0, 0, 1, 0, -1.5, 0, 0, 3, 0), wall(0.6, -4, 0, 0, 0, 0, -1, 0, 1.5, 0, 0, 3, 0),
                wall(0.5, 0, -1, 0, -2, 3, 0, 0, 0, 0, 0, 3, 0), wall(0.5, 0, 1, 0, 2, -3, 0, 0, 0, 0, 0, 3, 0),
                wall(0.7, 4, 0, 0, 0, 0, 0, -3, 0, 0, 1, 0, -1.5), wall(0.3, 4, 0, 0, 0, 0, 0, 3, 0, 0, -1, 0, 1.5),
                {"type": "cube", "bsdf": {"type": "lambert", "albedo": 0.5},
                 "transform": {"position": [0.7, -1, -0.6], "scale": [0.85, 1, 0.85], "rotation": [0, 20, 0]}},
                {"type": "sphere", "emission": 40, "bsdf": GLOW, "ext_medium": "medium",
                 "transform": {"position": [-0.8, 1.1, -0.4], "scale": 0.15}}],
            "camera": pinhole([0, 0, 1.3], [0, 0, 0], 70, (4, 3), medium="medium"),
            "integrator": {"max_bounces": 200, **film(1, 0.5, 20)}}


def detectors_in_fog(lamp):
    """Endless fog, two detectors that look up, and a "laser", "point" or "ball" above them."""
    lights = {"laser": {"type": "collimated", "radius": 0.2, "power": 1,
                        "transform": {"position": [0, 0, 2], "look_at": [0, 0, 0], "up": [0, 1, 0]}},
              "point": {"type": "point", "power": 1, "transform": {"position": [0.3, 0.2, 2]}},
              "ball": {"type": "sphere", "power": 1, "bsdf": GLOW, "transform": {"position": [0.3, 0.2, 2], "scale": 0.2}}}
    return {"media": [medium(0.4, 0.1)],
            "primitives": [{**lights[lamp], "ext_medium": "medium"}],
            "camera": {"type": "detectors", "medium": "medium", "detectors": [
                {"name": "below", "position": [0, 0, 0], "direction": [0, 0, 1], "radius": 0.5, "numerical_aperture": 1},
                {"name": "beside", "position": [1, 0, 0], "direction": [0, 0, 1], "radius": 0.5, "numerical_aperture": 0.7}]},
            "integrator": {"max_bounces": 64}}
