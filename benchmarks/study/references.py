"""References of a study's own: the mean of long renders by the method that a scene names (reference_by)."""

import dataclasses

import numpy as np

import measures
from images import read_exr, write_pfm
from runs import plan, run_all
from study_file import StudyError

SECONDS, SEEDS = 60, 4  # of one reference, if nothing else is asked for


def _runs_of(study, scene, work):
    """Long renders of one scene, in a folder of their own beside the study's."""
    alone = dataclasses.replace(study, scenes=[dataclasses.replace(scene, skip={})], methods=[scene.reference_by])
    return alone, plan(alone, work / "references")


def average(images, block):
    """Mean of independent renders (at least two), and the mean variance of its block means over the image."""
    blocks = np.array([measures.block_means(measures.grey(image), block) for image in images])
    return np.mean(images, axis=0), float(np.mean(blocks.var(axis=0, ddof=1)) / len(images))


def render_references(study, work, tungsten, retry_failed, accept_warnings, say=print):
    """Renders what is missing and writes each reference as a PFM with NAME.blockvar beside it. The study's times and seeds
    are those of the references. Returns the scenes that have none because their renders failed."""
    failed = []
    for scene in study.scenes:
        if scene.reference_by is None:
            raise StudyError(f"scene '{scene.name}' does not say how its reference is rendered (reference_by)")
        if scene.reference.suffix != ".pfm" or study.seeds < 2:
            raise StudyError(f"scene '{scene.name}': references are rendered as .pfm, from at least 2 seeds")
        alone, runs = _runs_of(study, scene, work)
        run_all(alone, runs, tungsten, retry_failed, accept_warnings, say)
        if any((record := run.record())["error"] or record["skipped"] for run in runs):
            failed.append(scene.name)
            continue
        image, variance = average([read_exr(run.folder / "image.exr")[""] for run in runs], study.block)
        scene.reference.parent.mkdir(parents=True, exist_ok=True)
        write_pfm(scene.reference, image)
        scene.reference.with_suffix(".blockvar").write_text(f"{variance!r}\n")
        say(f"{scene.reference}: noise of a block {np.sqrt(variance) / image.mean():.2%} of the mean")
    return failed
