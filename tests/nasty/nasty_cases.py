"""Scenes that are hard on a renderer, each with what is promised about it. Images have one pixel, so that its standard error is that of
the image."""

import copy
import math
from dataclasses import dataclass, field

# How close methods are promised to be besides five standard errors: kernels of photons are a tenth of the scene.
KERNEL = 0.04
PATHS = ["paths, plain", "paths, best"]
POINTS = ["points, plain", "points, best"]
BEAMS = ["beams, plain", "beams, best"]
ALL = PATHS + POINTS + BEAMS


@dataclass
class Case:
    name: str
    promise: str
    scene: dict
    methods: list = field(default_factory=lambda: list(ALL))
    agree: list = field(default_factory=lambda: list(ALL))  # methods that agree within errors; of others only finite values are asked
    black: bool = False         # every value is 0
    kernel: float = KERNEL
    expected: float | None = None
    within: float = 0.0         # of `expected`, besides five standard errors
    spp: int = 48
    step: int = 3
    paths: int = 64             # times as many samples of paths
    set: dict = field(default_factory=dict)
    files: dict = field(default_factory=dict)
    like: dict | None = None    # a scene that looks the same
    warns: str = ""             # a part of a warning
    long: bool = False          # not in ctest


def at(position, **more):
    return {"position": list(position), **more}


LAMBERT = {"type": "lambert", "albedo": 0.6}
FORWARD = {"type": "forward"}
GLASS = {"type": "dielectric", "ior": 1.5}


def wall(name, position, rotation=(0, 0, 0), scale=2.0, **more):
    return {"name": name, "type": "quad", "bsdf": LAMBERT, "transform": at(position, rotation=list(rotation), scale=scale), **more}


def walls(**more):
    return [wall("floor", (0, 0, 0), **more), wall("ceiling", (0, 2, 0), (180, 0, 0), **more), wall("back", (0, 1, -1), (90, 0, 0), **more),
            wall("front", (0, 1, 1), (-90, 0, 0), **more), wall("left", (-1, 1, 0), (0, 0, -90), **more),
            wall("right", (1, 1, 0), (0, 0, 90), **more)]


def lamp(position=(0.3, 1.6, 0.2), **more):
    return {"name": "lamp", "type": "point", "emission": 8, "ext_medium": "fog", "transform": at(position), **more}


def room(*things, gate=(3.0, 2.0), medium=None, light=None, camera=None, boundary=None, **integrator):
    """A closed room of fog, a lamp, whatever is added."""
    fog = {"name": "fog", "type": "homogeneous", "sigma_s": 0.5, "sigma_a": 0.05, **(medium or {})}
    return {"media": [fog], "bsdfs": [], "primitives": (boundary or walls()) + [light or lamp()] + list(things),
            "camera": {"type": "pinhole", "resolution": [1, 1], "fov": 50, "medium": "fog", "reconstruction_filter": "box",
                       "transform": at((0, 1, 0.9), look_at=[0, 0.9, -1], up=[0, 1, 0]), **(camera or {})},
            "integrator": {"max_bounces": 12, "transient_time_center": gate[0], "transient_time_width": gate[1], "photon_count": 1500,
                           "volume_photon_count": 1500, "gather_radius": 0.15, "volume_gather_radius": 0.12,
                           "gather_photon_count": 1000, "fixed_volume_radius": True, **integrator}}


def by(method, scene):
    """The scene by one of the methods."""
    scene = copy.deepcopy(scene)
    kind, preset = method.split(", ")
    chosen = {"darts": "best" if preset == "best" else "off"}
    if kind == "paths":
        chosen["type"] = "path_tracer"
    else:
        chosen |= {"type": "progressive_transient_photon_map", "volume_photon_type": kind}
    scene["integrator"] |= chosen
    return scene


def scaled(scene, k):
    """Lengths and times times k, coefficients divided by it; intensities of points times k^2. Integrals over gates are the same."""
    scene = copy.deepcopy(scene)
    for medium in scene["media"]:
        for name in ("sigma_s", "sigma_a"):
            medium[name] = [x / k for x in medium[name]] if isinstance(medium.get(name), list) else medium.get(name, 0) / k
    for thing in scene["primitives"]:
        placed = thing["transform"]
        placed["position"] = [x * k for x in placed["position"]]
        if thing["type"] == "point":
            thing["emission"] *= k * k
        else:
            scale = placed.get("scale", 1.0)
            placed["scale"] = [x * k for x in scale] if isinstance(scale, list) else scale * k
    placed = scene["camera"]["transform"]
    placed["position"], placed["look_at"] = [x * k for x in placed["position"]], [x * k for x in placed["look_at"]]
    for name in ("transient_time_center", "transient_time_width", "gather_radius", "volume_gather_radius"):
        scene["integrator"][name] *= k
    scene["integrator"]["time_normalization"] = "integral"
    return scene


