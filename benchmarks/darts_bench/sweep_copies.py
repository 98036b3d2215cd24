"""Copies of a scene that must look the same: in other units of length and time, or turned and moved as a whole."""

import copy
from dataclasses import replace

import numpy as np

from darts_bench.scene_words import SweepScene, rotation_about

# Powers of length and time in a field's unit.
DIMENSIONS = {
    "media": {"sigma_s": (-1, 0), "sigma_a": (-1, 0), "speed_of_light": (1, -1)},
    "primitives": {"emission_time": (0, 1), "radius": (1, 0), "int_speed_of_light": (1, -1), "ext_speed_of_light": (1, -1)},
    "camera": {"orthographic_size": (1, 0), "focus_distance": (1, 0), "aperture_size": (1, 0)},
    "integrator": {"vaccum_speed_of_light": (1, -1), "transient_time_center": (0, 1), "transient_time_width": (0, 1),
                   "start_time": (0, 1), "center": (0, 1), "sigma": (0, 1), "start": (0, 1), "end": (0, 1), "times": (0, 1)},
}
INTENSITIES = ("point", "spot", "directional_point")  # their emission is per area of a distant sphere


def scaled(scene: SweepScene, length, time):
    """The scene in units that make its lengths and times longer by factors, with light as bright as to show the same image:
    a gate that is open for longer averages the same pulse over more time."""
    keeps_brightness = scene.steady or scene.integrator.get("time_normalization") == "integral"
    brighter = 1.0 if keeps_brightness else time
    parts = {section: _rescaled(getattr(scene, section), dimensions, length, time)
             for section, dimensions in DIMENSIONS.items()}
    for primitive in parts["primitives"]:
        primitive["transform"] = np.diag([length, length, length, 1.0]) @ primitive["transform"]
        area = length**2 if primitive["type"] in INTENSITIES else 1.0
        _multiply(primitive, "emission", brighter * area)
        _multiply(primitive, "power", brighter * length**2)
        _scale_bumps(primitive.get("bsdf", {}), length)
    lens = parts["camera"]["transform"] = parts["camera"]["transform"].copy()
    lens[:3, 3] *= length
    return replace(scene, radius=scene.radius * length, unit=scene.unit * length, **parts)


def moved(scene: SweepScene, degrees=40.0, axis=(1.0, 2.0, -0.5), offset=(3.0, -5.0, 2.0)):
    """The scene turned as a whole, then moved by an offset in its own unit."""
    motion = np.eye(4)
    motion[:3, :3] = rotation_about(axis, degrees)
    motion[:3, 3] = np.multiply(offset, scene.unit)
    primitives = [{**p, "transform": motion @ p["transform"]} for p in scene.primitives]
    return replace(scene, primitives=primitives, camera={**scene.camera, "transform": motion @ scene.camera["transform"]})


def _rescaled(value, dimensions, length, time):
    """A copy of JSON values whose fields have `dimensions`."""
    if isinstance(value, list):
        return [_rescaled(entry, dimensions, length, time) for entry in value]
    if not isinstance(value, dict):
        return copy.copy(value)
    result = {key: _rescaled(entry, dimensions, length, time) for key, entry in value.items()}
    for key, (of_length, of_time) in dimensions.items():
        _multiply(result, key, length**of_length * time**of_time)
    return result


def _multiply(fields, key, factor):
    """A number, all of a list, or a texture by its own scale."""
    value = fields.get(key)
    if isinstance(value, dict):
        fields[key] = {**value, "scale": value.get("scale", 1.0) * factor}
    if isinstance(value, list):
        fields[key] = [entry * factor for entry in value]
    elif isinstance(value, (int, float)):
        fields[key] = value * factor


def _scale_bumps(bsdf, length):
    """Heights are lengths, as the tangents that they tilt."""
    if "bump" in bsdf:
        bsdf["bump"] = {**bsdf["bump"], "scale": bsdf["bump"].get("scale", 1.0) * length}
    for child in bsdf.values():
        if isinstance(child, dict):
            _scale_bumps(child, length)
