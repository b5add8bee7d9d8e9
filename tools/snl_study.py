#!/usr/bin/python3
"""The challenge specimen under one change at a time: runs, pictures and docs/snl.md.

usage: tools/snl_study.py [-o DIRECTORY] [--case CASE] [--page-only] [--cleave PROGRAM] [NAME ...]

Runs the variants of VARIANTS (or those named) on CASE (default cases/snl/preview.toml) into DIRECTORY/CASE-NAME (default
results/snl-study), one after the other, skipping those that are done; then writes docs/snl.md, docs/snl-CASE.csv and the
pictures in docs/img from all results it finds. Needs python3-h5py and python3-matplotlib.
"""
import argparse
import csv
import json
import pathlib
import subprocess
import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

from picture_of_run import read_curve, read_frame

ROOT = pathlib.Path(__file__).resolve().parent.parent
PLAIN = ['material.steel.dilatation="point"']


def mode(name):
    return [f'material.steel.decohesion.mode="{name}"']


def speed(value, end):
    return [f'load.upper_pin.velocity=[0, "{value} m/s", "free"]', f'load.lower_pin.velocity=[0, "-{value} m/s", "free"]',
            f'end.time="{end} ms"']


# name: (what is changed, overrides)
VARIANTS = {
    "mixed": ("nothing: mixed mode, averaged dilatation", []),
    "opening": ("mode I only", mode("opening")),
    "shear": ("mode II only", mode("shear")),
    "mixed-plain": ("mixed mode, plain points", PLAIN),
    "opening-plain": ("mode I only, plain points", PLAIN + mode("opening")),
    "shear-plain": ("mode II only, plain points", PLAIN + mode("shear")),
    "s3000": ("s_max = 3000 MPa", ['material.steel.decohesion.s_max="3000 MPa"']),
    "s3000-plain": ("s_max = 3000 MPa, plain points", PLAIN + ['material.steel.decohesion.s_max="3000 MPa"']),
    "shifted-x": ("lattice moved by a quarter cell in x", ["grid.origin=[0.125, 0, 0]"]),
    "shifted-y": ("lattice moved by a quarter cell in y", ["grid.origin=[0, 0.125, 0]"]),
    "D-0.10": ("hole D lower by 0.10 mm", ["feature.D.centre=[18.52, 3.88, 0]"]),
    "D-0.05": ("hole D lower by 0.05 mm", ["feature.D.centre=[18.52, 3.93, 0]"]),
    "D+0.05": ("hole D higher by 0.05 mm", ["feature.D.centre=[18.52, 4.03, 0]"]),
    "D+0.10": ("hole D higher by 0.10 mm", ["feature.D.centre=[18.52, 4.08, 0]"]),
    "slow": ("pins part at 2.5 m/s", speed(1.25, 3.2)),
    "fast": ("pins part at 10 m/s", speed(5, 0.9)),
    "flip": ("FLIP on the particles, double precision",
             ['numerics.transfer="flip"', 'numerics.precision="f64"']),
    "double": ("double precision", ['numerics.precision="f64"']),
}
MEASURES = ["peak_force_N", "c1_force_N", "c1_cod_mm", "c2_force_N", "c2_cod_mm", "c3_force_N", "c3_cod_mm"]


def done(directory):
    record = directory / "run.json"
    return record.exists() and json.loads(record.read_text())["status"] == "done"


def run(program, case, name, directory):
    changes = [part for override in VARIANTS[name][1] for part in ("--set", override)]
    command = [program, "run", str(case), "-o", str(directory), "--force", *changes]
    log = directory.parent / f"{directory.name}.log"
    with open(log, "w") as output:
        code = subprocess.run(command, stdout=output, stderr=subprocess.STDOUT).returncode
    print(f"{name}: {'done' if code == 0 else f'ended with code {code}, see {log}'}", flush=True)


def smooth(opening, force, width=0.05):
    """Mean over `width` mm of opening, against the ringing."""
    at = np.arange(width / 2, opening.max(), width / 2)
    return at, np.array([force[np.abs(opening - x) <= width / 2].mean() if (np.abs(opening - x) <= width / 2).any() else np.nan
                         for x in at])


def force_near(directory, opening):
    x, f = read_curve(directory)
    near = np.abs(x - opening) < 0.05
    return float(f[near].mean()) if near.any() else float("nan")


def draw_pattern(axes, directory, time=None, title=None):
    at_time, points, data, side = read_frame(directory, time)
    damage, failed, strain = data["damage"], data["failure_mode"], data["eq_plastic_strain"]
    middle = points[:, 2] < points[:, 2].min() + side.max()
    x, y = points[middle, 0], points[middle, 1]
    broken = damage[middle] > 0
    axes.scatter(x[~broken], y[~broken], c=strain[middle][~broken], s=1.2, cmap="Greys", vmin=-0.1, vmax=0.6, linewidths=0)
    for code, colour in ((1, "tab:red"), (2, "tab:blue"), (3, "tab:green")):
        chosen = broken & (failed[middle] == code)
        axes.scatter(x[chosen], y[chosen], color=colour, s=2.5, linewidths=0)
    axes.set_xlim(13, 34)
    axes.set_ylim(-9, 9)
    axes.set_aspect("equal")
    axes.set_axis_off()
    axes.set_title(title or f"t = {at_time:.2f} ms", fontsize=9)


