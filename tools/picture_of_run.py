#!/usr/bin/python3
"""Picture of a finished run: force-opening curve beside the deformed specimen.

usage: tools/picture_of_run.py RESULT_DIRECTORY OUTPUT.png

Reads history.csv, run.json (references), resolved.toml (features) and the last particle frame; needs python3-h5py and
python3-matplotlib.
"""
import csv
import json
import pathlib
import sys
import tomllib

import h5py
import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from mpl_toolkits.axes_grid1.anchored_artists import AnchoredSizeBar


def read_curve(directory):
    with open(directory / "history.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    opening = np.array([float(row["cod_mm"]) for row in rows])
    force = np.array([(float(row["force_upper_N"]) + float(row["force_lower_N"])) / 2 for row in rows])
    return opening, force


def read_frame(directory, time=None):
    """Particle frame nearest to `time`, the last without one: time, points, point data by name, particle sides."""
    files = json.loads((directory / "particles" / "particles.hdf.series").read_text())["files"]
    entry = max(files, key=lambda e: e["time"]) if time is None else min(files, key=lambda e: abs(e["time"] - time))
    with h5py.File(directory / "particles" / entry["name"], "r") as file:
        data = {name: column[:] for name, column in file["VTKHDF/PointData"].items()}
        side = file["particle_side"][:] if "particle_side" in file else None
        return entry["time"], file["VTKHDF/Points"][:], data, side


def radius_of(feature):
    """Of a feature in the plane of the picture; 1 mm where it has none."""
    return feature["diameter"] / 2 if "diameter" in feature else feature.get("shape", {}).get("tube", {}).get("radius", 1.0)


def places_of_features(directory, points, damage):
    """Where the voids that ligaments join have gone: name and place in the picture, beside the metal where one ends it. Only of the
    total formulation, whose particles keep their order."""
    case = tomllib.loads((directory / "resolved.toml").read_text())
    _, rest, _, _ = read_frame(directory, 0)
    if case["numerics"]["formulation"] != "total" or len(rest) != len(points):
        return []
    joined = {ligament[end] for ligament in case.get("ligament", []) for end in ("from", "to")}
    places = []
    for name in sorted(joined):
        feature = case["feature"][name]
        centre = np.array(feature["centre"][:2])
        rim = (np.linalg.norm(rest[:, :2] - centre, axis=1) < radius_of(feature) + 0.4) & (damage == 0)
        if rim.any():
            moved = (points - rest)[rim, :2].mean(axis=0)
            places.append((name, centre + moved + 1.6 * (centre - rest[rim, :2].mean(axis=0))))
    return places


def name_features(axes, places, size=9):
    for name, (x, y) in places:
        axes.text(x, y, name, ha="center", va="center", fontsize=size,
                  bbox={"facecolor": "white", "alpha": 0.7, "linewidth": 0, "pad": 0.5})


def show_scale(axes, length):
    """A bar of so many mm in the lower right corner of a picture without axes."""
    bar = AnchoredSizeBar(axes.transData, length, f"{length:g} mm", "lower right", pad=0.3, sep=3, borderpad=0.2,
                          fontproperties={"size": 8})
    bar.patch.set(edgecolor="none", alpha=0.85)
    axes.add_artist(bar)


def draw_curve(axes, directory):
    opening, force = read_curve(directory)
    axes.plot(opening, force / 1000, color="0.15", linewidth=1.0, label="this run")
    record = json.loads((directory / "run.json").read_text())
    for marker, reference in zip("os^", record.get("references", [])):
        numbers = reference.get("measures", reference)
        points = [(numbers.get(f"c{k}_cod_mm"), numbers.get(f"c{k}_force_N")) for k in (1, 2, 3)]
        points = [(x, y / 1000) for x, y in points if x is not None and y is not None]
        if points:
            axes.plot(*zip(*points), marker, label=f"{reference['name']}: crack initiations")
    axes.set_xlabel("crack opening displacement [mm]")
    axes.set_ylabel("force [kN]")
    axes.set_ylim(bottom=0)
    axes.set_xlim(left=0)
    axes.legend(frameon=False, fontsize=8)


def draw_specimen(axes, figure, directory):
    time, points, data, side = read_frame(directory)
    strain, damage = data["eq_plastic_strain"], data["damage"]
    whole = damage < 1  # separated particles may have flown off: the rest tells plane and frame
    lowest = points[whole, 2].min() + (side.max() if side is not None else 0.3)
    middle = points[:, 2] < lowest
    size = (side[middle] if side is not None else np.full(middle.sum(), 0.15)) * 14
    intact = whole[middle]
    at = points[middle]
    shown = axes.scatter(at[intact, 0], at[intact, 1], c=strain[middle][intact], s=size[intact] ** 2 / 3, cmap="inferno_r",
                         vmin=0, vmax=0.5, marker="s", linewidths=0)
    axes.scatter(at[~intact, 0], at[~intact, 1], color="tab:cyan", s=size[~intact] ** 2 / 4, marker="s", linewidths=0,
                 label="separated")
    lower, upper = at[intact].min(axis=0) - 0.5, at[intact].max(axis=0) + 0.5
    name_features(axes, places_of_features(directory, points, damage))
    axes.set_xlim(lower[0], upper[0] + 1)
    axes.set_ylim(lower[1], upper[1])
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(f"middle plane, t = {time:.3f} ms", fontsize=9)
    show_scale(axes, 5)
    axes.legend(frameon=False, fontsize=8, loc="upper right", markerscale=6)
    figure.colorbar(shown, ax=axes, shrink=0.6, label="equivalent plastic strain", extend="max")


def main():
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    directory = pathlib.Path(sys.argv[1])
    figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.6), width_ratios=(1, 1.15))
    draw_curve(left, directory)
    draw_specimen(right, figure, directory)
    figure.tight_layout()
    figure.savefig(sys.argv[2], dpi=110)


if __name__ == "__main__":
    main()
