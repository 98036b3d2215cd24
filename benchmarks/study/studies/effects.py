"""What each effect costs: the same scene with and without its cause, by stage."""

import numpy as np

from darts_bench.plots import panels, plain_log, ranges
from darts_bench.program import PATHS, Bench, Scene
from darts_bench.run import BenchError

TITLE = "What effects cost"
REPEATS = 6
COUNTS = ["integrator.photon_count=60000", "integrator.volume_photon_count=30000"]
FEW = ["integrator.photon_count=20000", "integrator.volume_photon_count=5000"]
BEST, PLAIN = ["integrator.darts=best"], ["integrator.darts=off"]
BEAMS, SLICES = (["integrator.volume_photon_type=" + kind] for kind in ("beams", "mis_volumes_balls"))
VOLUME, LOOK = ["build", "splat"], ["camera record", "splat", "camera pass"]
PHOTONS, CAMERA = ["photon pass"], ["camera pass"]
STAGES = ["photon pass", "light paths", "camera record", "build", "splat", "path reuse", "camera pass", "bias"]
GREY = ["media.water.sigma_s=0.7", "media.water.sigma_a=0.04"]
CHECKER = 'bsdfs.white.albedo={"type":"checker","on_color":0.8,"off_color":0.6,"res_u":8,"res_v":8}'
# As the plan calls it; the scene; the stages that work for it; what both set; what has its cause; what has not.
EFFECTS = [
    ("medium scattering", "cornell-fog", PHOTONS + VOLUME + LOOK, COUNTS, [], ["media.fog.sigma_s=0"]),
    ("medium scattering", "cornell-fog", CAMERA, PATHS, [], ["media.fog.sigma_s=0"]),
    ("surface photons", "cornell-fog", PHOTONS + ["build", "camera pass"], COUNTS, [], ["integrator.include_surfaces=false"]),
    ("coloured media", "glass-tank", PHOTONS + VOLUME + LOOK, COUNTS, [], GREY),
    ("anisotropic scattering", "glass-tank", PHOTONS + VOLUME + LOOK, COUNTS, [], ['media.water.phase_function={"type":"isotropic"}']),
    ("refraction", "glass-tank", PHOTONS + VOLUME + LOOK, COUNTS, [], ['primitives.tank.bsdf={"type":"forward"}']),
    ("several speeds of light", "glass-tank", PHOTONS + VOLUME + LOOK, COUNTS, [], ["media.water.speed_of_light=1"]),
    ("specular camera subpaths", "mirror-fog", PHOTONS + VOLUME + LOOK, COUNTS, [], ["primitives.mirror.bsdf=plaster"]),
    ("frames", "two-pulses", VOLUME + LOOK, COUNTS, [], ["integrator.frame_num=1", "integrator.transient_time_width=5"]),
    ("emission times", "two-pulses", PHOTONS + VOLUME + LOOK, COUNTS, [], ["primitives.blue pulse.emission_time=0"]),
    ("pulses", "two-pulses", PHOTONS, COUNTS, ['primitives.blue pulse.pulse={"type":"exponential","decay":0.5}'], []),
    ("temporal response", "two-pulses", PHOTONS, COUNTS, ['integrator.temporal_response={"type":"gaussian","center":0.2,"sigma":0.1}'], []),
    ("coloured media", "two-peaks", PHOTONS + VOLUME + LOOK, COUNTS, [], ["media.fog.sigma_s=0.45"]),
    ("delta gate", "fogged-box", VOLUME + LOOK, FEW, [], ["integrator.delta_time_gate=false"]),
    ("sliced primitives", "fogged-box", PHOTONS + VOLUME, FEW, SLICES, BEAMS),
    ("photon beams", "laser-in-fog", PHOTONS + VOLUME, FEW, BEAMS, ["integrator.volume_photon_type=points"]),
    ("coloured media", "amber-half-space", PHOTONS + VOLUME + LOOK, FEW, [], ["media.amber.sigma_a=0.35"]),
    ("index-matched boundaries", "amber-half-space", PHOTONS + VOLUME + LOOK, FEW, [],
     ['primitives.surface.bsdf={"type":"dielectric","ior":1.3,"enable_refraction":true}']),
    ("refraction", "volumetric-caustic", PHOTONS + VOLUME + LOOK, FEW, [], ['primitives.ball.bsdf={"type":"lambert"}']),
    ("anisotropic scattering", "layered-tissue", CAMERA, PATHS + PLAIN, [],
     [f'media.{name}.phase_function={{"type":"isotropic"}}' for name in ("epidermis", "dermis", "fat")]),
    ("emission from surfaces", "cloud-in-haze", CAMERA, PATHS, [], ["primitives.lamp.type=point"]),
    ("textures", "cornell-fog", CAMERA, PATHS, [CHECKER], []),
    ("guided paths", "lamp-in-fog", CAMERA, PATHS, BEST, PLAIN),
    ("light vertices", "cornell-fog", ["light paths", *CAMERA], PATHS, BEST, ['integrator.darts={"preset":"best","surface_connections":false}']),
    ("guided light paths", "cornell-fog", PHOTONS + VOLUME + LOOK + ["path reuse"], COUNTS, BEST, PLAIN),
    ("surface connections", "cornell-fog", PHOTONS + ["path reuse", *LOOK], COUNTS, BEST,
     ['integrator.darts={"preset":"best","surface_connections":false}']),
    ("Russian roulette", "cornell-fog", CAMERA, PATHS + PLAIN, ["integrator.enable_rr=true"], []),
    ("bias", "cornell-fog", ["bias"], COUNTS, ["--bias"], []),  # no effect of the plan
]
NOISE = 0.05  # of a pass


