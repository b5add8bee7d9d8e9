#!/usr/bin/python3
"""The study of Yang et al. 2014 and what it lacks: runs, pictures and docs/snl.md.

usage: tools/snl_study.py [-o DIRECTORY] [--group GROUP] [--threads N] [--page-only] [--cleave PROGRAM] [NAME ...]

Runs the variants of VARIANTS (or one group, or those named) into DIRECTORY/NAME (default results/snl-study), one after
the other, skipping those that are done; then writes the tables of docs/snl.md, docs/snl.csv and the pictures in docs/img
from all results it finds. Rows of docs/snl.csv whose runs are not there, and pictures some of whose runs are not, stay as
they are. Needs python3-h5py and python3-matplotlib.
"""
import argparse
import csv
import dataclasses
import json
import os
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from matplotlib.collections import PolyCollection
from matplotlib.colors import ListedColormap
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from csv_rows import write_rows
from marked_page import replaced
from patient_call import call
from picture_of_run import name_features, places_of_features, read_curve, read_frame, show_scale

ROOT = pathlib.Path(__file__).resolve().parent.parent
DECOHESION = "material.steel.decohesion"
AVERAGED = ['material.steel.dilatation="cell"']
SECOND = [f"{DECOHESION}.second_crack=true"]
MOMENT = [f"{DECOHESION}.lode_memory=0"]
C_AT = "feature.C.centre=[21.08, {:.2f}, 0]"
D_AT = "feature.D.centre=[18.52, {:.2f}, 0]"
AT_START = ['end.time="1e-5 ms"']


@dataclasses.dataclass
class Variant:
    group: str
    case: str  # below cases
    change: str
    overrides: list = dataclasses.field(default_factory=list)
    kernels: str = ""  # "avx2": those, though the processor has AVX-512


def mode(name):
    return [f'{DECOHESION}.mode="{name}"']


def speed(value, end):
    return [f'load.upper_pin.velocity=[0, "{value} m/s", "free"]', f'load.lower_pin.velocity=[0, "-{value} m/s", "free"]',
            f'end.time="{end} ms"']


def grip_speed(value):
    """Crosshead of the coupon: the same elongation at any speed, the start in the same share of the time."""
    return [f'load.grip.velocity="{value} m/s"', f'load.grip.ramp.time="{0.25 / value} ms"', f'end.time="{2.5 / value} ms"',
            f'output.particles.every_time="{0.25 / value} ms"', 'output.history.every_time="5 us"']


PAPER, FINE, COUPON = "snl/preview.toml", "snl/challenge-lean.toml", "tension/coupon.toml"
OBJECTIVE, FINE_OBJECTIVE = "snl/objective/preview.toml", "snl/objective/challenge.toml"
CHANGES = {  # what is done to a preview with either model
    "shifted-x": ("lattice moved by a quarter cell in x", ["grid.origin=[0.125, 0, 0]"]),
    "shifted-y": ("lattice moved by a quarter cell in y", ["grid.origin=[0, 0.125, 0]"]),
    "bridged": ("no second cracks", [f"{DECOHESION}.second_crack=false"]),
    "C": ("hole C where it was traced", [C_AT.format(0.84)]),
    "C+0.05": ("hole C higher by 0.05 mm", [C_AT.format(0.89)]),
    "D-0.10": ("hole D lower by 0.10 mm", [D_AT.format(3.88)]),
    "D-0.05": ("hole D lower by 0.05 mm", [D_AT.format(3.93)]),
    "D": ("hole D where it was traced", [D_AT.format(3.98)]),
    "D+0.05": ("hole D higher by 0.05 mm", [D_AT.format(4.03)]),
    "D+0.10": ("hole D higher by 0.10 mm", [D_AT.format(4.08)]),
    "counted": ("sample points counted in cut cells", ['grid.edge="fraction"']),
    "slow": ("pins part at 2.5 m/s", speed(1.25, 3.2)),
    "fast": ("pins part at 10 m/s", speed(5, 0.9)),
}
OBJECTIVE_CHANGES = ["shifted-x", "shifted-y", "bridged", "C", "C+0.05", "D-0.10", "D", "counted", "fast"]


