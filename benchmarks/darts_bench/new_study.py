"""Writes a study of a scene of one's own: plain and best sampling, points and paths, and the reference that they are measured by."""

import json

from darts_bench.run import BenchError, film

MOST_SIDE, BLOCK = 160, 8  # pixels
SECONDS, SEEDS, THREADS = 10, 3, 2


def _side(pixels, longest):
    return max(round(pixels * min(MOST_SIDE / longest, 1) / BLOCK), 1) * BLOCK


def _gate(about):
    """[start, end] of the gate, and what makes one of a film; nothing in steady state."""
    time = about["time"]
    if time["kind"] == "steady state":
        return None, []
    if time["kind"] not in ("gate", "frames"):
        raise BenchError(f"a scene of a {time['kind']} has no image that means of blocks would suit: give it a gate")
    start, end = time["edges"][0], time["edges"][-1]
    whole = [] if time["kind"] == "gate" else ["integrator.frame_num=0", f"integrator.transient_time_center={(start + end) / 2!r}",
                                               f"integrator.transient_time_width={end - start!r}"]
    return [start, end], whole


def study_of(scene, tungsten):
    """The study as JSON; paths in it are absolute."""
    scene = scene.resolve()
    # What the renderer says about it, in the metadata of a tiny render.
    about = film(tungsten, scene, ["renderer.spp_step=1", "integrator.photon_count=1000", "integrator.volume_photon_count=1000"], passes=1).about
    gate, whole = _gate(about)
    kind = "transient_" if gate else ""
    points = [f"integrator.type=progressive_{kind}photon_map", "integrator.volume_photon_type=points"]
    paths = [f"integrator.type={kind}path_tracer"]
    methods = [{"name": "plain points", "set": [*points, "integrator.darts=off"]}, {"name": "plain paths", "set": [*paths, "integrator.darts=off"]}]
    if gate:  # nothing to aim at in steady state
        methods += [{"name": "best points", "set": [*points, "integrator.darts=best"]}, {"name": "best paths", "set": [*paths, "integrator.darts=best"]}]
    width, height = about["scene"].get("camera", {}).get("resolution", [1000, 563])
    longest = max(width, height)
    entry = {"name": scene.parent.name if scene.stem == "scene" else scene.stem, "path": str(scene),
             "resolution": [_side(width, longest), _side(height, longest)],
             "reference": str(scene.with_name(f"{scene.stem}-reference.pfm")), "reference_by": methods[-1]["name"]}
    if gate:
        entry["gate"] = gate
    if whole:
        entry["set"] = {"*": whole}
    return {"title": f"{entry['name']}: plain and best sampling at equal time", "scenes": [entry], "methods": methods,
            "definitions": {"methods": [methods[-1]]}, "baseline": methods[0]["name"], "seconds": SECONDS, "threads": THREADS,
            "seeds": SEEDS, "block": BLOCK}


def write_study(scene, tungsten):
    """Beside the scene, under a name that is free."""
    if not scene.is_file():
        raise BenchError(f"there is no scene {scene}")
    file = scene.with_name(f"{scene.stem}-study.json")
    if file.exists():
        raise BenchError(f"{file} is there already; remove it, or run it")
    file.write_text(json.dumps(study_of(scene, tungsten), indent=2) + "\n")
    return file