def draw_curves(path, results, names, reference):
    figure, axes = plt.subplots(figsize=(7, 4.2))
    for name in names:
        if name in results:
            axes.plot(*[v / s for v, s in zip(smooth(*read_curve(results[name])), (1, 1000))], linewidth=1.2, label=VARIANTS[name][0])
    for marker, (who, numbers) in zip("os", reference.items()):
        axes.plot([numbers[f"c{k}_cod_mm"] for k in (1, 2, 3)], [numbers[f"c{k}_force_N"] / 1000 for k in (1, 2, 3)], marker,
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
    names = [name for name in names if name in results]
    figure, axes = plt.subplots(1, len(names), figsize=(3.4 * len(names), 3.2), squeeze=False)
    for one, name in zip(axes[0], names):
        draw_pattern(one, results[name], title=VARIANTS[name][0])
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    plt.close(figure)


def draw_sequence(path, directory, openings):
    with open(directory / "history.csv", newline="") as file:
        rows = [(float(row["time_ms"]), float(row["cod_mm"])) for row in csv.DictReader(file)]
    figure, axes = plt.subplots(1, len(openings), figsize=(3.2 * len(openings), 3.2))
    for one, opening in zip(axes, openings):
        time = min(rows, key=lambda row: abs(row[1] - opening))[0]
        draw_pattern(one, directory, time, f"COD {opening} mm")
    figure.tight_layout()
    figure.savefig(path, dpi=100)
    plt.close(figure)


def number(value, digits=0):
    return "–" if value is None or value != value else f"{value:.{digits}f}"


def row_of(name, directory):
    record = json.loads((directory / "run.json").read_text())
    measures = record["measures"]
    return {"variant": name, "change": VARIANTS[name][0], **{key: measures.get(key) for key in MEASURES},
            "crack_path": measures.get("crack_path") or "", "force_at_3mm_N": force_near(directory, 3),
            "force_at_6mm_N": force_near(directory, 6), "energy_residual": measures.get("energy_residual"),
            "particles": sum(record["particles"]["start"])}


def table(rows):
    lines = ["| change | peak, N | C1, N / mm | C2, N / mm | C3, N / mm | path | N at 3 mm | N at 6 mm | residual |",
             "|---|---|---|---|---|---|---|---|---|"]
    for row in rows:
        event = [f"{number(row[f'c{k}_force_N'])} / {number(row[f'c{k}_cod_mm'], 2)}" for k in (1, 2, 3)]
        residual = f"{row['energy_residual']:.1e}" if row["energy_residual"] is not None else "–"
        lines.append(f"| {row['change']} | {number(row['peak_force_N'])} | {' | '.join(event)} | {row['crack_path'] or '–'} | "
                     f"{number(row['force_at_3mm_N'])} | {number(row['force_at_6mm_N'])} | {residual} |")
    return "\n".join(lines)


def write_page(case, results, reference):
    rows = [row_of(name, results[name]) for name in VARIANTS if name in results]
    stem = case.stem
    with open(ROOT / f"docs/snl-{stem}.csv", "w", newline="") as file:
        writer = csv.DictWriter(file, rows[0].keys())
        writer.writeheader()
        writer.writerows(rows)
    images = ROOT / "docs/img"
    draw_curves(images / "snl-modes.png", results, ["opening", "shear", "mixed"], reference)
    draw_curves(images / "snl-plain.png", results, ["opening-plain", "shear-plain", "mixed-plain", "s3000-plain"], reference)
    draw_patterns(images / "snl-patterns.png", results, ["opening", "shear", "mixed"])
    draw_patterns(images / "snl-patterns-plain.png", results, ["opening-plain", "shear-plain", "mixed-plain"])
    if "mixed" in results:
        draw_sequence(images / "snl-sequence.png", results["mixed"], [1.0, 2.5, 4.0, 6.0])
    text = (ROOT / "docs/snl.md").read_text() if (ROOT / "docs/snl.md").exists() else "<!-- table -->\n<!-- end -->\n"
    head, rest = text.split("<!-- table -->", 1)
    tail = rest.split("<!-- end -->", 1)[1]
    (ROOT / "docs/snl.md").write_text(f"{head}<!-- table -->\n\n{table(rows)}\n\n<!-- end -->{tail}")


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
    parser.add_argument("--case", type=pathlib.Path, default=ROOT / "cases/snl/preview.toml")
    parser.add_argument("--cleave", default=str(ROOT / "cleave"))
    parser.add_argument("--page-only", action="store_true", help="run nothing")
    parser.add_argument("names", nargs="*")
    options = parser.parse_args()
    unknown = set(options.names) - set(VARIANTS)
    if unknown:
        sys.exit(f"unknown variants {sorted(unknown)}; there are {list(VARIANTS)}")
    options.output.mkdir(parents=True, exist_ok=True)
    place = {name: options.output / f"{options.case.stem}-{name}" for name in VARIANTS}
    if not options.page_only:
        for name in options.names or VARIANTS:
            if not done(place[name]):
                run(options.cleave, options.case, name, place[name])
    results = {name: directory for name, directory in place.items() if done(directory)}
    if not results:
        sys.exit("no finished run")
    write_page(options.case, results, read_reference())


if __name__ == "__main__":
    main()
