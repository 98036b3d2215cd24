#!/usr/bin/python3
"""Judges a change that is meant to keep every image: 40 small scenes are rendered by the build before it and the one after it, by paths,
light paths, points, beams and a sliced primitive, with darts off, published and best, and the films are compared.

    tests/render/bits.py HEAD~1 tree                                    bit for bit
    tests/render/bits.py old/build/bin/tungsten build --tolerance 1e-6  default builds

A build is the path of a tungsten command, a build folder, a git revision, or `tree`, the work tree as it is. The last two are built below
build-bits/, without contraction into fused multiply-adds and without unity builds: GCC contracts and inlines differently when code moves
between files, which changes last digits. A revision gets a git worktree there, which later runs use again.
The renders take about a minute on two cores.

Nothing is stored: scenes are made here. Every render has the same seed and one thread, so that its sums have an order. Without --tolerance
all arrays of a film must have the same bytes. With it, means may differ by that part of the film's largest mean, and standard errors by as
much in their squares, which are what is summed. A scene that both builds refuse with the same message is alike; a crash never is.

Exit codes: 0 all films agree, 1 some differ, 2 bad usage, a build that cannot be made, or more than a quarter refused."""

import argparse
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from collections import Counter, namedtuple
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).resolve().parents[2]
sys.path.insert(0, str(PROJECT / "benchmarks"))
from darts_bench.scene_words import at, body, camera, facing, frames, gate, lambert, lamp, looking, medium, room, steady, write_assets  # noqa: E402

SECONDS, REFUSED = 120, "refused"  # a render that takes longer counts as one without end
OPTIONS = ["-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=-ffp-contract=off",
           *[f"-DTUNGSTEN_{part}=OFF" for part in ("UNITY", "TESTS", "BENCHMARKS", "PYTHON")]]
PHOTONS, PRESETS = "progressive_transient_photon_map", ("off", "published", "best")
METHODS = {"paths": ("path_tracer", PRESETS), "light": ("light_tracer", ("off",)), "points": (PHOTONS, PRESETS),
           "beams": (PHOTONS, PRESETS), "slices": (PHOTONS, PRESETS)}
COUNTS = {"volume_photon_count": 12000, "gather_photon_count": 12, "gather_radius": 0.4, "volume_gather_radius": 0.2,
          "fixed_volume_radius": True}


# ---- Scenes

# `slices` is the sliced primitive, `darts` has switches over the presets, `blocks` are further ones of the file.
Scene = namedtuple("Scene", "name slices media primitives camera integrator darts blocks", defaults=({}, {}))
WAVES = {"type": "bitmap", "file": "waves.pfm", "scale": 2.0}
STRIPES = {"type": "bitmap", "file": "stripes.pfm", "interpolate": False}
CHECKER = {"type": "checker", "on_color": [0.8, 0.6, 0.2], "off_color": 0.2, "res_u": 3, "res_v": 4}
FOG = medium("fog", 0.8, 0.05)
MILK = medium("milk", [2.0, 2.5, 3.0], 0.1, 0.3, 0.75)
CUBE = at(0, 0, 0, (2.0, 1.8, 1.6), 20)
WHERE = (1.1, 1.1, 1.0)


def glass(ior=1.5, **fields):
    return {"type": "dielectric", "ior": ior, **fields}


def view(position=(0, 0, 5), target=(0, 0, 0), inside=None, **fields):
    return {**camera(position, target, 24.0, inside), "resolution": [12, 10], **fields}


def bulb(position=WHERE, size=0.3, emission=40.0, outside=None, **fields):
    return lamp("sphere", at(*position, size), emission, outside, **fields)


def ball(x, y, z, size, bsdf, **fields):
    return body("sphere", at(x, y, z, size), bsdf=bsdf, **fields)


def card(position, target, size, bsdf, **fields):
    return body("quad", facing(position, target, size), bsdf=bsdf, **fields)


BACK = card((0, 0, -0.8), (0, 0, 5), 2.6, lambert([0.5, 0.6, 0.7]))