def moved(scene, by_):
    scene = copy.deepcopy(scene)
    for thing in scene["primitives"] + [scene["camera"]]:
        for name in ("position", "look_at"):
            if name in thing["transform"]:
                thing["transform"][name] = [x + d for x, d in zip(thing["transform"][name], by_)]
    return scene


def needle(width):
    """Single and higher orders in fog without walls: smooth in time, so that the gate's width does not matter."""
    scene = room(gate=(3.0, 3.0 * width), boundary=[wall("far", (0, -30, 0))], medium={"sigma_s": 1.0})
    return scene


def mesh_of(lines):
    return "\n".join(lines) + "\n"


SQUARE = ["v -1 0 -1", "v 1 0 -1", "v 1 0 1", "v -1 0 1"]
FACES = ["f 1 3 2", "f 1 4 3"]


def mesh(name, file):
    return {"name": name, "type": "mesh", "file": file, "bsdf": LAMBERT, "transform": at((0, 0, 0))}


def floor_mesh(file):
    return [mesh("floor", file)] + walls()[1:]


def glass_ball(radius=0.5, **inside):
    return {"name": "ball", "type": "sphere", "bsdf": GLASS, "int_medium": inside.get("medium", "fog"), "ext_medium": "fog",
            "transform": at((0, 1, 0.9 if inside.get("camera") else -0.3), scale=radius)}


def cube(name, position, scale, inner="thick", outer="fog", bsdf=None):
    return {"name": name, "type": "cube", "bsdf": bsdf or FORWARD, "int_medium": inner, "ext_medium": outer,
            "transform": at(position, scale=scale)}


def with_media(scene, *media):
    scene["media"] += [{"type": "homogeneous", **medium} for medium in media]
    return scene


THICK = {"name": "thick", "sigma_s": 2.0, "sigma_a": 0.1}
AREA = {"name": "lamp", "type": "quad", "emission": 4, "bsdf": {"type": "null"}, "ext_medium": "fog"}


def far_gate():
    return {"gate": (400.0, 1.0)}


def energy_room(bounces, times):
    """Walls and fog that keep all light of a pulse: at late times radiance is even, energy c / (4 pi V) = pi 8 4 / (4 pi 8) = 1."""
    boundary = walls(bsdf={"type": "lambert", "albedo": 1})
    boundary[1] |= {"emission": 8, "ext_medium": "fog"}
    scene = room(boundary=boundary[2:], light=boundary[1], medium={"sigma_s": 0.5, "sigma_a": 0, "max_bounces": 10 ** 6}, max_bounces=bounces)
    scene["primitives"].append(boundary[0])
    scene["integrator"] |= {"transient_time_center": times, "transient_time_width": 2.0}
    return scene


