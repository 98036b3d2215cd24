"""From the folders of runs to figures: one summary per scene, method and time."""

import json
from dataclasses import dataclass, field
from pathlib import Path
from statistics import median

import numpy as np

from darts_bench import measures
from darts_bench.images import average_down, read_exr, read_pfm
from darts_bench.run import BenchError
from darts_bench.study_file import Scene, Study
from darts_bench.tables import STAGES


def read_reference(scene: Scene, block: int):
    """PFM with its block variance in NAME.blockvar, or EXR with a stderr layer of independent pixels."""
    error = None
    if scene.reference.suffix == ".exr":
        layers = read_exr(scene.reference)
        image, error = layers[""], layers.get("stderr")
    else:
        image = read_pfm(scene.reference)
    beside = scene.reference.with_suffix(".blockvar")
    if scene.reference_block_variance is not None:
        variance = float(scene.reference_block_variance)
    elif beside.exists():
        variance = float(beside.read_text())
    elif error is not None:
        variance = measures.block_variance_of_independent_pixels(error, block)
    else:
        raise BenchError(f"{scene.reference}: its noise is unknown; give reference_block_variance or {beside.name}")
    if image.shape[0] % block or image.shape[1] % block:
        raise BenchError(f"{scene.reference}: blocks of {block} pixels do not divide {image.shape[1]}x{image.shape[0]}")
    return measures.Truth(image, block_variance=variance)


@dataclass
class Summary:
    """Medians over seeds of one method at one time; noise and bias relative to the reference's mean."""

    scene: Scene
    method: object
    seconds: float
    seeds: int = 0
    passes: float = 0
    wall: float = 0.0  # of the passes
    cpu: float = 0.0  # of the passes, all threads
    std: float | None = None  # per pixel, from the renders' stderr layer
    std_range: tuple = ()
    std_spread: float | None = None  # per pixel, over the seeds
    std_averaged: float | None = None  # over the seeds, after averaging down to the reference's resolution
    bias: measures.Bias | None = None
    told_bias: tuple | None = None  # the renders' own estimate and its bound (--bias)
    relmse99: float | None = None  # these three at the reference's resolution, its noise in them
    median_error: float | None = None
    flip: float | None = None
    mean_ratio: float = 0.0
    mean_ratio_error: float | None = None
    memory: float = 0.0  # bytes, peak
    stages: dict = field(default_factory=dict)  # wall seconds
    non_finite: int = 0
    share: float = 0.0  # of the threads' time that the machine granted and the renderer used
    builds: set = field(default_factory=set)
    machines: set = field(default_factory=set)
    image: Path | None = None  # of the first seed
    average: np.ndarray | None = None  # over the seeds, at the reference's resolution
    failures: list = field(default_factory=list)
    missing: int = 0
    skipped: str | None = None  # why the renderer cannot

    @property
    def noise(self):
        """The stderr layer's figure; the seeds' spread where a render has only one pass."""
        return self.std if self.std is not None else self.std_spread

    @property
    def bias_squared(self):
        return self.bias.squared if self.bias else 0.0

    @property
    def mse(self):
        return None if self.noise is None else measures.mean_squared_error(self.noise, self.bias_squared)

    @property
    def cost(self):
        """MSE × CPU seconds: where there is no bias, the same for any time."""
        return None if self.mse is None else self.mse * self.cpu

    def gain_over(self, other, at_equal_cpu=False):
        """How many times smaller the MSE is than another summary's, whose variance is brought to this one's time: passes
        end late by different amounts. None where one of them has no noise figure."""
        if other is None or self.noise is None or other.noise is None:
            return None
        ratio = other.cpu / self.cpu if at_equal_cpu else other.wall / self.wall
        return measures.gain(other.noise, other.bias_squared, self.noise, self.bias_squared, ratio)

    def gain_over_published(self):
        """The same over the published implementation's figures, at equal CPU time; its unknown bias counts as zero."""
        published = self.scene.published
        row = published.row(self.method.published) if published and self.method.published else None
        if row is None or "std" not in row or self.noise is None:
            return None
        ratio = published.seconds * published.threads / self.cpu
        return measures.gain(row["std"], row.get("bias", 0.0) ** 2, self.noise, self.bias_squared, ratio)