def bodies_of_fog():
    thin, thick = medium("thin", 0.4), medium("thick", [5.0, 4.0, 3.0], 0.05)
    yield Scene("nested-cubes", "volumes", [thin, thick], [body("cube", at(0, 0, 0, 1.8, 25), "thin"),
                body("cube", at(0.1, 0, 0, 0.9, 50), "thick", "thin"), bulb()], view(), gate(6.2, 7.4))
    yield Scene("nested-spheres", "hypervolumes", [thin, thick, medium("core", 1.0, 1.0, 0.5)],
                [body("sphere", at(0, 0, 0, 0.9), "thin"), body("sphere", at(0, 0, 0, 0.6), "thick", "thin"),
                 body("sphere", at(0.1, 0, 0.1, 0.25), "core", "thick"), bulb()], view(reconstruction_filter="tent"), gate(6.2, 7.6),
                {"preset": "published", "direction": "ris", "candidates": 16, "bodies": True}, {"film": {"batches": 2, "batch_block": 3}})
    yield Scene("tissue-layers", "planes", [medium("skin", 6.0, 0.2, 0.8), medium("fat", 3.0, 0.05, 0.8)],
                [body("cube", at(0, 0, 0, (1.6, 1.6, 1.2)), "fat"), body("cube", at(0, 0, 0.4, (1.59, 1.59, 0.3)), "skin", "fat"), bulb()],
                view(), gate(6.0, 7.8, 48), {"preset": "published", "greens_function": "diffusion", "proposals": "mixed"})
    yield Scene("cloud-in-haze", "mis_volumes_balls", [medium("haze", 0.1), medium("cloud", 8.0)],
                [body("sphere", at(0, 0, 0, 0.6), "cloud", "haze"), lamp("point", at(*WHERE), 6.0, "haze")],
                view(inside="haze", reconstruction_filter="gaussian"), gate(6.2, 7.6, 48))
    yield Scene("touching-cubes", "balls", [medium("left", 3.0, 0.02), medium("right", 6.0, 0.3, 0.6)],
                [body("cube", at(-0.5, 0, 0), "left"), body("cube", at(0.5, 0, 0), "right"), bulb()], view(), gate(6.0, 24.0, 48),
                {"preset": "published", "proposals": "equiangular", "candidates": 1, "bodies": True})
    yield Scene("hole-in-fog", "volumes_balls", [medium("fog", 2.0, 0.05)], [body("cube", at(0, 0, 0, 1.6, 20), "fog"),
                body("sphere", at(0, 0, 0.2, 0.4), None, "fog"), bulb((0.1, 0.1, 0.2), 0.15)], view(), gate(4.6, 6.0), {"bodies": False})
    yield Scene("camera-in-fog", "balls", [FOG], [body("mesh", at(0, 0, 0, (1.5, 1.4, 1.6), 30), "fog", file="ball.obj"),
                bulb((0.9, 0.9, -2.2))], view((0, 0, 1.2), inside="fog"), gate(3.0, 5.0), {"bounded": False})


def refraction():
    inner = bulb((0.1, 0.1, 0.0), 0.3, 20.0, "milk")
    yield Scene("glass-jar", "volumes", [MILK], [ball(0, 0, 0, 0.9, glass(), int_speed_of_light=0.67), BACK, bulb((1.0, 0.7, 1.2), 0.5),
                ball(0, 0, 0, 0.8, glass(0.89), int_medium="milk", ext_speed_of_light=0.67)], view(), gate(5.6, 8.4))
    yield Scene("glass-tank", "balls", [MILK], [body("cube", at(0, 0, 0, 1.2, 30), "milk", bsdf=glass(1.33)), bulb((0.4, 0.82, 0.3), 0.2)],
                view(), gate(4.0, 7.0))
    yield Scene("glass-cube-in-fog", "hypervolumes", [MILK, FOG], [body("cube", at(0, 0, 0, 1.1, 30), "milk", "fog", glass(1.33)), inner],
                view(inside="fog"), gate(4.6, 6.0))
    yield Scene("rough-glass", "planes", [MILK], [body("sphere", at(0, 0, 0, 0.8), "milk", None, {
        "type": "rough_dielectric", "ior": 1.3, "roughness": 0.3, "distribution": "beckmann"}), inner], view(), gate(4.6, 6.0))
    yield Scene("caustic", "mis_volumes_balls", [FOG], [ball(0.1, 0.2, 0, 0.45, glass(), ext_medium="fog"),
                card((-0.4, -0.5, 0), (-1, 1, 2), 0.6, glass(enable_refraction=False, albedo=[1, 0.8, 0.6])),
                bulb((-1.4, 0.7, 0.2), 0.35, 30.0, "fog")], view(inside="fog"), gate(5.4, 6.8))
    yield Scene("mirror-box", "volumes_balls", [FOG], [*[card(place, (0, 0, 0), 2.4, {"type": "mirror", "albedo": 0.9}) for place in (
        (0, -1.2, 0), (0, 1.2, 0), (-1.2, 0, 0), (1.2, 0, 0), (0, 0, -1.2))], bulb((0.5, 0.4, 0), 0.2, 40.0, "fog")],
        view(inside="fog"), gate(4.8, 7.0, 16), {"direct_view": "on"})