def passes_of(settings):
    return 12 if "integrator.type=path_tracer" in settings else 4


def is_on(render, effect):
    if effect == "bias":
        return "bias" in render.stats["stages"]
    return any(e["name"] == effect and e["on"] for e in render.stats["effects"])


def rendered(bench, cells):
    """{key: [renders of the same]} of {key: (scene, settings)}, interleaved; words that begin with -- are options."""
    found = {key: [] for key in cells}
    for again in range(1, bench.short(REPEATS, 1) + 1):
        for key in list(cells)[::1 if again % 2 else -1]:
            scene, settings = cells[key]
            values, options = ([word for word in settings if word.startswith("--") == is_option] for is_option in (False, True))
            # The same seed: others would differ by more than the machine does.
            found[key].append(bench.render(scene, values, 1, passes=bench.short(passes_of(values), 2), options=options, again=again))
    return found


def times(renders):
    """CPU ms of a pass by stage, and in all: of each stage what it took in the render where it was disturbed least."""
    by_stage = {}
    for render in renders:
        # Not the stage "passes": it holds what writing the trace takes.
        found = {name: render.stats["stages"].get(name, {}).get("CPU seconds", 0.0) for name in STAGES}
        found["rest"] = render.cpu[-1] - sum(found.values())
        for name, seconds in found.items():
            by_stage[name] = min(by_stage.get(name, np.inf), 1e3 * seconds / render.passes[-1])
    return {"passes": sum(by_stage.values()), **by_stage}


def spread(renders):
    all_of = [render.cpu[-1] for render in renders]
    return max(all_of) / min(all_of) - 1


def row_of(effect, scene, own, renders):
    """A row, and (label, of the render without: total difference, that of its stages)."""
    (on, off), label = (times(one) for one in renders), f"{effect}, {scene}{', paths' if own == CAMERA else ''}"
    difference = on["passes"] - off["passes"]
    by_stage = {name: on[name] - off[name] for name in STAGES}
    mine = sum(by_stage[name] for name in dict.fromkeys(own))
    largest = sorted(by_stage, key=lambda name: -abs(by_stage[name]))[:3]
    told = ", ".join(f"{name} {by_stage[name]:+.1f}" for name in largest if abs(by_stage[name]) > 0.01 * off["passes"]) or "none"
    rest = (difference - mine) / max(on["passes"], off["passes"])
    return [effect, scene, f"{on['passes']:.1f}", f"{off['passes']:.1f}", f"{difference:+.1f}", f"{mine:+.1f}", f"{100 * rest:+.1f}",
            f"{on['passes'] / off['passes']:.2f}", told], (label, on["passes"] / off["passes"], rest)


def picture(bench, points):
    figure, axes = panels(1, 6.4, 5.6)
    points = sorted(points, key=lambda point: -point[1])
    ranges(axes[0], {label: {"ratio": (ratio, 1, ratio)} for label, ratio, _ in points}, "CPU seconds with the effect / without")
    plain_log(axes[0].xaxis)
    bench.plot(figure, bench.name)


def run(bench: Bench):
    side = bench.short(96, 16)
    chosen = EFFECTS if not bench.quick else EFFECTS[:3] + EFFECTS[-1:]
    cells = {(i, how): (Scene.own(scene, side), [*both, *values]) for i, (_, scene, _, both, with_it, without) in enumerate(chosen)
             for how, values in (("on", with_it), ("off", without))}
    found = rendered(bench, cells)
    rows, points, spreads = [], [], []
    for i, (effect, scene, own, *_) in enumerate(chosen):
        pair = found[i, "on"], found[i, "off"]
        if [is_on(one[0], effect) for one in pair] != [True, False]:
            raise BenchError(f"{scene}: {effect} is not on in the one render and off in the other")
        row, point = row_of(effect, scene, own, pair)
        rows.append(row)
        points.append(point)
        spreads += [spread(one) for one in pair]
    picture(bench, points)
    kept = sum(abs(rest) < NOISE for _, _, rest in points)
    elsewhere = "; ".join(f"{label} ({rest:+.0%})" for label, _, rest in points if abs(rest) >= NOISE) or "none"
    bench.write(TITLE, f"{len(chosen)} effects in {len(set(scene for _, scene, *_ in chosen))} scenes, {side} x {side} pixels: the scene with the effect's "
                "cause, and the same without it or with what does without it, one effect at a time. CPU ms of a pass; of "
                f"{bench.short(REPEATS, 1)} renders of the same passes, interleaved, every stage where it took least (renders differ by {np.median(spreads):.0%} in the "
                f"median, {max(spreads):.0%} at most, by what else the machine does). The plan of each render says that the effect is on and off.",
                f"The change is that of the effect's own stages to within {NOISE:.0%} of the time of a pass: {kept} of {len(points)}. Elsewhere: {elsewhere}. "
                "Effects that change the walks themselves (fog, glass, what scatters how) have all stages of light and sensor as theirs, those of "
                f"paths the camera pass; those with fewer stages ({', '.join(dict.fromkeys(effect for effect, _, own, *_ in chosen if own != CAMERA and not set(PHOTONS + VOLUME + LOOK) <= set(own)))}) are the "
                "harder test.",
                "![time with and without](effects.svg)",
                "All figures: " + bench.keep(bench.name, ["effect", "scene", "with, ms", "without, ms", "change, ms", "of its stages, ms", "elsewhere, % of a pass",
                                                          "ratio", "stages that changed most, ms"], rows) + ".")
