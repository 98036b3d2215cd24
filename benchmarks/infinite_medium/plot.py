#!/usr/bin/python3
"""Draws efficiencies of the named variants, a panel for each experiment: plot.py FILE.csv FILE.svg."""

import csv
import sys

import matplotlib

matplotlib.use("Agg")  # no display

import matplotlib.pyplot as plt  # noqa: E402

SHOWN = {"Path mode": ["published", "published, coarse table", "bounded table diffusion a.5", "bounded lobe a.5", "bounded lobe a.1", "R1", "R2", "best"],
         "Photon mode": ["published", "published, coarse table", "P2 bounded", "P2 table a.5", "P4 a.1", "P4 a.5", "RIS M=4", "best"]}


def main():
    with open(sys.argv[1], newline="") as file:
        rows = list(csv.DictReader(file))
    titles = list(dict.fromkeys(row["experiment"] for row in rows))
    figure, axes = plt.subplots(1, len(titles), figsize=(4.2 * len(titles), 3.4), constrained_layout=True, squeeze=False)
    for title, panel in zip(titles, axes[0]):
        names = SHOWN[title.split(",")[0]]
        for place, name in enumerate(names):
            for row in rows:
                if row["experiment"] == title and row["variant"] == name and row["relative_efficiency"]:
                    panel.plot(float(row["relative_efficiency"]), place, "o", color="tab:blue", markersize=5,
                               fillstyle="full" if row["converged"] == "1" else "none")
        panel.set_yticks(range(len(names)), names, fontsize=8)
        panel.invert_yaxis()
        panel.set_xscale("log")
        panel.axvline(1, color="0.3", linewidth=0.8)
        panel.set_title(title, fontsize=9)
        panel.grid(axis="x", color="0.92")
    axes[0][len(titles) // 2].set_xlabel("efficiency over phase directions; a dot a case, empty: variance not converged", fontsize=8)
    with plt.rc_context({"svg.fonttype": "none", "svg.hashsalt": "infinite_medium", "font.family": "sans-serif"}):
        figure.savefig(sys.argv[2], metadata={"Date": None})


if __name__ == "__main__":
    main()
