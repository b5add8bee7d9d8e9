#!/usr/bin/python3
"""Error against cost: runs the charts of docs/accuracy.md and rewrites its tables, pictures and docs/accuracy.csv.

usage: tools/accuracy_page.py [-o DIRECTORY] [--cleave PROGRAM] [--page-only]

Runs the quick suite and, of the full one, the scenes of FULL into DIRECTORY (default results/accuracy); what is done there is not
run again. `--page-only` writes the page from what is there; scenes that are not there keep their rows of docs/accuracy.csv. Nothing
else should run meanwhile: the cost is processor time.
"""
import argparse
import csv
import pathlib
import re
import shutil
import subprocess
import sys

from csv_rows import write_rows
from marked_page import replaced
from patient_call import call

ROOT = pathlib.Path(__file__).resolve().parent.parent
FULL = ["c19-dcb", "c22-compact-tension", "c28-challenge"]
# Scene of the suites: its name on the page, and what is asked.
SCENES = {
    "c1-waves": ("C1 waves, displacement", "manufactured solution, one period, stretch 16 %"),
    "c1-stress": ("C1 waves, stress", "the same"),
    "c1-two-level": ("C1 on two levels", "the same across a level interface"),
    "c3-vortex": ("C3 vortex", "rotation and shear in a ring with curved free rims, largest angle"),
    "c5-bar": ("C5 bar", "period of the first mode"),
    "c8-cantilever": ("C8 cantilever", "bent by half its length; the reference does not shear, which is 0.9 %"),
    "c9-spin": ("C9 spin", "energy after twenty turns"),
    "c10-hole": ("C10 hole, stretch", "plate with a hole, two levels"),
    "c10-stress": ("C10 hole, peak stress", "the same; stress of the outermost particle, first order"),
    "c11-cylinder": ("C11 cylinder", "Hill, 6 % below the limit pressure"),
    "c12-taylor": ("C12 Taylor bar", "radius of the foot; published results differ by 4 %"),
    "c13-necking": ("C13 necking", "force plateau of a bar that necks, Considère"),
    "c14-strip": ("C14 notched strip", "limit load, slip-line field, two levels"),
    "c15-interface": ("C15 interface", "reflection where cells become finer, closed form"),
    "c17-bar-crack": ("C17 bar crack", "fracture energy times area"),
    "c18-shear-band": ("C18 shear band", "the same in shear"),
    "c19-dcb": ("C19 double cantilever", "mean force while the crack runs, Fichter"),
    "c20-crack": ("C20 crack", "stress intensity under step tension, Freund, two levels"),
    "c22-compact-tension": ("C22 compact tension", "largest force while a crack is driven, three levels; fracture mechanics"),
    "c23-kalthoff": ("C23 impact on a notch", "angle of the crack (Kalthoff), against 68 degrees (experiment about 70, simulations 60 to 70)"),
    "c28-challenge": ("C28 challenge specimen", "mean force while the ligaments flow, two levels; limit of three pairs of cells"),
}
# Where the finer cells of the scenes with a localised feature are.
FINER = {
    "c10-hole": "within 1.9 radii of the centre of the hole, of a plate of 5 by 5",
    "c10-stress": "the same",
    "c14-strip": "within 1.9 half widths of the ligament",
    "c19-dcb": "within 1 mm of the crack's plane, of an arm of 5 mm",
    "c20-crack": "within 1 mm of the tip, of 10 x 2 mm",
    "c28-challenge": "along the ligaments, a tenth of the plate",
}
WANTED = ("10%", "5%", "2%")


def chart(program, directory, arguments):
    code = call([program, "chart", *arguments, "-o", directory], cwd=ROOT)
    if code:
        sys.exit(f"{program} chart {' '.join(arguments)}: ended with code {code}; the same command goes on")


def read_rows(path):
    if not path.exists():
        return {}
    with open(path, newline="") as file:
        rows = list(csv.DictReader(file))
    return {scene: [row for row in rows if row["scene"] == scene] for scene in dict.fromkeys(row["scene"] for row in rows)}


def merge(quick, full):
    """docs/accuracy.csv of the charts, scenes in the order of SCENES; those of FULL never from the quick suite."""
    by_scene = read_rows(ROOT / "docs/accuracy.csv")
    by_scene |= {scene: rows for scene, rows in read_rows(quick / "chart.csv").items() if scene not in FULL}
    by_scene |= {scene: rows for scene, rows in read_rows(full / "chart.csv").items() if rows[0]["status"] != "pending"}
    rows = [row for rows in by_scene.values() for row in rows]
    unknown = {row["scene"] for row in rows} - set(SCENES)
    if unknown:
        sys.exit(f"scenes without a name in {pathlib.Path(__file__).name}: {', '.join(sorted(unknown))}")
    order = list(SCENES)
    rows.sort(key=lambda row: order.index(row["scene"]))
    for row in rows:  # another program than this tree's own has its cases elsewhere
        row["case"] = row["case"][row["case"].index("cases/"):]
    write_rows(ROOT / "docs/accuracy.csv", rows)
    return rows


