#!/usr/bin/python3
"""What operations of paths and light paths cost: the tables `Nanoseconds` of src/path/Tuning.h and src/photon/Tuning.h, which pilots weigh
plain and guided paths by, fitted anew.

usage: costs.py TUNGSTEN SCENE.json... [--method paths|points|beams|mis_volumes_balls] [--seconds 2]

Every scene is rendered at a plain_share of 1, 0.5 and 0; CPU seconds are fitted by what counters say, least squares of relative errors, no cost
below 0. Give many scenes that differ: what always comes together (a vertex and its ray) is told apart by nothing else."""

import argparse
import json
import os
import subprocess
import tempfile

import numpy as np

#: Of what a counter, or a sum of some, counts in a render: (row of the table, counters).
WALK = [("vertex", ["medium events", "surface events"]), ("ray", ["rays", "shadow rays"]), ("controlVertex", ["control vertices"])]
PATHS = [*WALK, ("connection", ["connections"]), ("density", ["vertices with densities of guided paths"])]
PHOTONS = [("path", ["photons"]), *WALK, ("connection", ["surface connections"]), ("record", ["stored volume photons"]),
           ("density", ["flights with densities of guided paths"])]


def rendered(args, scene, share):
    """Counters and CPU seconds of a render, if one pass ended."""
    paths = args.method == "paths"
    settings = {"type": "transient_path_tracer"} if paths else {"type": "progressive_transient_photon_map", "volume_photon_type": args.method}
    settings["darts"] = json.dumps({"preset": "best", "plain_share": share})
    with tempfile.TemporaryDirectory() as folder:
        command = [args.tungsten, "--quiet", "-t", "1", "-d", folder, "--no-frames", "-e", "film.npz", "--allow-outside", "--spp", "100000000",
                   "--timeout", f"{args.seconds}s", scene]
        for name, value in settings.items():
            command += ["--set", f"integrator.{name}={value}"]
        if subprocess.run(command, stderr=subprocess.DEVNULL).returncode:
            return None  # not one pass ended in time
        with np.load(os.path.join(folder, "film.npz")) as film:
            statistics = json.loads(bytes(film["metadata.json"]))["statistics"]
    return statistics["counters"], statistics["process CPU seconds"]


def fitted(rows, seconds):
    """Least squares of relative errors with no negative result: the most negative one is left out until there is none."""
    rows, seconds = np.array(rows, float), np.array(seconds)
    used = [i for i in range(rows.shape[1]) if rows[:, i].any()]
    while used:
        found = np.linalg.lstsq(rows[:, used] / seconds[:, None], np.ones(len(seconds)), rcond=None)[0]
        if found.min() >= 0:
            return dict(zip(used, found))
        del used[int(found.argmin())]
    return {}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("tungsten")
    parser.add_argument("scenes", nargs="+")
    parser.add_argument("--method", choices=["paths", "points", "beams", "mis_volumes_balls"], default="paths")
    parser.add_argument("--seconds", type=float, default=2.0)
    args = parser.parse_args()
    table = PATHS if args.method == "paths" else PHOTONS
    for share, walks in ((1, "plain"), (0, "guided"), (0.5, "both")):
        rows, seconds = [], []
        for scene in args.scenes:
            found = rendered(args, scene, share)
            if not found:
                continue
            counters, cpu = found
            rows.append([sum(counters.get(name, 0) for name in added) for _, added in table])
            seconds.append(cpu)
        costs = fitted(rows, seconds)
        explained = np.array(rows, float) @ [costs.get(i, 0.0) for i in range(len(table))] / seconds
        print(f"{walks}: " + ", ".join(f"{table[i][0]} {1e9 * cost:.0f}" for i, cost in costs.items()) + f" ns; off by {np.std(explained):.2f} of the time")


if __name__ == "__main__":
    main()
