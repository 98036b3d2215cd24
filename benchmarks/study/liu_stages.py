#!/usr/bin/python3
"""Memory and CPU time by stage of sliced primitives in the scenes of data/scenes, from the renderer's statistics.

usage: liu_stages.py FOLDER [TABLE.md]      renders go to FOLDER; one pass each, one thread
"""
import json
import pathlib
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parents[2]
TYPES = ["planes", "volumes", "balls", "mis_volumes_balls", "hypervolumes"]
STAGES = ["photon pass", "sensor record", "build", "splat", "sensor pass"]
RECORD_BYTES = 104  # sizeof(CollapsedFlights)
# Scene: resolution; moment, which is the middle of a gate of 0.1 as well. Without the camera's leg.
SCENES = {
    "fogged-box": ("144x144", 1.6),
    "laser-in-fog": ("160x120", 1.8),
    "amber-half-space": ("160x90", 2.4),
    "volumetric-caustic": ("160x90", 2.45),
}
GATES = {"delta": ["delta_time_gate=true"], "box": ["delta_time_gate=false", "transient_time_width=0.1"]}
FRAMES = [1, 10, 50]


def render(folder, scene, resolution, settings):
    """Statistics of one pass."""
    stats = folder / "stats.json"
    command = [ROOT / "build/bin/tungsten", ROOT / "data/scenes" / scene / "scene.json", "--restart", "--quiet", "--threads", "1",
               "--spp", "1", "--output-directory", folder, "--hdr-output-file", "image.pfm", "--stats", stats,
               "--resolution", resolution, "--set", "integrator.type=progressive_transient_photon_map"]
    for setting in ["darts=off"] + settings:
        command += ["--set", f"integrator.{setting}"]
    subprocess.run(command, check=True)
    return json.loads(stats.read_text())


def stage_rows(folder):
    for scene, (resolution, moment) in SCENES.items():
        for gate, settings in GATES.items():
            for kind in TYPES:
                common = ["camera_unwarped=true", f"transient_time_center={moment}", f"volume_photon_type={kind}"]
                found = render(folder, scene, resolution, settings + common)
                records = found["counters"]["sliced primitives"]
                times = [found["stages"].get(stage, {}).get("CPU seconds", 0.0) for stage in STAGES]
                yield [scene, gate, kind, str(records), f"{records * RECORD_BYTES / 1e6:.1f}",
                       f"{found['peak memory bytes'] / 1e6:.0f}"] + [f"{1e3 * t:.0f}" for t in times]


def film_rows(folder):
    for kind in TYPES:
        times = []
        for frames in FRAMES:
            settings = [f"volume_photon_type={kind}", "camera_unwarped=true", "delta_time_gate=false", f"frame_num={frames}",
                        "start_time=0.1", f"transient_time_width={5 / frames}", "include_surfaces=false",
                        "volume_photon_count=2000"]
            found = render(folder, "fogged-box", "96x96", settings)
            times.append(f"{found['stages']['splat']['CPU seconds']:.2f}")
        yield [kind] + times


def table(header, rows):
    yield "| " + " | ".join(header) + " |"
    yield "| " + " | ".join("---" for _ in header) + " |"
    for row in rows:
        yield "| " + " | ".join(row) + " |"


def main():
    if len(sys.argv) not in (2, 3) or sys.argv[1].startswith("-"):
        sys.exit(__doc__)
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    lines = ["# Sliced primitives: memory and time by stage", "",
             "One plain pass at each scene's own counts, `camera_unwarped`, one thread, `benchmarks/study/liu_stages.py FOLDER TABLE.md`. MB: of the records, and",
             "peak of the process. Stages in ms of CPU time.", ""]
    lines += table(["scene", "gate", "type", "records", "records, MB", "peak, MB"] + STAGES, stage_rows(folder))
    lines += ["", "CPU seconds that drawing takes for 2000 records of fogged-box (96x96, no surfaces) over the same 5 units of time:", ""]
    lines += table(["type"] + [f"{n} frame{'s' if n > 1 else ''}" for n in FRAMES], film_rows(folder))
    text = "\n".join(lines) + "\n"
    if len(sys.argv) == 3:
        pathlib.Path(sys.argv[2]).write_text(text)
    else:
        sys.stdout.write(text)


if __name__ == "__main__":
    main()