def changed(names, group, case, prefix="", text="", overrides=()):
    """Variants PREFIXname with the changes of those names, beside `overrides`."""
    return {prefix + name: Variant(group, case, text + CHANGES[name][0], [*overrides, *CHANGES[name][1]]) for name in names}


VARIANTS = {
    "mixed": Variant("preview", PAPER, "as shipped: mixed mode, plain points"),
    "opening": Variant("preview", PAPER, "mode I only", mode("opening")),
    "shear": Variant("preview", PAPER, "mode II only", mode("shear")),
    "s3000": Variant("preview", PAPER, "s_max = 3000 MPa", [f'{DECOHESION}.s_max="3000 MPa"']),
    "mixed-averaged": Variant("preview", PAPER, "mixed mode, averaged dilatation", AVERAGED),
    "opening-averaged": Variant("preview", PAPER, "mode I only, averaged dilatation", AVERAGED + mode("opening")),
    "shear-averaged": Variant("preview", PAPER, "mode II only, averaged dilatation", AVERAGED + mode("shear")),
    "mixed-second": Variant("preview", PAPER, "mixed mode, second cracks", SECOND),
    **changed(["shifted-x", "shifted-y", "D-0.10", "D-0.05", "D+0.05", "D+0.10", "slow", "fast"], "preview", PAPER),
    "double": Variant("preview", PAPER, "double precision", ['numerics.precision="f64"']),
    "updated": Variant("preview", PAPER, "updated Lagrangian, FLIP", ['numerics.formulation="updated"']),
    "full-thickness": Variant("preview", PAPER, "full thickness, no symmetry plane",
                              ["body.0.shape.difference.from.box.lower=[0, -15.875, -1.575]", "symmetry=[]"]),
    "objective": Variant("objective", OBJECTIVE, "as shipped, 0.5 and 0.25 mm"),
    **changed(OBJECTIVE_CHANGES, "objective", OBJECTIVE, "objective-"),
    "objective-avx2": Variant("objective", OBJECTIVE, "the same, kernels of AVX2", kernels="avx2"),
    "objective-long": Variant("objective", OBJECTIVE, "to COD 10 mm", ["end.cod=10", 'end.time="2.4 ms"']),
    "objective-memory-0.02": Variant("objective", OBJECTIVE, "memory of 0.02", [f"{DECOHESION}.lode_memory=0.02"]),
    "objective-memory-0.1": Variant("objective", OBJECTIVE, "memory of 0.1", [f"{DECOHESION}.lode_memory=0.1"]),
    "undamped": Variant("objective", OBJECTIVE, "no damping", ["numerics.damping=0"]),
    "moment": Variant("moment", OBJECTIVE, "no memory", MOMENT),
    **changed(["shifted-x", "shifted-y"], "moment", OBJECTIVE, "moment-", "no memory, ", MOMENT),
    "slice": Variant("slice", "snl/slice.toml", "cells of 0.25 mm"),
    "slice-fine": Variant("slice", "snl/slice.toml", "cells of 0.125 mm", ["grid.cell=0.25"]),
    "fine-mixed": Variant("fine", FINE, "paper, mixed mode, three levels"),
    "fine-opening": Variant("fine", FINE, "paper, mode I only, three levels, to 4.3 mm", mode("opening") + ["end.cod=4.3"]),
    "fine-shear": Variant("fine", FINE, "paper, mode II only, three levels", mode("shear")),
    "fine-shear-D-0.05": Variant("fine", FINE, "paper, mode II only, three levels, hole D lower by 0.05 mm, to 3.5 mm",
                                 mode("shear") + CHANGES["D-0.05"][1] + ["end.cod=3.5"]),
    "challenge": Variant("fine", "snl/challenge.toml", "paper, mixed mode, two levels as in the paper"),
    "objective-challenge": Variant("fine", FINE_OBJECTIVE, "objective, three levels"),
    "objective-challenge-avx2": Variant("fine", FINE_OBJECTIVE, "objective, the same, kernels of AVX2", kernels="avx2"),
    "objective-challenge-x": Variant("fine", FINE_OBJECTIVE, "objective, lattice moved in x by 0.0625 mm",
                                     ["grid.origin=[0.0625, 0, 0]"]),
    "objective-challenge-y": Variant("fine", FINE_OBJECTIVE, "objective, lattice moved in y by 0.0625 mm",
                                     ["grid.origin=[0, 0.0625, 0]"]),
    "levels": Variant("levels", "snl/challenge.toml", "0.25 and 0.125 mm, as in the paper", AT_START),
    "levels-lean": Variant("levels", FINE, "0.5, 0.25 and 0.125 mm", AT_START),
    "levels-preview": Variant("levels", PAPER, "0.5 and 0.25 mm, preview", AT_START),
    "whole-plain": Variant("field", "snl/no-fracture.toml", "plain points", ['material.steel.dilatation="point"',
                           'output.particles.fields=["stress", "damage", "eq_plastic_strain"]']),
    "whole-averaged": Variant("field", "snl/no-fracture.toml", "averaged dilatation",
                              ['output.particles.fields=["stress", "damage", "eq_plastic_strain"]']),
    **{f"coupon-{v:g}": Variant("coupon", COUPON, f"{2 * v:g} m/s", grip_speed(v)) for v in (0.5, 2.5, 5)},
}
SAME_METAL = {  # runs of the objective model that differ by what should not matter: the lattice's place, rounding
    "0.25 mm": ["objective", "objective-avx2", "objective-shifted-x", "objective-shifted-y"],
    "0.125 mm": ["objective-challenge", "objective-challenge-avx2", "objective-challenge-x", "objective-challenge-y"],
}
HOW = ["as shipped", "kernels of AVX2", "lattice moved in x", "lattice moved in y"]
EVENT_GROUPS = ["preview", "objective", "moment", "slice", "fine"]
EVENTS = (1, 2, 3)
MEASURES = ["peak_force_N"] + [f"c{k}_{what}" for k in EVENTS for what in ("force_N", "mean_N", "cod_mm")]


