"""Memory and CPU time by stage of sliced primitives in the scenes of data/scenes."""

from darts_bench.program import MAP, Bench, Scene

TITLE = "Sliced primitives: memory and time by stage"
TYPES = ["planes", "volumes", "balls", "mis_volumes_balls", "hypervolumes"]
STAGES = ["photon pass", "camera record", "build", "splat", "camera pass"]
RECORD_BYTES = 104  # sizeof(SliceRecord)
# Scene: resolution; moment, which is the middle of a gate of 0.1 as well. Without the camera's leg.
SCENES = {"fogged-box": ((144, 144), 1.6), "laser-in-fog": ((160, 120), 1.8), "amber-half-space": ((160, 90), 2.4),
          "volumetric-caustic": ((160, 90), 2.45)}
GATES = {"delta": ["delta_time_gate=true"], "box": ["delta_time_gate=false", "transient_time_width=0.1"]}
FRAMES = [1, 10, 50]


def rendered(bench, name, resolution, settings):
    """Statistics of one plain pass."""
    scene = Scene(name, Scene.own(name, 0).file, resolution)
    return bench.render(scene, [MAP, *(f"integrator.{setting}" for setting in ["darts=off", "camera_unwarped=true", *settings])], passes=1).stats


def stage_rows(bench):
    for scene, (resolution, moment) in list(SCENES.items())[:bench.short(4, 2)]:
        for gate, settings in GATES.items():
            for kind in TYPES:
                found = rendered(bench, scene, resolution, [*settings, f"transient_time_center={moment}", f"volume_photon_type={kind}"])
                records = found["counters"]["sliced primitives"]
                times = [found["stages"].get(stage, {}).get("CPU seconds", 0.0) for stage in STAGES]
                yield [scene, gate, kind, records, f"{records * RECORD_BYTES / 1e6:.1f}", f"{found['peak memory bytes'] / 1e6:.0f}",
                       *(f"{1e3 * t:.0f}" for t in times)]


def film_rows(bench):
    for kind in TYPES:
        films = [[f"volume_photon_type={kind}", "delta_time_gate=false", f"frame_num={frames}", "start_time=0.1", f"transient_time_width={5 / frames}",
                  "include_surfaces=false", "volume_photon_count=2000"] for frames in FRAMES]
        yield [kind, *(f"{rendered(bench, 'fogged-box', (96, 96), film)['stages']['splat']['CPU seconds']:.2f}" for film in films)]


def run(bench: Bench):
    bench.write(TITLE, "One plain pass at each scene's own counts, `camera_unwarped`, one thread. MB: of the records, and peak of the process. Stages in "
                "ms of CPU time: " + bench.keep("stages", ["scene", "gate", "type", "records", "records, MB", "peak, MB", *STAGES], stage_rows(bench)) + ".",
                "CPU seconds that drawing takes for 2000 records of fogged-box (96x96, no surfaces) over the same 5 units of time, by number of frames: "
                + bench.keep("frames", ["type", *FRAMES], film_rows(bench)) + ".")
