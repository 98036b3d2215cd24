#!/usr/bin/python3
"""Renders that are killed (SIGKILL) at random moments of rendering, checkpointing and writing, and gone on with until they are killed
again: after each kill every file under a final name is whole, and the render that is let finish shows what an uninterrupted one does.
Then pairs of renders that write the same files at once. `--kills N` in all; the renderer is named by the environment's TUNGSTEN."""

import argparse
import copy
import json
import os
import random
import struct
import subprocess
import sys
import tempfile
import time
import zipfile
import zlib
from pathlib import Path

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "nasty"))
from nasty_cases import room  # noqa: E402

TUNGSTEN = os.environ.get("TUNGSTEN", str(Path(__file__).resolve().parents[2] / "build/bin/tungsten"))
MEMORY = "/dev/shm" if os.access("/dev/shm", os.W_OK) else None  # every write is brought to the disk
FAST = ("path_tracer", "light_tracer, frames", "points, guided, frames")
KILLS_OF_A_RENDER = 5  # before it is let finish
FRAMES = {"start_time": 1.0, "transient_time_width": 0.5, "frame_num": 6}
COUNTS = {"photon_count": 400, "volume_photon_count": 400, "gather_photon_count": 50, "fixed_volume_radius": True}


def scene(kind, **integrator):
    """Small, and long enough to be killed: the room of the hard scenes."""
    made = room()
    made["camera"]["resolution"] = [12, 10]
    made["integrator"] = {"type": kind, "max_bounces": 8, "transient_time_center": 3.0, "transient_time_width": 2.0, **integrator}
    if "frame_num" in integrator:
        del made["integrator"]["transient_time_center"]
    if kind in ("photon_map", "progressive_photon_map"):
        for name in ("transient_time_center", "transient_time_width"):
            del made["integrator"][name]
    made["renderer"] = {"spp": 64, "spp_step": 1, "output_file": "film.png", "hdr_output_file": "film.npz", "enable_resume_render": True}
    return made


def scenes():
    """Every integrator, one gate and frames, plain and guided."""
    transient = "progressive_transient_photon_map"
    return {
        "path_tracer": scene("path_tracer", darts="off"),
        "path_tracer, guided, frames": scene("path_tracer", darts="best", **FRAMES),
        "transient_path_tracer": scene("transient_path_tracer", darts="best"),
        "light_tracer, frames": scene("light_tracer", **FRAMES),
        "transient_light_tracer": scene("transient_light_tracer"),
        "photon_map": scene("photon_map", **COUNTS),
        "progressive_photon_map": scene("progressive_photon_map", **COUNTS),
        "transient_photon_map, points": scene("transient_photon_map", darts="off", volume_photon_type="points", **COUNTS),
        "points, guided, frames": scene(transient, darts="best", volume_photon_type="points", **COUNTS, **FRAMES),
        "beams, guided": scene(transient, darts="best", volume_photon_type="beams", **COUNTS),
        "planes": scene(transient, darts="off", volume_photon_type="planes", **COUNTS),
    }


def require(promise, what):
    if not promise:
        raise AssertionError(what)


def require_whole_png(file):
    data, at, last = file.read_bytes(), 8, b""
    require(data[:8] == b"\x89PNG\r\n\x1a\n", f"{file}: no PNG")
    while at < len(data):
        size, last = struct.unpack(">I", data[at:at + 4])[0], data[at + 4:at + 8]
        require(zlib.crc32(data[at + 4:at + 8 + size]) == struct.unpack(">I", data[at + 8 + size:at + 12 + size])[0], f"{file}: damaged")
        at += 12 + size
    require(last == b"IEND" and at == len(data), f"{file}: cut")