def summaries(program):
    """Cells of the table of docs/accuracy.csv by scene and head."""
    text = subprocess.run([program, "chart", "--summary", "--from", ROOT / "docs/accuracy.csv"], cwd=ROOT, capture_output=True, text=True,
                          check=True).stdout
    head, *lines = [re.split(r"\s{2,}", line.strip()) for line in text.splitlines()]
    return {cells[0]: dict(zip(head, cells)) for cells in lines}


def scene_table(summary):
    lines = ["| scene | settings | error of the case as shipped | cost over the front | what it asks |", "|---|---|---|---|---|"]
    for scene, cells in summary.items():
        name, asked = SCENES[scene]
        lines.append(f"| {name} | {cells['settings']} | {cells['default: error']} | {cells['over the front']} | {asked} |")
    over = [float(cells["over the front"]) for cells in summary.values() if cells["over the front"] != "-"]
    lines += ["", f"The defaults lie on the front or within 20 % of it in {sum(x <= 1.2 for x in over)} of the {len(over)} charts; "
                  f"{sum(int(cells['settings'].split()[0]) >= 20 for cells in summary.values())} charts hold 20 settings or more."]
    return "\n".join(lines)


def gain_table(summary):
    lines = ["| scene | finer cells | gain |", "|---|---|---|"]
    lines += [f"| {SCENES[scene][0]} | {where} | {summary[scene]['several levels gain']} |" for scene, where in FINER.items() if scene in summary]
    return "\n".join(lines)


def advice_table(program):
    lines = ["| wanted error | advised setting met it | missed | met at, of the cheapest run that does | not measured there, no advice, or no run that accurate |",
             "|---|---|---|---|---|"]
    for wanted in WANTED:
        text = subprocess.run([program, "chart", "--leave-one-out", "--error", wanted, "--from", ROOT / "docs/accuracy.csv"],
                              cwd=ROOT, capture_output=True, text=True, check=True).stdout
        cells = [re.split(r"\s{2,}", line) for line in text.splitlines()[1:-1]]
        met = [row for row in cells if row[1] == "met"]
        missed = [f"{SCENES[row[0]][0]}, {row[2]}" for row in cells if row[1] == "missed"]
        costs = [float(row[3]) for row in met]
        lines.append(f"| {wanted.replace('%', ' %')} | {len(met)} of {len(met) + len(missed)} scenes | {'; '.join(missed) or '–'} | "
                     f"{min(costs):.2g} to {max(costs):.2g} times | {len(cells) - len(met) - len(missed)} |")
    return "\n".join(lines)


def facts(rows):
    """What was run, and the processor time of both suites."""
    spent = [sum(float(row["cpu_s"] or 0) for row in rows if (row["scene"] in FULL) == full) / 60 for full in (False, True)]
    runs = sum(row["status"] not in ("not applicable", "pending") for row in rows)
    cases = len({row["case"] for row in rows})
    return (f"{len({row['scene'] for row in rows})} charts on {cases} cases, {runs} runs: {spent[0]:.0f} min of processor time in the quick "
            f"suite, {spent[1]:.0f} min in {', '.join(SCENES[scene][0] for scene in FULL)} of the full one.")


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("-o", "--output", type=pathlib.Path, default=ROOT / "results/accuracy")
    parser.add_argument("--cleave", default=ROOT / "cleave", help="program to run")
    parser.add_argument("--page-only", action="store_true")
    options = parser.parse_args()
    output = options.output.resolve()
    directories = [output / "quick", output / "full"]
    if not options.page_only:
        chart(options.cleave, directories[0], ["--quick"])
        chart(options.cleave, directories[1], [part for scene in FULL for part in ("--scene", scene)])
    rows = merge(*directories)
    subprocess.run([ROOT / "tools/plot_chart.py", ROOT / "docs/accuracy.csv", "-o", output / "plots"], check=True)
    for scene in SCENES:
        shutil.copyfile(output / "plots" / f"{scene}.png", ROOT / "docs/img/accuracy" / f"{scene}.png")
    summary = summaries(options.cleave)
    page = ROOT / "docs/accuracy.md"
    text = page.read_text()
    for mark, table in (("facts", facts(rows)), ("scenes", scene_table(summary)), ("gains", gain_table(summary)),
                        ("advice", advice_table(options.cleave))):
        text = replaced(text, mark, table)
    page.write_text(text)


if __name__ == "__main__":
    main()