def done(directory):
    record = directory / "run.json"
    return record.exists() and json.loads(record.read_text())["status"] == "done"


def run(program, name, directory, threads):
    variant = VARIANTS[name]
    changes = [part for override in variant.overrides for part in ("--set", override)]
    command = [program, "run", str(ROOT / "cases" / variant.case), "-o", str(directory), "--force", *changes]
    if threads:
        command += ["--threads", str(threads)]
    log = directory.parent / f"{directory.name}.log"
    narrow = {"GLIBC_TUNABLES": "glibc.cpu.hwcaps=-AVX512F"} if variant.kernels == "avx2" else {}
    with open(log, "w") as output:
        code = call(command, stdout=output, stderr=subprocess.STDOUT, env=os.environ | narrow)
    print(f"{name}: {'done' if code == 0 else f'ended with code {code}, see {log}'}", flush=True)


def smooth(opening, force, width=0.05):
    """Mean over `width` mm of opening, against the ringing."""
    at = np.arange(width / 2, opening.max(), width / 2)
    return at, np.array([force[np.abs(opening - x) <= width / 2].mean() if (np.abs(opening - x) <= width / 2).any() else np.nan
                         for x in at])


def force_near(curve, opening):
    x, f = curve
    near = np.abs(x - opening) < 0.05
    return float(f[near].mean()) if near.any() else float("nan")


def of_group(group):
    return [name for name, variant in VARIANTS.items() if variant.group == group]