def surfaces():
    def shown(name, slices, *things, times=(6.0, 7.8), darts={}, media=(FOG,), **switches):
        inside = media[0]["name"] if media else None
        lamps = bulb((0.6, 0.8, 1.0), 0.25, 40.0, inside)
        return Scene(name, slices, list(media), [*things, lamps], view(inside=inside), gate(*times, **switches), darts)

    yield shown("metals", "balls", BACK, card((-0.6, 0, -0.4), (0.5, 0, 2), 1.0, {"type": "mirror"}),
                ball(0.5, 0.3, 0, 0.3, {"type": "conductor", "material": "Al"}),
                ball(0.3, -0.5, 0.3, 0.3, {"type": "rough_conductor", "distribution": "phong", "roughness": 0.3}),
                ball(-0.5, -0.6, 0.3, 0.3, {"type": "rough_conductor", "eta": [0.2, 0.9, 1.1], "k": [3.9, 2.4, 2.2], "roughness": CHECKER}),
                darts={"glossy_sensor_paths": False, "direction": "connection"}, alpha=1)
    yield shown("plastics", "volumes", BACK, ball(-0.6, 0.3, 0, 0.35, {"type": "plastic", "albedo": [0.2, 0.5, 0.7]}),
                ball(0.5, 0.3, 0, 0.35, {"type": "rough_plastic", "albedo": 0.6, "roughness": 0.25, "sigma_a": 0.3, "Ks": 0.8}),
                card((0, -0.7, 0), (0, 1, 0.3), 1.4, {"type": "pbrt_plastic", "albedo": 0.5, "roughness": 0.2, "Ks": [0.3, 0.2, 0.1]}))
    veil = {"type": "transparency", "alpha": STRIPES, "base": lambert([0.8, 0.4, 0.2])}
    yield shown("veils", "planes", BACK, card((-0.4, 0.3, 0.2), (0, 0, 5), 0.8, veil),
                card((0.4, 0, 0.2), (1.5, 0, -5), 0.8, {**veil, "alpha": 0.6}),
                ball(0, -0.5, 0.2, 0.3, {"type": "mixed", "ratio": CHECKER, "bsdf0": lambert(0.8), "bsdf1": glass(1.4)}))
    chalk = {"type": "oren_nayar", "albedo": 0.7, "sigma": 0.5}
    yield shown("one-sided-chalk", "hypervolumes", card((0, 0, -0.8), (0, 0, 5), 2.6, lambert(0.6, bump=WAVES)),
                card((-0.6, 0, 0.2), (-1, 0, -5), 0.7, chalk), card((0.6, 0, 0.2), (1, 0, 5), 0.7, chalk),
                body("mesh", at(0, 0, 0, 0.4), bsdf=lambert(0.7), file="ball.obj", smooth=True, recompute_normals=True),
                enable_two_sided_shading=False, enable_consistency_checks=True)
    yield shown("textures", "volumes_balls", card((0, 0, -0.8), (0, 0, 5), 2.6, lambert(CHECKER)),
                ball(0.3, 0, 0, 0.4, lambert({**STRIPES, "interpolate": True, "scale": 0.8})),
                lamp("quad", facing((-1.1, 1.1, 1.0), (0, 0, 0), 0.6), {**STRIPES, "scale": 30.0}, "fog"))
    yield shown("room-without-fog", "planes", *room(2.6, [0.7, 0.5, 0.3]), ball(0, -0.6, 0, 0.5, lambert(0.7)), times=(5.0, 9.0), media=())


