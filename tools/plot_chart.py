#!/usr/bin/python3
"""Pictures of a chart: error against processor time, one SVG and PNG per scene.

usage: tools/plot_chart.py CHART.csv [-o DIRECTORY] [--only SCENE ...]

Reads the table that `cleave chart` writes. Colour tells the scheme, the marker the levels; a line joins the resolutions of a
scheme. Needs python3-matplotlib (tools/install_packages plot).
"""
import argparse
import csv
import itertools
import math
import pathlib
import re

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
from matplotlib.lines import Line2D

CROSSES = ("failed", "unstable", "over limit", "not reached")
MARKERS = {1: "o", 2: "s", 3: "D", 4: "^"}
plt.rcParams.update({"font.size": 9, "svg.fonttype": "path", "svg.hashsalt": "cleave", "axes.spines.top": False,
                     "axes.spines.right": False})


def number(text):
    return float(text) if text else math.nan


def read_scenes(path):
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    for row in rows:
        for name in ("error", "cpu_s", "finest_mm", "levels", "front"):
            row[name] = number(row[name])
    return {scene: list(group) for scene, group in itertools.groupby(rows, key=lambda row: row["scene"])}


def file_name(scene):
    """As directory_name in app/study.cpp."""
    return re.sub(r"-+$", "", re.sub(r"[^A-Za-z0-9.+=_]+", "-", scene).lstrip("-")) or "run"


def colours(scenes):
    """One colour per scheme in all pictures; the default is black."""
    wheel = [*plt.get_cmap("tab10").colors, *plt.get_cmap("Dark2").colors, *plt.get_cmap("tab20b").colors]
    schemes = dict.fromkeys(row["scheme"] for rows in scenes.values() for row in rows if row["scheme"] != "default")
    return {"default": "black", **{scheme: wheel[i % len(wheel)] for i, scheme in enumerate(schemes)}}


def name_of(scheme, rows):
    """What the default is in this scene."""
    if scheme != "default":
        return scheme
    row = next(row for row in rows if row["role"])
    parts = [row["formulation"], row["transfer"], row["precision"] if row["precision"] != "f64" else "",
             row["basis"] if row["basis"] != "trilinear" else ""]
    return f"default ({' '.join(part for part in parts if part)})"


def draw(scene, rows, colour, directory):
    done = [row for row in rows if row["status"] == "done" and row["error"] > 0]
    crosses = [row for row in rows if row["status"] in CROSSES and row["cpu_s"] > 0]
    if not done and not crosses:
        return False
    schemes = list(dict.fromkeys(row["scheme"] for row in done + crosses))
    figure, axes = plt.subplots(figsize=(7.6, 4.6))
    axes.set_xscale("log")
    axes.set_yscale("log")
    for scheme in schemes:
        for levels in sorted({row["levels"] for row in done}):
            line = sorted((row for row in done if row["scheme"] == scheme and row["levels"] == levels),
                          key=lambda row: -row["finest_mm"])
            axes.plot([row["cpu_s"] for row in line], [row["error"] for row in line], color=colour[scheme],
                      marker=MARKERS.get(int(levels), "v"), markersize=4.5, linewidth=0.6, alpha=0.85, zorder=3)
    own = [row for row in done if row["role"]]
    axes.plot([row["cpu_s"] for row in own], [row["error"] for row in own], "o", markersize=10, markerfacecolor="none",
              markeredgecolor="0.45", markeredgewidth=0.8, zorder=2)
    for row in done:
        if row["role"] == "default":
            axes.plot(row["cpu_s"], row["error"], "*", markersize=15, color="gold", markeredgecolor="black", zorder=5)
    front = sorted((row for row in done if row["front"] == 1), key=lambda row: row["cpu_s"])
    if front:
        steps_x, steps_y = [front[0]["cpu_s"]], [front[0]["error"]]
        for row in front[1:]:
            steps_x += [row["cpu_s"], row["cpu_s"]]
            steps_y += [steps_y[-1], row["error"]]
        axes.plot(steps_x, steps_y, color="tab:red", linewidth=1.8, alpha=0.55, zorder=1)
    bounds = [row["error"] for row in done]
    low, high = (min(bounds), max(bounds)) if bounds else (1e-3, 1)
    span = max(high / low, 10) ** 0.06
    axes.set_ylim(low / span, high * span**2.2)
    for row in crosses:
        inside = math.isfinite(row["error"]) and 0 < row["error"] <= high * span
        axes.plot(row["cpu_s"], row["error"] if inside else high * span**1.4, "x", color=colour[row["scheme"]],
                  markersize=6, markeredgewidth=1.6, zorder=4)
    axes.set_xlabel("processor time, s")
    axes.set_ylabel("relative error")
    axes.grid(which="major", linewidth=0.4, alpha=0.6)
    axes.set_title(scene, loc="left")
    entries = [Line2D([], [], color=colour[s], marker="o", markersize=4, linewidth=0.8, label=name_of(s, rows))
               for s in schemes]
    entries += [Line2D([], [], color="0.3", linestyle="", marker=MARKERS.get(int(n), "v"), markersize=4,
                       label=f"{int(n)} level{'s' if n > 1 else ''}") for n in sorted({row["levels"] for row in done})]
    entries.append(Line2D([], [], color="tab:red", linewidth=1.8, alpha=0.55, label="Pareto front"))
    entries.append(Line2D([], [], linestyle="", marker="*", markersize=11, color="gold", markeredgecolor="black",
                          label="the case as it is"))
    entries.append(Line2D([], [], linestyle="", marker="o", markersize=8, markerfacecolor="none", markeredgecolor="0.45",
                          label="its scheme, other cells"))
    if crosses:
        entries.append(Line2D([], [], linestyle="", marker="x", color="0.3", label="failed or unstable"))
    axes.legend(handles=entries, loc="center left", bbox_to_anchor=(1.01, 0.5), frameon=False, fontsize=7.5)
    figure.tight_layout()
    for ending, options in (("svg", {"metadata": {"Date": None}}), ("png", {"dpi": 110})):
        figure.savefig(directory / f"{file_name(scene)}.{ending}", **options)
    plt.close(figure)
    return True


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("chart", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("."))
    parser.add_argument("--only", nargs="*")
    options = parser.parse_args()
    options.output.mkdir(parents=True, exist_ok=True)
    scenes = read_scenes(options.chart)
    colour = colours(scenes)
    for scene, rows in scenes.items():
        if (not options.only or scene in options.only) and not draw(scene, rows, colour, options.output):
            print(f"{scene}: nothing to draw yet")


if __name__ == "__main__":
    main()