def show_plane(axes, x, y, title, bar=5):
    """Frame of a picture of the specimen [mm], with a bar of `bar` mm."""
    axes.set_xlim(*x)
    axes.set_ylim(*y)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(title, fontsize=9)
    show_scale(axes, bar)


def dots(entries):
    """Legend entries: text by colour."""
    return [Line2D([], [], linestyle="", marker="o", markersize=4, color=colour, label=text) for colour, text in entries.items()]


STRAIN = ListedColormap(plt.get_cmap("Greys")(np.linspace(1 / 7, 1, 256)))
CRACKED = {"tab:red": (1, "cracked by opening"), "tab:blue": (2, "cracked in shear"), "tab:green": (3, "cracked in mixed mode")}


def draw_pattern(axes, directory, time=None, title=None):
    """Plastic strain at the middle plane and the particles that crack: what was drawn for the strain, colours of the cracks."""
    at_time, points, data, side = read_frame(directory, time)
    damage, failed, strain = data["damage"], data["failure_mode"], data["eq_plastic_strain"]
    middle = points[:, 2] < points[damage < 1, 2].min() + side.max()
    x, y = points[middle, 0], points[middle, 1]
    broken = damage[middle] > 0
    shown = axes.scatter(x[~broken], y[~broken], c=strain[middle][~broken], s=1.2, cmap=STRAIN, vmin=0, vmax=0.6, linewidths=0)
    colours = set()
    for colour, (code, _) in CRACKED.items():
        chosen = broken & (failed[middle] == code)
        axes.scatter(x[chosen], y[chosen], color=colour, s=2.5, linewidths=0)
        if (chosen & (x > 13) & (x < 34) & (np.abs(y) < 9)).any():
            colours.add(colour)
    name_features(axes, places_of_features(directory, points, damage), 8)
    show_plane(axes, (13, 34), (-9, 9), title or f"t = {at_time:.2f} ms")
    return shown, colours


def save_patterns(path, figure, axes, drawn):
    """The picture with what its colours mean."""
    figure.set_layout_engine("constrained", rect=(0, 0.07, 1, 0.93))
    figure.colorbar(drawn[0][0], ax=axes, shrink=0.7, label="equivalent plastic strain", extend="max")
    colours = {colour: text for colour, (_, text) in CRACKED.items() if any(colour in seen for _, seen in drawn)}
    figure.legend(handles=dots(colours), loc="lower center", ncols=len(colours), frameon=False, fontsize=8)
    figure.savefig(path, dpi=100)
    plt.close(figure)


def draw_curves(path, results, names, reference):
    figure, axes = plt.subplots(figsize=(7, 4.2))
    for name in names:
        axes.plot(*[v / s for v, s in zip(smooth(*read_curve(results[name])), (1, 1000))], linewidth=1.2, label=VARIANTS[name].change)
    for marker, (who, numbers) in zip("os", reference.items()):
        axes.plot([numbers[f"c{k}_cod_mm"] for k in EVENTS], [numbers[f"c{k}_force_N"] / 1000 for k in EVENTS], marker,
                  color="0.2", markersize=5, markerfacecolor="none" if marker == "s" else "0.2", label=f"{who}: crack initiations")
    axes.set_xlabel("crack opening displacement [mm]")
    axes.set_ylabel("force [kN]")
    axes.set_xlim(0, 6.3)
    axes.set_ylim(bottom=0)
    axes.legend(frameon=False, fontsize=7)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_patterns(path, results, names):
    figure, axes = plt.subplots(1, len(names), figsize=(3.4 * len(names), 3.2), squeeze=False)
    save_patterns(path, figure, axes, [draw_pattern(one, results[name], title=VARIANTS[name].change)
                                       for one, name in zip(axes[0], names)])