def require_whole_exr(file):
    """The tables of blocks are complete, and the last block ends where the file does."""
    data, at, blocks = file.read_bytes(), 8, 0
    require(data[:4] == b"\x76\x2f\x31\x01", f"{file}: no EXR")
    parts = data[5] & 0x10 != 0
    while data[at]:
        compression, window = 0, (0, 0, 0, 0)
        while data[at]:
            name, kind = data[at:at + 600].split(b"\0", 2)[:2]
            at += len(name) + len(kind) + 2
            size = struct.unpack("<I", data[at:at + 4])[0]
            value = data[at + 4:at + 4 + size]
            compression = value[0] if name == b"compression" else compression
            window = struct.unpack("<4i", value) if name == b"dataWindow" else window
            at += 4 + size
        blocks += -(-(window[3] - window[1] + 1) // {0: 1, 1: 1, 2: 1, 3: 16, 4: 32, 5: 16}[compression])
        at += parts
        if not parts:
            break
    offsets = struct.unpack(f"<{blocks}Q", data[at + 1:at + 1 + 8 * blocks])
    start = 8 if parts else 4  # of a block: its part and line, or its line, then its size
    ends = [o + start + 4 + struct.unpack("<I", data[o + start:o + start + 4])[0] for o in offsets]
    require(min(offsets) > at and max(ends) == len(data), f"{file}: cut")


def require_whole(folder):
    """Returns how many images were there."""
    images = 0
    for file in folder.iterdir():
        if file.name.startswith(".tungsten-") and file.suffix == ".tmp":
            continue  # of a killed writer: removed by a later render
        images += file.suffix in (".png", ".npz", ".exr")
        if file.suffix == ".png":
            require_whole_png(file)
        elif file.suffix == ".exr":
            require_whole_exr(file)
        elif file.suffix == ".npz":
            require(zipfile.ZipFile(file).testzip() is None, f"{file}: damaged")
    return images


def start(file, folder, *options):
    return subprocess.Popen([TUNGSTEN, "--quiet", "-t", "1", "-d", str(folder), "-c", "1ms", *options, str(file)],
                            stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)


def finished(process):
    errors = process.communicate()[1]
    require(process.returncode == 0, f"exit code {process.returncode}: {errors}")
    require("damaged" not in errors and "truncated" not in errors, errors)
    return errors


def film_of(folder):
    film = np.load(folder / "film.npz")
    return film["mean"].astype(float), film["standard_error"].astype(float)


def same(name, found, expected):
    for ours, theirs in zip(found, expected):
        apart = np.nanmax(np.abs(ours - theirs)) / max(np.nanmax(np.abs(theirs)), 1e-30)
        require(apart == 0 or ("path" not in name and apart < 1e-5), f"{name}: resumed and uninterrupted are {apart} apart")


def kill_and_resume(name, folder, kills, random_number, totals):
    """Kills and goes on, at random moments of what the rest of the render takes; then lets it finish."""
    file = folder / "scene.json"
    options = ["-e", "film.exr"] if random_number.random() < 0.3 else []
    whole, out = folder / "whole", folder / f"out{totals['renders']}"
    if not (whole / "film.npz").exists():
        begun = time.monotonic()
        finished(start(file, whole))
        totals["seconds"] = time.monotonic() - begun
    state = out / "filmState.dat"
    for kill in range(kills):
        process = start(file, out, *options)
        while kill == kills - 1 and not state.exists() and process.poll() is None:
            time.sleep(1e-3)
        time.sleep(random_number.uniform(0.0, totals["seconds"] * random_number.choice([0.4, 0.9])))
        totals["kills"] += process.poll() is None
        process.kill()
        process.communicate()
        if out.exists():
            totals["images"] += require_whole(out)
    totals["resumed"] += state.exists()
    finished(start(file, out, *options))
    finished(start(file, out))  # the film as .npz too, if it was .exr: the state is complete or gone
    require_whole(out)
    same(name, film_of(out), film_of(whole))
    totals["renders"] += 1


def two_at_once(folder, file, rounds, random_number):
    """Two seeds into the same files: each file is one of theirs, whole."""
    expected = {}
    for seed in ("1", "2"):
        finished(start(file, folder / f"seed{seed}", "-s", seed, "-r"))
        expected[seed] = film_of(folder / f"seed{seed}")[0]
    both = folder / "both"
    for _ in range(rounds):
        pair = []
        for seed in ("1", "2"):
            pair.append(start(file, both, "-s", seed, "-r"))
            time.sleep(random_number.uniform(0, 0.02))
        errors = [process.communicate()[1] for process in pair]
        for process, error in zip(pair, errors):
            require(process.returncode == 0, f"exit code {process.returncode}: {error}")
        require_whole(both)
        found = film_of(both)[0]
        require(any((found == film).all() for film in expected.values()), "the film is of neither render")


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--kills", type=int, default=500)
    parser.add_argument("--fast", action="store_true", help="three of the scenes")
    parser.add_argument("--disk", action="store_true", help="in the folder for temporary files, rather than in memory")
    parser.add_argument("--rounds", type=int, default=20, help="pairs of renders into the same files")
    parser.add_argument("--seed", type=int, default=20261123)
    arguments = parser.parse_args()
    random_number = random.Random(arguments.seed)
    listed = {name: made for name, made in scenes().items() if name in FAST or not arguments.fast}
    each = -(-arguments.kills // len(listed))
    totals = {"kills": 0, "images": 0, "renders": 0, "resumed": 0, "seconds": 0.0}
    for name, made in listed.items():
        with tempfile.TemporaryDirectory(dir=None if arguments.disk else MEMORY) as folder:
            (Path(folder) / "scene.json").write_text(json.dumps(made))
            before, left = copy.copy(totals), each
            while left > 0:
                kill_and_resume(name, Path(folder), min(left, KILLS_OF_A_RENDER), random_number, totals)
                left -= KILLS_OF_A_RENDER
            print(f"{name}: {totals['kills'] - before['kills']} kills, {totals['resumed'] - before['resumed']} of "
                  f"{totals['renders'] - before['renders']} renders resumed", flush=True)
            if name == "path_tracer":
                two_at_once(Path(folder), Path(folder) / "scene.json", arguments.rounds, random_number)
    print(f"{totals['kills']} kills, {totals['images']} images looked at")
    sys.exit(totals["resumed"] == 0)


if __name__ == "__main__":
    main()
