#!/usr/bin/python3
"""Every integrator and primitive renders a small scene, plain and guided: for builds with sanitizers, under which the estimators' own tests
take too long. The renderer is named by the environment's TUNGSTEN."""

import copy
import json
import os
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path[:0] = [str(Path(__file__).resolve().parents[1] / folder) for folder in ("kills", "nasty")]
from kills_test import COUNTS, FRAMES, TUNGSTEN, scene, scenes  # noqa: E402
from nasty_cases import cube, glass_ball  # noqa: E402

TRANSIENT = "progressive_transient_photon_map"
RESPONSE = {"temporal_response": {"times": [2, 3, 4], "values": [0, 1, 0]}}


def small_scenes():
    listed = scenes()
    for primitive in ("points", "beams", "planes", "volumes", "balls", "hypervolumes", "mis_volumes_balls"):
        for darts in ("off", "best"):
            listed[f"{primitive}, {darts}"] = scene(TRANSIENT, darts=darts, volume_photon_type=primitive, **COUNTS)
    for darts in ("off", "best"):
        listed[f"paths, frames, {darts}"] = scene("path_tracer", darts=darts, **FRAMES)
        listed[f"delta gate, {darts}"] = scene(TRANSIENT, darts=darts, delta_time_gate=True, **COUNTS)
        listed[f"unwarped, {darts}"] = scene("path_tracer", darts=darts, camera_unwarped=True)
        response = scene("path_tracer", darts=darts, **RESPONSE)
        for name in ("transient_time_center", "transient_time_width"):
            del response["integrator"][name]
        listed[f"response, {darts}"] = response
    for name in ("path_tracer", "light_tracer, frames", "points, best", "beams, best"):
        glass = copy.deepcopy(listed[name])
        glass["primitives"] += [glass_ball(0.3), cube("mist", (0, 1, 0.4), 0.5, inner="fog")]
        listed[f"{name}, glass"] = glass
    return listed


def main():
    failed = []
    with tempfile.TemporaryDirectory() as folder:
        for number, (name, made) in enumerate(small_scenes().items()):
            file = Path(folder) / f"{number}.json"
            made["renderer"] = {"spp": 4, "spp_step": 2, "output_file": f"{number}.png"}
            file.write_text(json.dumps(made))
            done = subprocess.run([TUNGSTEN, "--quiet", "-t", "2", "-d", folder, str(file)], capture_output=True, text=True,
                                  env={"UBSAN_OPTIONS": "print_stacktrace=1", **os.environ})
            if done.returncode != 0 or "runtime error" in done.stderr:
                failed.append(name)
                print(f"{name}: exit code {done.returncode}: {done.stderr[-3000:]}")
    print(f"{len(small_scenes())} scenes, failed: {failed or 'none'}")
    sys.exit(bool(failed))


if __name__ == "__main__":
    main()