def draw_sections(path, results, names, behind=(22.7, 23.5)):
    """Slabs of one cell's width across the crack behind hole C, from the middle plane to the face, last frame."""
    figure, axes = plt.subplots(1, len(names) * len(behind), figsize=(1.5 * len(names) * len(behind), 3.9))
    figure.subplots_adjust(0.02, 0.08, 0.98, 0.86, 0.1)
    colours = {"0.8": "intact", "tab:orange": "softening", "tab:blue": "through"}
    how = dict(zip(SAME_METAL["0.125 mm"], HOW))
    for row, name in zip(axes.reshape(len(names), len(behind)), names):
        middle = (row[0].get_position().x0 + row[-1].get_position().x1) / 2
        figure.text(middle, 0.96, how[name], ha="center", va="center", fontsize=9)
        _, points, data, side = read_frame(results[name])
        for one, x in zip(row, behind):
            slab = (np.abs(points[:, 0] - x) < side.min()) & (points[:, 2] < 2)
            y, z, damage = points[slab, 1], points[slab, 2], data["damage"][slab]
            for chosen, colour in zip((damage == 0, (damage > 0) & (damage < 1), damage >= 1), colours):
                one.scatter(z[chosen], y[chosen], color=colour, s=3, linewidths=0)
            show_plane(one, (-0.1, 1.7), (-1.5, 2.5), f"x = {x} mm", 0.5)
    figure.legend(handles=dots(colours), loc="lower center", ncols=len(colours), frameon=False, fontsize=8)
    figure.savefig(path, dpi=120)
    plt.close(figure)


def draw_sequence(path, results, names, openings=(1.0, 2.5, 4.0, 6.0)):
    directory = results[names[0]]
    with open(directory / "history.csv", newline="") as file:
        rows = [(float(row["time_ms"]), float(row["cod_mm"])) for row in csv.DictReader(file)]
    figure, axes = plt.subplots(1, len(openings), figsize=(3.2 * len(openings), 3.2))
    times = [min(rows, key=lambda row: abs(row[1] - opening))[0] for opening in openings]
    save_patterns(path, figure, axes, [draw_pattern(one, directory, time, f"COD {opening} mm")
                                       for one, time, opening in zip(axes, times, openings)])


def number(value, digits=0):
    return "–" if value is None or value != value else f"{value:.{digits}f}"


def row_of(name, directory):
    record = json.loads((directory / "run.json").read_text())
    measures = record["measures"]
    curve = read_curve(directory)
    return {"group": VARIANTS[name].group, "variant": name, "case": VARIANTS[name].case, "change": VARIANTS[name].change,
            **{key: measures.get(key) for key in MEASURES},
            "crack_path": measures.get("crack_path") or "", "force_at_3mm_N": force_near(curve, 3),
            "force_at_6mm_N": force_near(curve, 6), "energy_residual": measures.get("energy_residual"),
            "particles": sum(record["particles"]["start"]), "steps": record["steps"],
            "cpu_s": round(record["cpu_s"]) if "cpu_s" in record else None,
            "kernels": record["instruction_set"], "commit": record.get("commit") or ""}