def lights():
    def lit(name, slices, *lamps, times=(6.0, 7.8), darts={}):
        things = [ball(0, -0.3, 0, 0.35, lambert(0.7)), *lamps]
        return Scene(name, slices, [FOG], things, view(inside="fog", reconstruction_filter="mitchell_netravali"), gate(*times), darts)

    there = facing(WHERE, (0, 0, 0), 0.6)
    yield lit("lamps-of-all-shapes", "volumes", lamp("quad", there, 0, "fog", power={**CHECKER, "on_color": [60, 20, 5]}),
              lamp("disk", facing((-1, 1, 1), (0, 0, 0), 0.4), 1.0, "fog", power=[40, 30, 20], cone_angle=40),
              lamp("cube", at(1.1, -1, 1, 0.4, 30), 20.0, "fog"), lamp("mesh", at(-1, -1, 1, 0.3), [5, 20, 20], "fog", file="ball.obj"))
    yield lit("point-and-spot", "balls", lamp("point", at(-1, -1, 1), 0, "fog", power=[5, 20, 40]),
              lamp("spot", looking((1.6, 0.6, 0), (0, 0, 0)), 8.0, "fog", cone_angle=35, edge_angle=10), darts={"greens_function": "causal"})
    yield lit("lasers", "hypervolumes", lamp("collimated", looking((1.5, 0.3, 0), (0, 0.3, 0)), 60.0, "fog", radius=0.1),
              lamp("collimated", looking((-1.5, 0.2, 0), (0, 0.3, 0)), [1, 2, 3], "fog"),
              lamp("directional_point", looking((0, 1.5, 0.4), (0, 0, 0)), 3.0, "fog"), lamp("point", at(*WHERE), 0.5, "fog"))
    yield lit("pulses", "volumes", lamp("quad", there, 20.0, "fog", pulse={"type": "gaussian", "center": 0.3, "sigma": 0.1}),
              bulb((-1.2, 1.0, 0.8), 0.25, [5, 20, 40], "fog", emission_time=0.4, pulse={"times": [0, 0.1, 0.5], "values": [1, 3, 0]}),
              lamp("disk", facing((0, -1.4, 1), (0, 0, 0), 0.3), [40, 10, 5], "fog", emission_time=-0.3, pulse={"type": "box", "end": 0.3}),
              lamp("point", at(0.3, 1.2, 0.5), 4.0, "fog", pulse={"type": "exponential", "start": 0.1, "decay": 0.2}),
              lamp("point", at(0.3, 1.2, 0.5), 4.0, "fog", emission_time=50.0))
    yield Scene("sky", "volumes", [medium("cloud", 2.0, 0.2, 0.5)], [body("sphere", at(0, 0.2, 0, 0.6), "cloud"),
                card((0, -0.7, 0), (0, 1, 0), 3.0, lambert(0.6)), lamp("infinite_sphere", at(0, 0, 0), {**STRIPES, "interpolate": True})],
                view((0, 0.5, 5)), steady(enable_rr=True))


def sensors():
    haze = medium("haze", 0.3, 0.02, 0.4)
    things = [ball(-0.3, 0, 0, 0.3, lambert([0.7, 0.3, 0.2])), body("cube", at(0.4, -0.2, -0.4, 0.5, 30), bsdf=lambert(0.5)),
              bulb(outside="haze")]
    yield Scene("thin-lens", "balls", [haze], things, view(inside="haze", type="thinlens", aperture_size=0.25, focus_distance=4.0,
                reconstruction_filter="lanczos"), gate(6.0, 7.8), {"length_first": False})
    yield Scene("orthographic", "volumes_balls", [medium("cloud", 4.0)], [body("sphere", at(0, 0, 0, 0.7), "cloud"), bulb()],
                view(type="orthographic", orthographic_size=0.8), gate(6.0, 7.8), blocks={"film": {"moments": False}})
    discs = [{"position": [x, 0.3, 2.0], "direction": [0.1 * x, 0, -1], "radius": 0.1, "numerical_aperture": aperture}
             for x, aperture in ((-0.5, 1.0), (0.0, 0.6), (0.4, 0.4), (0.8, 0.3))]
    yield Scene("detectors", "volumes", [medium("tissue", 4.0, 0.1, 0.6)], [body("cube", CUBE, "tissue"), bulb()],
                {"type": "detectors", "detectors": discs}, frames(2.4, 0.5, 4), blocks={"length_unit": "mm"})
    yield Scene("unwarped-mirror", "planes", [haze], [*things, card((0.9, 0.2, -0.8), (0, 0.2, 1.5), 1.6, {"type": "mirror", "albedo": 0.9})],
                view(inside="haze"), gate(1.4, 3.4, camera_unwarped=True))


