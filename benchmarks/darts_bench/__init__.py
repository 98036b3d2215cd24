"""What benchmarks/bench.py stands on. Where to look:

run               starts the renderer: limits, processor time, what is kept by its content, films, conditions
measures          errors, noise, bias, agreement; flip: how different pictures look
images            reads and writes EXR and PFM, brings images to a resolution and a tone
tables, plots     text and figures of all measurements; report, page: a study's report.md and report.html (film_code: its images)
study             the command of studies; study_file: what they ask for, study_runs: their renders and references, results: figures of these,
                  submit: job arrays, new_study: studies of any scene
program           what the studies that are programs stand on; properties: studies of one property of a scene
sweep             the sweeps of agreement; scene_words: what their scenes are written with, sweep_copies, sweep_report
kernels, costs, unused, two_builds, infinite_medium      the other commands

Studies, scenes and results are in the other folders of benchmarks/.
"""