def table(rows):
    lines = ["| change | peak, N | C1, N / mm | C2, N / mm | C3, N / mm | path | N at 3 mm | N at 6 mm | residual |",
             "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        event = [f"{number(row[f'c{k}_force_N'])} / {number(row[f'c{k}_cod_mm'], 2)}" for k in EVENTS]
        residual = f"{row['energy_residual']:.1e}" if row["energy_residual"] is not None else "–"
        lines.append(f"| {row['change']} | {number(row['peak_force_N'])} | {' | '.join(event)} | {row['crack_path'] or '–'} | "
                     f"{number(row['force_at_3mm_N'])} | {number(row['force_at_6mm_N'])} | {residual} |")
    return "\n".join(lines)


def draw_coupon(path, results, names):
    figure, axes = plt.subplots(figsize=(6, 3.8))
    for name in names:
        with open(results[name] / "history.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        strain = np.array([float(row["cod_mm"]) for row in rows]) / 12.5
        axes.plot(100 * strain, np.array([float(row["force_upper_N"]) for row in rows]) / (6 * 3.15), linewidth=1.0,
                  label=f"ends part at {VARIANTS[name].change}")
    axes.axhline(1100, color="0.6", linewidth=0.8, label="yield stress, 1100 MPa")
    axes.set_xlabel("engineering strain over 25 mm [%]")
    axes.set_ylabel("engineering stress [MPa]")
    axes.set_xlim(0, 12)
    axes.set_ylim(0, 1400)
    axes.legend(frameon=False, fontsize=8)
    figure.tight_layout()
    figure.savefig(path, dpi=110)
    plt.close(figure)


def draw_levels(path, results, names):
    """Cells of the first frame that have material at the middle plane, one grey per size."""
    figure, axes = plt.subplots(1, len(names), figsize=(4.2 * len(names), 4.8), squeeze=False)
    greys = {0.5: "0.95", 0.25: "0.8", 0.125: "0.62"}
    for one, name in zip(axes[0], names):
        _, points, _, side = read_frame(results[name], 0)
        for cell, grey in greys.items():
            inside = (np.abs(2 * side - cell) < 1e-5) & (points[:, 2] < points[:, 2].min() + 4 * side.max())
            lower = np.unique(np.floor(points[inside, :2] / cell), axis=0) * cell
            corners = np.array([[0, 0], [1, 0], [1, 1], [0, 1]]) * cell
            one.add_collection(PolyCollection(lower[:, None, :] + corners, facecolor=grey, edgecolor="0.3", linewidth=0.12))
        particles = f"{len(points):,}".replace(",", " ")
        show_plane(one, (-0.5, 32.5), (-16.5, 16.5), f"{VARIANTS[name].change}: {particles} particles")
    patches = [Patch(facecolor=grey, edgecolor="0.3", linewidth=0.5, label=f"cells of {cell} mm") for cell, grey in greys.items()]
    figure.legend(handles=patches, loc="lower center", ncols=len(greys), frameon=False, fontsize=9)
    figure.tight_layout(rect=(0, 0.06, 1, 1))
    figure.savefig(path, dpi=130)
    plt.close(figure)


def largest_principal(stress):
    """Of ParaView's order xx yy zz xy yz zx."""
    xx, yy, zz, xy, yz, zx = stress.T
    return np.linalg.eigvalsh(np.stack([np.stack([xx, xy, zx], -1), np.stack([xy, yy, yz], -1), np.stack([zx, yz, zz], -1)], -2))[:, 2]


def draw_stress(path, results, names):
    """Largest principal stress without fracture, last frame, one layer of points at the middle plane."""
    figure, axes = plt.subplots(1, len(names), figsize=(5 * len(names), 4), squeeze=False)
    for one, name in zip(axes[0], names):
        time, points, data, side = read_frame(results[name])
        middle = points[:, 2] < points[:, 2].min() + side.max() / 2
        stress = largest_principal(data["stress"][middle])
        shown = one.scatter(points[middle, 0], points[middle, 1], c=stress, s=5, cmap="viridis", vmin=0, vmax=4900, linewidths=0)
        show_plane(one, (15, 26), (-5, 8), f"{VARIANTS[name].change}: at most {stress.max():.0f} MPa")
        figure.colorbar(shown, ax=one, shrink=0.7, label="largest principal stress [MPa]", extend="max")
    figure.tight_layout()
    figure.savefig(path, dpi=70)
    plt.close(figure)


def read_value(key, text):
    """A field of docs/snl.csv: text, number or None."""
    if key in ("group", "variant", "case", "change", "crack_path", "kernels", "commit"):
        return text
    if not text:
        return None
    return int(text) if text.isdigit() else float(text)


def kept_rows():
    """Rows of docs/snl.csv by variant."""
    with open(ROOT / "docs/snl.csv", newline="") as file:
        return {row["variant"]: {key: read_value(key, text) for key, text in row.items()}
                for row in csv.DictReader(file) if row["variant"] in VARIANTS}


def off(value, against):
    return f" ({100 * (value / against - 1):+.0f} %)"


def mean_of(rows, names):
    """A row of the means of those; their common path, or all of them."""
    return {key: float(np.mean([rows[name][key] for name in names])) for key in MEASURES} | {
        "crack_path": ", ".join(sorted({rows[name]["crack_path"] for name in names}))}


def spread(rows, same_metal, reference):
    """Those runs, their means, how far the farthest goes from them, and what half the cells change."""
    digits = [2 if key.endswith("mm") else 0 for key in MEASURES]
    shown = lambda title, cells: f"| {title} | " + " | ".join(cells) + " |"
    lines = [shown("", ["maximum, N"] + [f"C{k}, {unit}" for k in EVENTS for unit in ("N", "mean N", "mm")]),
             "|---" * (len(MEASURES) + 1) + "|"]
    means = {}
    for cell, names in same_metal.items():
        values = np.array([[rows[name][key] for key in MEASURES] for name in names], float)
        mean = mean_of(rows, names)
        means[cell] = np.array([mean[key] for key in MEASURES])
        lines += [shown(f"{cell}, {how}", map(number, line, digits)) for how, line in zip(HOW, values)]
        lines += [shown(f"**{cell}, mean**", map(number, means[cell], digits)),
                  shown("farthest from it", [f"{100 * part:.0f} %" for part in np.abs(values / means[cell] - 1).max(axis=0)])]
    experiment = {**reference["experiment"], **{f"c{k}_mean_N": reference["experiment"][f"c{k}_force_N"] for k in EVENTS}}
    measured = [experiment[key] for key in MEASURES]
    percents = lambda values, against: [off(value, one).strip(" ()") for value, one in zip(values, against)]
    coarse, fine = means.values()
    return "\n".join(lines + [
        shown("half the cells change the mean by", percents(fine, coarse)), shown("experiment", map(number, measured, digits)),
        shown("0.25 mm, mean against it", percents(coarse, measured)), shown("0.125 mm, mean against it", percents(fine, measured))])


def table_one(rows, reference):
    """Table 1 of the paper with the runs at its resolution beside it."""
    columns = [("experiment", reference["experiment"]), ("Yang et al.", reference["simulation"])]
    columns += [(pathlib.Path(VARIANTS[name].case).with_suffix("").relative_to("snl"), rows[name]) for name in ("challenge", "mixed")]
    columns += [(f"objective, {cell}, mean of {len(names)}", mean_of(rows, names)) for cell, names in reversed(SAME_METAL.items())]
    experiment = reference["experiment"]
    lines = ["| measure | " + " | ".join(str(title) for title, _ in columns) + " |", "|---" * (len(columns) + 1) + "|"]
    for key, against, text, digits in [("peak_force_N", "peak_force_N", "maximum force, N", 0)] + [
            (f"c{k}_{what}", f"c{k}_{measured}", f"C{k}, {unit}", digits) for k in EVENTS
            for what, measured, unit, digits in (("force_N", "force_N", "N", 0), ("mean_N", "force_N", "mean N of the 0.2 mm before", 0),
                                                 ("cod_mm", "cod_mm", "COD mm", 2))]:
        cells = [number(value, digits) + ("" if value is None or title == "experiment" else off(value, experiment[against]))
                 for title, numbers in columns for value in [numbers.get(key)]]
        lines.append(f"| {text} | " + " | ".join(cells) + " |")
    paths = ["A-D-C-E", "A-D-C-E"] + [numbers.get("crack_path") or "–" for _, numbers in columns[2:]]
    lines.append("| cut through | " + " | ".join(paths) + " |")
    return "\n".join(lines)


def programs(rows):
    """Which program made which rows: runs with other vectors or of another commit differ by rounding at least."""
    made = {}
    for row in rows:
        made.setdefault((row.get("commit") or "not recorded", row.get("kernels") or "not recorded"), []).append(row["variant"])
    lines = ["| commit | kernels | rows |", "|---|---|---|"]
    for (commit, kernels), names in sorted(made.items(), key=lambda item: -len(item[1])):
        lines.append(f"| {commit} | {kernels} | {len(names)}: {', '.join(names)} |")
    return "\n".join(lines)


def draw_all(images, results, reference):
    """Every picture all of whose runs are at hand; the others stay as they are."""
    modes = ["opening", "shear", "mixed"]
    if all("fine-" + name in results for name in modes):
        modes = ["fine-" + name for name in modes]
    objective = ["objective-challenge", "objective", "undamped"]
    paths = ["objective-challenge", "objective", "objective-D", "objective-C"]
    of_memory = [model + lattice for model in ("objective", "moment") for lattice in ("", "-shifted-x", "-shifted-y")]
    of_lattice = ["objective-challenge", "objective-challenge-x", "objective-challenge-y"]
    curves = lambda *of: draw_curves(*of, reference)
    for name, draw, names in [
            ("modes", curves, modes), ("patterns", draw_patterns, modes),
            ("averaged", curves, ["opening-averaged", "shear-averaged", "mixed-averaged"]),
            ("objective", curves, objective), ("patterns-objective", draw_patterns, paths),
            ("memory", curves, of_memory),
            ("lattice", curves, of_lattice), ("patterns-lattice", draw_patterns, of_lattice), ("sections", draw_sections, of_lattice),
            ("sequence", draw_sequence, ["objective-challenge"]), ("levels", draw_levels, of_group("levels")),
            ("coupon", draw_coupon, of_group("coupon")), ("stress", draw_stress, of_group("field"))]:
        if all(name in results for name in names):
            draw(images / f"snl-{name}.png", results, names)


def write_page(results, reference):
    by_name = kept_rows() | {name: row_of(name, results[name]) for name in results if VARIANTS[name].group in EVENT_GROUPS}
    rows = [by_name[name] for name in VARIANTS if name in by_name]
    write_rows(ROOT / "docs/snl.csv", rows)
    draw_all(ROOT / "docs/img", results, reference)
    page = ROOT / "docs/snl.md"
    text = replaced(page.read_text(), "table 1", table_one(by_name, reference))
    text = replaced(text, "programs", programs(rows))
    text = replaced(text, "spread", spread(by_name, SAME_METAL, reference))
    for group in EVENT_GROUPS:
        members = [row for row in rows if row["group"] == group]
        if members and f"<!-- {group} -->" in text:
            text = replaced(text, group, table(members))
    page.write_text(text)


def read_reference():
    reference = {}
    with open(ROOT / "cases/snl/reference.csv", newline="") as file:
        for row in csv.DictReader(line for line in file if not line.startswith("#")):
            numbers = reference.setdefault(row["source"], {})
            numbers[f"{row['event']}_force_N"] = float(row["force_N"])
            if row["cod_mm"]:
                numbers[f"{row['event']}_cod_mm"] = float(row["cod_mm"])
    return reference


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/snl-study")
    parser.add_argument("--group", choices=sorted({variant.group for variant in VARIANTS.values()}))
    parser.add_argument("--cleave", default=str(ROOT / "cleave"))
    parser.add_argument("--threads", type=int, help="of each run; default: all of the machine")
    parser.add_argument("--page-only", action="store_true", help="run nothing")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    unknown = set(options.names) - set(VARIANTS)
    if unknown:
        sys.exit(f"unknown variants {sorted(unknown)}; there are {list(VARIANTS)}")
    options.output.mkdir(parents=True, exist_ok=True)
    if not options.page_only:
        for name in options.names or [name for name, variant in VARIANTS.items() if options.group in (None, variant.group)]:
            if not done(options.output / name):
                run(options.cleave, name, options.output / name, options.threads)
    results = {name: options.output / name for name in VARIANTS if done(options.output / name)}
    if not results:
        sys.exit("no finished run")
    write_page(results, read_reference())


if __name__ == "__main__":
    main()