def times():
    inner, outer = lamp("point", at(0.6, 0.5, -0.2), 5.0, "fog"), ball(0, -0.2, 0, 0.35, lambert(0.7))
    cube, open_fog = [body("cube", CUBE, "fog"), inner], [outer, bulb(outside="fog")]
    there = view(inside="fog", reconstruction_filter="catmull_rom")
    yield Scene("frames", "balls", [FOG], open_fog, there, frames(5.6, 0.3, 8, time_normalization="integral"), {"single_frames": False})
    yield Scene("many-frames", "volumes", [FOG], cube, view(), frames(4.4, 0.04, 64, 12), blocks={"film": {"channels": "luminance"}})
    yield Scene("delta-gate", "hypervolumes", [medium("fog", [0.6, 1.2, 2.0], [0.3, 0.1, 0.02], 0.2)], cube, view(),
                gate(5.2, 5.6, 12, delta_time_gate=True))
    yield Scene("unwarped-delta-gate", "balls", [medium("fog", 1.2, 0.1, 0.7)], cube, view(),
                gate(1.2, 1.6, 12, delta_time_gate=True, camera_unwarped=True))
    response = {"max_bounces": 12, "temporal_response": {"type": "gaussian", "center": 6.8, "sigma": 0.4}}
    yield Scene("response", "mis_volumes_balls", [FOG], open_fog, there, response)
    yield Scene("delayed-frames", "planes", [FOG], cube, view(),
                frames(4.6, 0.4, 5, temporal_response={"times": [0, 0.2, 0.6], "values": [0, 1, 0.2]}))
    chance = dict(enable_light_sampling=False, enable_volume_light_sampling=False)
    yield Scene("steady-fog", "planes", [FOG], open_fog, there, steady(16, fixed_volume_radius=False, **chance))


def media_and_bounces():
    things = [bulb(outside="fog"), ball(0, -0.2, 0, 0.3, lambert([0.7, 0, 0.2]))]
    yield Scene("slow-and-fast", "volumes_balls", [medium("fast", 0.5, 0.02, speed=1.5), medium("slow", 2.0, 0.02, speed=0.5)],
                [body("cube", at(0, 0, 0, 1.8), "fast"), body("cube", at(0, 0, 0, 0.8, 30), "slow", "fast"), bulb()], view(),
                {**gate(7.4, 9.6), "vaccum_speed_of_light": 0.8})
    rayleigh = {**medium("fog", [0.8, 0.0, 0.4], [0.0, 0.3, 0.1]), "phase_function": {"type": "rayleigh"}}
    yield Scene("rayleigh", "volumes", [rayleigh], things, view(inside="fog"), gate(6.0, 7.8, fixed_volume_radius=False, alpha=0.7))
    forks = {**medium("fog", 0.4, 0.6, density=1.2, max_bounces=5), "type": "guided_homo", "phase_function": {"type": "ida", "g": -0.4}}
    yield Scene("absorber", "balls", [forks, medium("ink", 0.0, [1, 2, 3])], [*things, body("sphere", at(0.5, 0.4, 0.3, 0.3), "ink", "fog")],
                view(inside="fog", reconstruction_filter="dirac"), gate(6.0, 7.8),
                {"direction": "eda", "distance": "plain"})
    kept = dict(min_bounces=2, volume_photon_length="short")
    yield Scene("few-bounces", "planes", [FOG], [body("cube", at(0, 0, 0, 1.2, 30)), *things], view(inside="fog"), gate(5.6, 8.4, 5, **kept))
    left_out = dict(low_order_scattering=False, include_surfaces=False, enable_rr=True)
    yield Scene("fog-alone", "volumes", [FOG], things, view(inside="fog"), gate(5.6, 8.4, **left_out), {"roulette": 0.5, "alpha": 2})


def scenes():
    return [scene for group in (bodies_of_fog, refraction, surfaces, lights, sensors, times, media_and_bounces) for scene in group()]


# ---- Builds

class CannotBuild(Exception):
    pass


