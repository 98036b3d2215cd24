"""What operations of paths and light paths cost: the tables `Nanoseconds` of src/path/Tuning.h and src/photon/Tuning.h, which pilots weigh
plain and guided paths by, and with --method passes `PassNanoseconds`, by which a pilot weighs volume primitives, fitted anew.

Every scene is rendered at a plain_share of 1, 0.5 and 0; CPU seconds are fitted by what counters say, least squares of relative errors, no cost
below 0. Give many scenes that differ: what always comes together (a vertex and its ray) is told apart by nothing else."""

import argparse
import json

import numpy as np

from darts_bench.run import BenchError, add_renderer, film, require_renderer

#: Of what a counter, or a sum of some, counts in a render: (row of the table, counters).
WALK = [("vertex", ["medium events", "surface events"]), ("ray", ["rays", "shadow rays"]), ("controlVertex", ["control vertices"])]
PATHS = [*WALK, ("connection", ["connections"]), ("point", ["points of emitters compared"]), ("density", ["vertices with densities of guided paths"])]
PHOTONS = [("path", ["photons"]), *WALK, ("connection", ["surface connections"]), ("record", ["stored volume photons"]),
           ("density", ["flights with densities of guided paths"])]
WALKS_OF_PASSES = [("path", ["photons"]), ("ray", ["rays"]), ("mediumEvent", ["medium events"]), ("surfaceEvent", ["surface events"]),
                   ("controlVertex", ["control vertices"]), ("connection", ["surface connections"]),
                   ("density", ["flights with densities of guided paths"])]
#: Of a primitive: counters of what is stored and gathered.
PRIMITIVES = {"points": ("stored volume photons", "gathered photons"), "beams": ("photon beams", "gathered beams"),
              "mis_volumes_balls": ("sliced primitives", "gathered slices")}


def rendered(options, scene, method, darts):
    """Counters and CPU seconds of the passes of a render, if one pass ended in time."""
    kind = ["type=transient_path_tracer"] if method == "paths" else ["type=progressive_transient_photon_map", f"volume_photon_type={method}"]
    try:
        found = film(options.tungsten, scene, [f"integrator.{value}" for value in (*kind, f"darts={json.dumps(darts)}")], seconds=options.seconds)
    except BenchError:
        return None
    return found.statistics["counters"], found.cpu


def fitted(rows, seconds, weights=1.0):
    """Least squares of relative errors with no negative result: the most negative one is left out until there is none."""
    if not len(rows):
        raise BenchError("not one render ended a pass in time: --seconds gives them more")
    rows, seconds = np.array(rows, float), np.array(seconds)
    weights = weights * np.ones(len(seconds))
    used = [i for i in range(rows.shape[1]) if rows[:, i].any()]
    while used:
        found = np.linalg.lstsq(rows[:, used] / seconds[:, None] * weights[:, None], weights, rcond=None)[0]
        if found.min() >= 0:
            return dict(zip(used, found))
        del used[int(found.argmin())]
    return {}


def fit_passes(options):
    """All primitives at once, as their walks cost alike: each has columns of its own for records."""
    names = [name for name, _ in WALKS_OF_PASSES]
    names += [f"{method}.{what}" for method in PRIMITIVES for what in ("stored", "ended", "splatted", "gathered")]
    rows, seconds = [], []
    for scene in options.scenes:
        for place, (method, (stored, gathered)) in enumerate(PRIMITIVES.items()):
            if not (found := rendered(options, scene, method, "best")):
                continue
            counters, cpu = found
            records, splatted = counters.get(stored, 0), counters.get("splatted records", 0)
            own = np.zeros(4 * len(PRIMITIVES))
            own[4 * place: 4 * place + 4] = [records, counters.get("kernels ended at surfaces", 0), splatted,
                                             counters.get(gathered, 0) - splatted]
            rows.append([sum(counters.get(name, 0) for name in added) for _, added in WALKS_OF_PASSES] + list(own))
            seconds.append(cpu)
    rows, seconds = np.array(rows), np.array(seconds)
    weights = np.ones(len(seconds))
    for _ in range(20):  # what no column tells, as rays in large meshes, counts the less the more it is off
        costs = fitted(rows, seconds, weights)
        off = np.log(np.maximum(rows @ [costs.get(i, 0.0) for i in range(len(names))] / seconds, 1e-3))
        weights = 1 / np.sqrt(1 + (off / 0.25) ** 2)
    print(", ".join(f"{names[i]} {1e9 * cost:.3g}" for i, cost in costs.items()) + f" ns; half of all renders are off by less than {np.median(np.abs(off)):.2f}")


def fit_walks(options):
    table = PATHS if options.method == "paths" else PHOTONS
    for share, walks in ((1, "plain"), (0, "guided"), (0.5, "both")):
        rows, seconds = [], []
        for scene in options.scenes:
            if found := rendered(options, scene, options.method, {"preset": "best", "plain_share": share}):
                counters, cpu = found
                rows.append([sum(counters.get(name, 0) for name in added) for _, added in table])
                seconds.append(cpu)
        costs = fitted(rows, seconds)
        explained = np.array(rows, float) @ [costs.get(i, 0.0) for i in range(len(table))] / seconds
        print(f"{walks}: " + ", ".join(f"{table[i][0]} {1e9 * cost:.0f}" for i, cost in costs.items()) + f" ns; off by {np.std(explained):.2f} of the time")


def main(arguments):
    parser = argparse.ArgumentParser(prog="bench.py costs", description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    add_renderer(parser)
    parser.add_argument("scenes", nargs="+", metavar="SCENE.json")
    parser.add_argument("--method", choices=["paths", *PRIMITIVES, "passes"], default="paths")
    parser.add_argument("--seconds", type=float, default=2.0)
    options = parser.parse_args(arguments)
    require_renderer(options.tungsten)
    (fit_passes if options.method == "passes" else fit_walks)(options)
