"""Renders of many small scenes by one process of the renderer, for tests in Python."""

import json
import subprocess
from pathlib import Path

import numpy as np


def render_all(tungsten, folder, scenes, *options):
    """Renders `scenes` (a list) in their order and returns of each the film (frames, height, width, 3) and its metadata."""
    folder, files = Path(folder), []
    for i, scene in enumerate(scenes):
        renderer = {**scene.get("renderer", {}), "output_file": f"{i}.png", "hdr_output_file": f"{i}.npy"}
        files.append(folder / f"{i}.json")
        files[-1].write_text(json.dumps({**scene, "renderer": renderer}))
        (folder / f"{i}.npy").unlink(missing_ok=True)
    done = subprocess.run([tungsten, "--quiet", "-d", str(folder), *options, *map(str, files)], capture_output=True, text=True)
    if done.returncode != 0:
        raise AssertionError(f"exit code {done.returncode}: {done.stderr}")
    return [(np.load(folder / f"{i}.npy").astype(float), json.loads((folder / f"{i}.npy.json").read_text())) for i in range(len(files))]