def run(*command):
    command = [str(part) for part in command]
    environment = {"CCACHE_SLOPPINESS": "pch_defines,time_macros", **os.environ}  # else it leaves precompiled headers alone
    done = subprocess.run(command, capture_output=True, text=True, cwd=PROJECT, env=environment)
    if done.returncode != 0:
        raise CannotBuild(f"{' '.join(command)}\n{(done.stdout + done.stderr)[-4000:]}")
    return done.stdout.strip()


def command_of(name, jobs):
    """The tungsten command that a path, a build folder, a revision or `tree` stands for; built if need be."""
    for command in (Path(name), Path(name, "bin/tungsten"), Path(name, "tungsten")):
        if name != "tree" and command.is_file() and os.access(command, os.X_OK):
            return command.absolute()
    source, folder = PROJECT, PROJECT / "build-bits/tree"
    if name != "tree":
        try:
            commit = run("git", "rev-parse", "--verify", "--end-of-options", name + "^{commit}")
        except CannotBuild:
            raise CannotBuild(f"'{name}' is no tungsten command, no folder that holds one, and no revision") from None
        folder = PROJECT / "build-bits" / commit[:12]
        source = folder / "source"
        if not (source / ".git").exists():
            run("git", "worktree", "add", "--force", "--detach", "--no-checkout", source, commit)
        run("git", "-C", source, "checkout", "--quiet", "--force", "--detach", commit)  # whatever has been edited there
    print(f"building {name} in {folder}", file=sys.stderr)
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    run("cmake", "-S", source, "-B", folder / "build", *OPTIONS, *launcher)
    run("cmake", "--build", folder / "build", "--parallel", jobs, "--target", "tungsten-app", "tungsten-path", "tungsten-photon")
    return folder / "build/bin/tungsten"


# ---- Films

def scene_file(scene, method, preset):
    kind, integrator = METHODS[method][0], scene.integrator
    photons = {"volume_photon_type": scene.slices if method == "slices" else method, "photon_count": 1000 if method == "slices" else 3000}
    chosen = {**COUNTS, **(photons if kind == PHOTONS else {})}
    if not {"transient_time_width", "temporal_response"} & integrator.keys():
        kind = kind.replace("transient_", "")
    if integrator.get("alpha") == 1:  # radii that never shrink are those of the maps that are not progressive
        kind = kind.replace("progressive_", "")
    darts = {"preset": preset, **scene.darts} if scene.darts and preset != "off" else preset
    return {"media": scene.media, "primitives": scene.primitives, "camera": scene.camera, **scene.blocks,
            "integrator": {"type": kind, "darts": darts, **chosen, **integrator}, "renderer": {"spp": 32, "spp_step": 16}}


def render(command, file, folder):
    """The film's arrays by name, and why there are none."""
    folder.mkdir()
    options = ["--quiet", "--no-frames", "-t", "1", "-s", "1", "-i", file.parent, "-d", folder, "-e", "film.npz"]
    environment = {name: value for name, value in os.environ.items() if name != "TUNGSTEN_PLUGIN_PATH"}
    try:
        done = subprocess.run([command, *options, file], capture_output=True, text=True, timeout=SECONDS, env=environment)
    except subprocess.TimeoutExpired:
        return {}, f"no end after {SECONDS} s"
    if done.returncode != 0:
        message = done.stderr.replace(str(folder), "").replace(str(file), "the scene").strip()
        return {}, f"{REFUSED if done.returncode == 1 else f'exit code {done.returncode}'}: {message}"
    if not (folder / "film.npz").exists():
        return {}, "no film"
    with np.load(folder / "film.npz") as film:
        return {name: film[name] for name in film.files if not name.startswith("metadata")}, ""


