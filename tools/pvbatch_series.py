"""What the ParaView checks share: opening a series of frames and comparing numbers. Imported by check_*_pvbatch.py."""
import json
import pathlib
import sys

import numpy
from paraview import simple


def require(condition, text):
    if not condition:
        print(text, flush=True)
        sys.exit(1)


def close(a, b):
    return numpy.allclose(a, b, rtol=1e-5, atol=1e-6 * (1 + abs(numpy.array(b)).max()))


def open_series(folder, name):
    """Reader and entries (path, time) of a series below a folder; the times ParaView sees must be those of the table."""
    series = next(pathlib.Path(folder).glob(f"**/{name}"), None)
    require(series is not None, f"{folder}: no {name}")
    entries = [(series.parent / entry["name"], entry["time"]) for entry in json.loads(series.read_text())["files"]]
    reader = simple.OpenDataFile(str(series))
    require(reader is not None, f"{series}: no reader found")
    simple.UpdatePipeline(proxy=reader)
    times = reader.TimestepValues
    times = list(times) if hasattr(times, "__len__") else [times]
    require(numpy.allclose(times, [time for _, time in entries]), f"{series}: ParaView sees the times {times}")
    return reader, entries
