"""Tables that are kept in the repository."""
import csv
import os


def write_rows(path, rows):
    """Replace a table by rows, dicts whose keys need not be the same; the old one stays if that fails."""
    fresh = path.with_name(f".{path.name}.tmp")
    with open(fresh, "w", newline="") as file:
        writer = csv.DictWriter(file, dict.fromkeys(key for row in rows for key in row), lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    os.replace(fresh, path)