def cases():
    """In the order of docs/accuracy-hard-scenes.csv."""
    same = "points, beams and paths, plain and best, agree within 5 standard errors and the kernel's blur"
    finite = "finite, no crash, no hang"
    many = [lamp((0.3 + 1e-3 * math.sin(i), 1.6, 0.2 + 1e-3 * math.cos(i)), emission=8e-4, name=f"lamp {i}") for i in range(10000)]
    crowd = {count: SQUARE + ["v 0 1e-3 0"] * 3 + FACES + ["f 5 6 7"] * count for count in (5000, 10 ** 6)}
    degenerate = SQUARE + FACES + ["f 1 1 2", "f 1 2 1", "f 3 3 3", "f 1 2 4", "f 1 2 4"] + FACES
    listed = [
        Case("room", same, room()),
        Case("needle gate, 1e-7 of the arrival", "best methods agree with a gate 1e4 times as wide", needle(1e-7),
             methods=["paths, best", "points, best"], expected=-1),
        Case("gate before the first light", "black", room(gate=(0.2, 0.2)), black=True),
        Case("gate after the last light (vacuum, three bounces)", "black",
             room(gate=(400.0, 1.0), medium={"sigma_s": 0, "sigma_a": 0}, max_bounces=3), black=True),
        Case("gate long after most light", same, room(gate=(60.0, 1.0))),
        Case("camera on a boundary", same,
             with_media(room(cube("mist", (0, 1, 0.4), 1.0), camera={"medium": "thick"}), THICK), kernel=0.15),
        Case("camera in a wall", same, room(camera={"transform": at((0, 1, 1.0), look_at=[0, 0.9, -1], up=[0, 1, 0])})),
        Case("camera inside a glass sphere of fog", same, room(glass_ball(0.08, camera=True), spp=1), spp=96, kernel=0.08),
        Case("point light in the plane of a wall", "finite; a warning, since rounding decides", room(light=lamp((0.0, 2.0, 0.0), emission=8)),
             agree=[], warns="lies in the surface 'ceiling'"),
        Case("area light in the plane of a wall", same,
             room(light={**AREA, "transform": at((0, 2, 0), rotation=[180, 0, 0], scale=0.5)})),
        Case("light at the camera", same, room(light=lamp((0, 1, 0.9), emission=2))),
        Case("light inside a closed lamp", same,
             room({"name": "inner", "type": "sphere", "emission": 4, "bsdf": LAMBERT, "ext_medium": "fog", "transform": at((0, 1, 0), scale=0.1)},
                  light={"name": "outer", "type": "sphere", "emission": 4, "bsdf": LAMBERT, "ext_medium": "fog",
                         "transform": at((0, 1, 0), scale=0.2)})),
        Case("touching media", same, with_media(room(cube("left mist", (-0.3, 1, -0.2), 0.6), cube("right mist", (0.3, 1, -0.2), 0.6)), THICK),
             kernel=0.08),
        Case("overlapping media", same,
             with_media(room(cube("left mist", (-0.1, 1, -0.2), 0.6), cube("right mist", (0.2, 1, -0.2), 0.6)), THICK)),
        Case("nested media", same,
             with_media(room(cube("mist", (0, 1, -0.2), 0.8), cube("core", (0, 1, -0.2), 0.4, "dense", "thick")), THICK,
                        {"name": "dense", "sigma_s": 6.0}), kernel=0.12),
        Case("a box of no thickness", "as without it", with_media(room(cube("flat", (0, 1, -0.2), [0.8, 0.8, 0.0])), THICK), kernel=0.08, like=room()),
        Case("degenerate and duplicate triangles", "as the floor without them", room(boundary=floor_mesh("degenerate.obj")),
             files={"degenerate.obj": mesh_of(degenerate)}, like=room()),
        Case("5000 triangles in one point", "as the floor without them", room(boundary=floor_mesh("crowd.obj")),
             files={"crowd.obj": mesh_of(crowd[5000])}, like=room()),
        Case("1e6 triangles in one point", "as the floor without them", room(boundary=floor_mesh("crowd.obj")),
             files={"crowd.obj": mesh_of(crowd[10 ** 6])}, like=room(), long=True),
        Case("sigma of 0, 1e-9 and 1e4 by channel", same, room(medium={"sigma_s": [0, 1e-9, 1e4], "sigma_a": [1e-9, 1e4, 0]})),
        Case("g = 0.999", finite + "; paths agree", room(medium={"phase_function": {"type": "henyey_greenstein", "g": 0.999}}), agree=PATHS),
        Case("g = -0.999", finite + "; paths agree", room(medium={"phase_function": {"type": "henyey_greenstein", "g": -0.999}}), agree=PATHS),
        Case("a room of mirrors", same, room(boundary=walls(bsdf={"type": "mirror"}), light={
            "name": "lamp", "type": "sphere", "emission": 4, "bsdf": LAMBERT, "ext_medium": "fog", "transform": at((0.3, 1.6, 0.2), scale=0.1)},
            max_bounces=64), kernel=0.1, paths=2000),
        Case("1e4 emitters", "as one of their power", room(light=many[0], *[]), set={"primitives": walls() + many}, spp=24, like=room()),
        Case("energy after 40 to 60 bounces", "energy c / (4 pi V) within 5 standard errors", energy_room(4000, 40.0), methods=["paths, plain"], paths=1,
             expected=1.0, spp=64000, step=4000),
        Case("energy after 10 000 bounces", "energy c / (4 pi V) within 5 standard errors", energy_room(100000, 8000.0),
             methods=["paths, plain"], expected=1.0, spp=400, step=25, long=True),
    ]
    return listed
