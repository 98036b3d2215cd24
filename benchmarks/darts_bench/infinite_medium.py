"""Draws efficiencies of the named variants that build/bin/infinite_medium has measured, a panel for each experiment."""

import argparse
import csv
from pathlib import Path

from darts_bench.plots import in_rows, panels, save

SHOWN = {"Path mode": ["published", "published, coarse table", "bounded table diffusion a.5", "bounded lobe a.5", "bounded lobe a.1", "R1", "R2", "best"],
         "Photon mode": ["published", "published, coarse table", "P2 bounded", "P2 table a.5", "P4 a.1", "P4 a.5", "RIS M=4", "best"]}


def main(arguments):
    parser = argparse.ArgumentParser(prog="bench.py infinite-medium", description=__doc__)
    parser.add_argument("csv", type=Path, metavar="FILE.csv")
    parser.add_argument("picture", type=Path, metavar="FILE.svg")
    options = parser.parse_args(arguments)
    with options.csv.open(newline="") as file:
        rows = list(csv.DictReader(file))
    titles = list(dict.fromkeys(row["experiment"] for row in rows))
    figure, axes = panels(len(titles))
    for title, panel in zip(titles, axes):
        names = SHOWN[title.split(",")[0]]
        for row in rows:
            if row["experiment"] == title and row["variant"] in names and row["relative_efficiency"]:
                panel.plot(float(row["relative_efficiency"]), names.index(row["variant"]), "o", color="tab:blue", markersize=5,
                           fillstyle="full" if row["converged"] == "1" else "none")
        in_rows(panel, names, "efficiency over phase directions; a dot a case, empty: variance not converged" if panel is axes[len(titles) // 2] else "")
        panel.set_title(title, fontsize=9)
    save(figure, options.picture)
