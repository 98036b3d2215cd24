#!/usr/bin/python3
"""What it costs that kernels end at surfaces: CPU seconds of as many passes with and without, in turns, and variances.

usage: cost.py TUNGSTEN SCENE.json... [--seconds 3] [--seeds 2] [--methods points,beams] [--set FIELD=VALUE]..."""

import argparse
import json
import os
import subprocess
import tempfile

import numpy as np


def render(args, scene, method, ends, seed, passes):
    with tempfile.TemporaryDirectory() as folder:
        out = os.path.join(folder, "image.npz")
        settings = {"integrator.type": "transient_photon_map", "integrator.volume_photon_type": method, "renderer.spp_step": 1, "integrator.boundary_kernels": ends}
        command = [args.tungsten, scene, "--quiet", "--no-frames", "-t", "1", "-s", str(seed), "-d", folder, "-e", out, "--allow-outside"]
        command += ["--spp", str(passes)] if passes else ["--timeout", f"{args.seconds}s", "--spp", "100000000"]
        for text in [f"{key}={value}" for key, value in settings.items()] + args.set:
            command += ["--set", text]
        subprocess.run(command, capture_output=True, text=True, check=True)
        result = np.load(out)
        statistics = json.loads(bytes(result["metadata.json"]))["statistics"]
        return np.square(result["standard_error"].astype(float)).mean(), statistics["stages"]["passes"]["CPU seconds"], statistics["passes"]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tungsten")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--seconds", type=float, default=3, help="that the passes without take, of the wall's clock")
    parser.add_argument("--seeds", type=int, default=2)
    parser.add_argument("--methods", default="points,beams")
    parser.add_argument("--set", action="append", default=[], help="of the scenes, as the command has it")
    args = parser.parse_args()
    for scene in args.scenes:
        for method in args.methods.split(","):
            passes = max(2, render(args, scene, method, "false", 1, 0)[2])
            pairs = [[render(args, scene, method, ends, seed, passes) for ends in ("false", "true")] for seed in range(1, args.seeds + 1)]
            variance, cpu = (np.sum([pair[1][k] for pair in pairs]) / np.sum([pair[0][k] for pair in pairs]) for k in (0, 1))
            print(f"{os.path.basename(scene):30} {method:7} {passes:5d} passes: CPU x {cpu:.3f}, variance x {variance:.3f}", flush=True)


if __name__ == "__main__":
    main()