def compare_films(old, new, tolerance):
    """'alike', 'within' or 'differs', and what there is to say about it."""
    shapes = [{name: (array.shape, str(array.dtype)) for name, array in film.items()} for film in (old, new)]
    if shapes[0] != shapes[1]:
        return "differs", f"arrays were {shapes[0]} and are {shapes[1]}"
    largest = np.abs(np.nan_to_num(old["mean"])).max()
    changed = [name for name in old if old[name].tobytes() != new[name].tobytes()]
    said = []
    for name in changed:
        before, after, power = old[name].astype(float), new[name].astype(float), 2 if "error" in name else 1
        with np.errstate(all="ignore"):
            away = np.abs(after ** power - before ** power) / (largest or 1.0) ** power
        away = np.where((before == after) | (np.isnan(before) & np.isnan(after)), 0.0, np.nan_to_num(away, nan=np.inf, posinf=np.inf))
        if tolerance is None or away.max() > tolerance:
            where = np.unravel_index(np.argmax(away), away.shape)
            said.append(f"{np.sum(away > 0)} of {away.size} values of {name}{', squared,' * (power == 2)} by up to {away.max():.2g} of the "
                        f"largest mean, at [{', '.join(map(str, where))}] from {before[where]:.9g} to {after[where]:.9g}")
    return "differs" if said else "within" if changed else "alike", "; ".join(said) or ("" if largest else "black")


def compare(commands, tolerance, folder, scene, method, preset):
    """What compare_films() says, or 'refused' and why; and seconds."""
    begun = time.monotonic()
    file = folder / f"{scene.name}-{method}-{preset}.json"
    file.write_text(json.dumps(scene_file(scene, method, preset), default=lambda matrix: matrix.ravel().tolist()))
    outputs = [file.with_suffix(f".{number}") for number in range(2)]
    (old, why), (new, why_after) = map(render, commands, (file, file), outputs)
    for output in outputs:
        shutil.rmtree(output)
    if not why and not why_after:
        verdict = compare_films(old, new, tolerance)
    elif why == why_after and why.startswith(REFUSED):
        verdict = "refused", why.removeprefix(f"{REFUSED}: ")
    else:
        verdict = "differs", f"{why or 'a film'} before, {why_after or 'a film'} after"
    return *verdict, time.monotonic() - begun


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("builds", nargs="*", metavar="BEFORE AFTER", help="tungsten commands, build folders, revisions or `tree`")
    parser.add_argument("--tolerance", type=float, help="relative differences that pass, such as 1e-6 (default: none)")
    parser.add_argument("--only", default="", metavar="PATTERN", help="names that hold this regular expression, such as glass.*/best")
    parser.add_argument("--jobs", type=int, default=2, help="renders, or compilers, at a time (2)")
    parser.add_argument("--list", action="store_true", help="names of the renders, without rendering them")
    parser.add_argument("--verbose", action="store_true", help="a line for every render, with its seconds and whether its film is black")
    given = parser.parse_args()
    if len(given.builds) != 2 and not given.list:
        parser.error("two builds are needed, BEFORE and AFTER")
    if given.jobs < 1 or not (given.tolerance or 0) >= 0:
        parser.error("--jobs is at least 1, and --tolerance at least 0")
    try:
        given.renders = {name: (scene, method, preset) for scene in scenes() for method, (_, presets) in METHODS.items()
                         for preset in presets if re.search(given.only, name := f"{scene.name}/{method}/{preset}")}
    except re.error as error:
        parser.error(f"--only: {error}")
    if not given.renders:
        parser.error("no render has such a name (--list)")
    return given


def main():
    given = arguments()
    if given.list:
        print(*given.renders, sep="\n")
        return 0
    try:
        commands = [command_of(name, given.jobs) for name in given.builds]
    except CannotBuild as error:
        print(f"error: {error}", file=sys.stderr)
        return 2
    counts = Counter()
    with tempfile.TemporaryDirectory() as folder, ThreadPoolExecutor(given.jobs) as pool:
        write_assets(Path(folder))
        verdicts = pool.map(lambda parts: compare(commands, given.tolerance, Path(folder), *parts), given.renders.values())
        for name, (verdict, said, seconds) in zip(given.renders, verdicts):
            counts[verdict] += 1
            if verdict == "differs" or given.verbose:
                print(f"{name} {verdict}{': ' * bool(said)}{said}{f' ({seconds:.2f} s)' * given.verbose}", flush=True)
    within = f" {counts['within']} within {given.tolerance:g}," if given.tolerance is not None else ""
    print(f"{counts.total()} renders, {counts['alike']} bit for bit,{within} {counts['differs']} differ, {counts['refused']} refused alike")
    if not counts["differs"] and 4 * counts["refused"] > counts.total():  # as without plugins
        print("error: too many are refused to judge by the others; --verbose says why", file=sys.stderr)
        return 2
    return int(counts["differs"] > 0)


if __name__ == "__main__":
    sys.exit(main())
