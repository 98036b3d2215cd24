"""report.md: the tables of a study, with its plots and pictures."""

import time
from pathlib import Path

from darts_bench.plots import scene_pictures, scene_plots
from darts_bench.run import write_whole
from darts_bench.tables import left_out, overview, scene_tables

SHARE_OF_A_QUIET_MACHINE = 0.85


def legend(study):
    """What the tables' figures are, in Markdown."""
    return f"""All figures are medians over the seeds, of the mean of R, G and B, relative to the mean of the reference.

- **rel. std**: rms over pixels of the renders' own standard error (the EXR's `stderr` layer; smallest and largest seed in
  brackets). **std over seeds**: the same from the spread of the seeds' images, independent of it. At a resolution above the
  reference's both are of the render's own pixels; **std, averaged down** is over the seeds at the reference's resolution.
- **block bias**: rms difference of the means of blocks of {study.block}×{study.block} reference pixels after subtracting the noise
  of renders and reference; "< x" where it does not stand out of that noise (2 standard errors).
- **own bias**: of studies with `"bias": true` (`--bias`, which takes time of its own): what
  the renderer says its kernels leave, and its bound, relative to the mean; unlike block bias it needs no reference.
- **mean ratio**: mean of the image over that of the reference, with its standard error over seeds.
- **MSE** = std² + bias². **gain**: MSE of the baseline ({study.baseline}; in scenes without it, the first method) over the
  method's, after bringing the baseline's variance to the method's wall time, since the last pass ends late by different amounts.
  **gain per CPU s**: the same at equal CPU time, which is firmer on a shared machine. **over published**: the same at equal CPU
  time over the published implementation's figures, measured elsewhere: a yardstick only.
- **MSE × CPU s**: of the passes, the reciprocal of the efficiency; without bias it is the same for any time.
- **relMSE 0.99**: mean squared difference from the reference after both are divided by the 0.99 quantile of the reference. **median
  error**: median over pixels of the absolute difference, which rare bright pixels do not move. **FLIP**: how different the pictures look, 0 to
  1 (Andersson et al. 2020), mean over pixels, tone-mapped with the 0.99 quantile as white, at 67 pixels per degree. All three at the
  reference's resolution, with the reference's own noise in them.
- **wall s, CPU s**: of the passes, without loading and preparation. **processor share**: CPU time over wall time and threads."""


def conditions(study, everything):
    """How the figures were made, and what is wrong with them, in Markdown."""
    done = [s for s in everything if s.seeds]
    lines = [f"{len(study.methods)} methods, {study.seeds} seeds, {study.threads} threads, "
             f"{', '.join(f'{s:g}' for s in study.seconds)} s of passes; written {time.strftime('%Y-%m-%d %H:%M')}."]
    builds = sorted(set().union(*(s.builds for s in done)) if done else [])
    lines.append(f"Renderer: build {', '.join(builds) or '(none)'}.")
    if len(builds) > 1:
        lines.append("**Results of different builds are mixed: run the study again.**")
    short = [s for s in done if s.share < SHARE_OF_A_QUIET_MACHINE]
    if short:
        lines.append(f"**The renderer had less than {100 * SHARE_OF_A_QUIET_MACHINE:.0f} % of its threads' time in {len(short)} of "
                     f"{len(done)} cases (least: {100 * min(s.share for s in short):.0f} %): the machine was shared, or the method "
                     "does not use its threads. Wall-time figures are provisional.**")
    missing = sum(s.missing for s in everything)
    if missing:
        lines.append(f"**{missing} runs are still to be made.**")
    return " \n".join(lines)


def _failures(everything):
    failures = [failure for s in everything for failure in s.failures]
    return ([f"## Failed runs ({len(failures)})"] if failures else []) + [f"**{label}**\n\n```\n{message}\n```" for label, message in failures]


def _scene_section(study, scene, by_seconds, reference, folder):
    width, height = scene.resolution
    gate = f", gate [{scene.gate[0]:g}, {scene.gate[1]:g})" if scene.gate else ""
    parts = [f"## {scene.name}", f"{scene.path.name} at {width}×{height}{gate}; reference {scene.reference.name}, "
             f"{reference.image.shape[1]}×{reference.image.shape[0]}."]
    parts += [f"### {table.title}\n\n{table.markdown}" for table in scene_tables(study, scene, by_seconds)]
    shown = scene_plots(study, scene, by_seconds, folder) + scene_pictures(study, scene, by_seconds, reference, folder)
    return parts + [f"### {title}\n\n![{title}]({file})" for title, file in shown]


def write_report(study, summaries, references, work: Path):
    """Writes report.md and its images into the work folder; returns its path."""
    everything = [s for by_seconds in summaries.values() for group in by_seconds.values() for s in group.values()]
    parts = [f"# {study.title}", conditions(study, everything), *_failures(everything), legend(study)]
    shared = [*([overview(study, summaries)] if len(study.scenes) > 1 else []), left_out(study, summaries)]
    parts += [f"## {table.title}\n\n{table.markdown}" for table in shared if table.rows]
    for scene in study.scenes:
        parts += _scene_section(study, scene, summaries[scene.name], references[scene.name], work)
    write_whole(work / "report.md", "\n\n".join(parts) + "\n")
    return work / "report.md"