def _add_images(summary, images, errors, reference, block):
    mean, grey = reference.mean, [measures.grey(image) for image in images]
    if all(error is not None for error in errors):
        stds = [measures.relative_std(error, mean) for error in errors]
        summary.std, summary.std_range = median(stds), (min(stds), max(stds))
    shape = reference.image.shape[:2]
    coarse = [average_down(image, shape) for image in images]
    averaged = [measures.grey(image) for image in coarse]
    ratios = [float(image.mean() / mean) for image in averaged]
    summary.mean_ratio = median(ratios)
    summary.average = np.mean(coarse, axis=0)
    summary.relmse99 = median(measures.relmse99(image, reference) for image in coarse)
    summary.median_error = median(measures.median_error(image, reference.grey) for image in averaged)
    summary.flip = median(measures.picture_difference(image, reference.image) for image in coarse)
    if len(images) >= 2:
        summary.std_spread = measures.spread_std(grey, mean)
        if grey[0].shape != shape:
            summary.std_averaged = measures.spread_std(averaged, mean)
        summary.bias = measures.block_bias(averaged, reference.grey, reference.block_variance, block)
        summary.mean_ratio_error = measures.standard_error(ratios)


def summarise(runs, reference, study: Study):
    """Summary of the runs that differ in the seed only."""
    summary = Summary(runs[0].scene, runs[0].method, runs[0].seconds)
    images, errors, stats = [], [], []
    for run in runs:
        record = run.record()
        if record is None:
            summary.missing += 1
        elif record.get("skipped"):
            summary.skipped = record["skipped"]
        elif record["error"]:
            summary.failures.append((run.label, record["error"]))
        else:
            layers = read_exr(run.folder / "image.exr")
            stats.append(json.loads((run.folder / "stats.json").read_text()))
            images.append(layers[""])
            errors.append(layers.get("stderr") if stats[-1]["passes"] >= 2 else None)
            summary.builds.add(record["build"])
            summary.machines |= {record["machine"]} if "machine" in record else set()
            summary.image = summary.image or run.folder / "image.exr"
    if not images:
        return summary
    summary.seeds = len(images)
    summary.passes = median(s["passes"] for s in stats)
    summary.wall = median(s["stages"]["passes"]["wall seconds"] for s in stats)
    summary.cpu = median(s["stages"]["passes"]["CPU seconds"] for s in stats)
    summary.share = summary.cpu / (summary.wall * study.threads)
    summary.memory = median(s["peak memory bytes"] for s in stats)
    summary.non_finite = sum(s["non-finite samples"] for s in stats)
    told = [(s["relative bias"], s["relative bias bound"]) for s in stats if s.get("relative bias") is not None]
    summary.told_bias = tuple(median(column) for column in zip(*told)) if told else None
    found = {stage: [s["stages"][stage]["wall seconds"] for s in stats if stage in s["stages"]] for stage in STAGES}
    summary.stages = {stage: median(seconds) for stage, seconds in found.items() if seconds}
    _add_images(summary, images, errors, reference, study.block)
    return summary


def collect(study: Study, runs):
    """Summaries and references: ({scene: {seconds: {method: Summary}}}, {scene: Reference})."""
    references = {scene.name: read_reference(scene, study.block) for scene in study.scenes}
    groups = {}
    for run in runs:
        groups.setdefault((run.scene.name, run.seconds, run.method.name), []).append(run)
    summaries = {scene.name: {seconds: {method.name: summarise(groups[scene.name, seconds, method.name], references[scene.name], study)
                                        for method in study.methods_of(scene)} for seconds in study.seconds} for scene in study.scenes}
    return summaries, references
