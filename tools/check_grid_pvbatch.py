"""Open the grid series of a result directory in ParaView and compare what it shows with the files.

    xvfb-run -a pvbatch tools/check_grid_pvbatch.py DIR [PICTURE.png [FIELD]]

Debian's pvbatch needs a display, hence xvfb-run. Needs: paraview python3-paraview python3-h5py xvfb xauth.
Checks the true times of the series and, for every frame: levels, boxes, corners and spacing; every value of every
field; that the cells ParaView hides are the refined ones of the file; and that the cells it shows neither overlap nor
leave out any. The picture is a slice through the middle across the thinnest direction, with the edges of the cells.
Exit 0: all good; 1: the first problem is printed.
"""
import sys

import h5py
import numpy
from paraview import simple
from pvbatch_series import close, open_series, require
from vtk.util.numpy_support import vtk_to_numpy


def output_of(proxy):
    """The data object itself: servermanager.Fetch cannot bring overlapping AMR over in ParaView 5.11."""
    return proxy.GetClientSideObject().GetOutputDataObject(0)


def cells_of(box):
    """Indices of the cells of a box, x fastest."""
    x, y, z = (numpy.arange(box[2 * a], box[2 * a + 1] + 1) for a in range(3))
    k, j, i = numpy.meshgrid(z, y, x, indexing="ij")
    return numpy.stack([i.ravel(), j.ravel(), k.ravel()], axis=1)


def check_box(block, box, begin, end, group, origin, spacing, what):
    require(block is not None, f"{what}: not there")
    lower = origin + box[0::2] * spacing
    upper = origin + (box[1::2] + 1) * spacing
    require(close(block.GetBounds(), numpy.stack([lower, upper], axis=1).ravel()), f"{what}: bounds {block.GetBounds()}")
    require(block.GetNumberOfCells() == end - begin, f"{what}: {block.GetNumberOfCells()} cells")
    for name, data in group["CellData"].items():
        array = block.GetCellData().GetArray(name)
        require(array is not None, f"{what}: field '{name}' is not shown")
        stored = data[begin:end]
        shown = vtk_to_numpy(array)
        require(shown.shape == stored.shape and (shown == stored).all(), f"{what}: values of '{name}'")


def check_level(amr, level, group, origin, path):
    spacing = group.attrs["Spacing"]
    boxes = group["AMRBox"][:]
    require(amr.GetNumberOfDataSets(level) == len(boxes), f"{path}: boxes of level {level}")
    begin = 0
    places = []
    for number, box in enumerate(boxes):
        cells = cells_of(box)
        what = f"{path}: level {level}, box {number}"
        check_box(amr.GetDataSet(level, number), box, begin, begin + len(cells), group, origin, spacing, what)
        begin += len(cells)
        places.append(cells)
    places = numpy.concatenate(places) if places else numpy.zeros((0, 3), int)
    require(len(numpy.unique(places, axis=0)) == len(places), f"{path}: boxes of level {level} overlap")
    return places


def check_cover(places, refined, path):
    """Every refined cell has its eight finer ones, and no cell that is shown lies over a finer one."""
    for level in range(len(places) - 1):
        finer, count = numpy.unique(places[level + 1] // 2, axis=0, return_counts=True)
        below = {tuple(cell): number for cell, number in zip(finer, count)}
        for cell, hidden in zip(places[level], refined[level]):
            expected = 8 if hidden else 0
            require(below.get(tuple(cell), 0) == expected, f"{path}: level {level}, cell {cell}: cells below it")


def check_frame(reader, path, time):
    simple.UpdatePipeline(time, reader)
    amr = output_of(reader)
    require(amr.IsA("vtkOverlappingAMR"), f"{path}: ParaView makes a {amr.GetClassName()} of it")
    with h5py.File(path) as file:
        require(file.attrs["time"] == time, f"{path}: time {file.attrs['time']} is not {time} of the series")
        root = file["VTKHDF"]
        levels = [root[f"Level{level}"] for level in range(len(root))]
        require(amr.GetNumberOfLevels() == len(levels), f"{path}: {amr.GetNumberOfLevels()} levels are shown")
        places = [check_level(amr, level, group, root.attrs["Origin"], path) for level, group in enumerate(levels)]
        refined = [group["CellData/vtkGhostType"][:] == 8 for group in levels]
        check_cover(places, refined, path)
        fields = ", ".join(name for name in levels[0]["CellData"] if name != "vtkGhostType")
    threshold = simple.Threshold(Input=reader, AllScalars=0)
    threshold.Scalars = ["CELLS", fields.split(", ")[0]]
    threshold.LowerThreshold, threshold.UpperThreshold = -1e30, 1e30
    simple.UpdatePipeline(time, threshold)
    seen = sum(len(cells) - hidden.sum() for cells, hidden in zip(places, refined))
    shown = threshold.GetDataInformation().GetNumberOfCells()
    require(shown == seen, f"{path}: {shown} cells are seen instead of {seen}")
    simple.Delete(threshold)
    counts = " + ".join(str(len(cells) - hidden.sum()) for cells, hidden in zip(places, refined))
    print(f"{path}: {counts} cells, {fields}, t = {time:.6g} ms")
    return bounds_of(amr)


def bounds_of(amr):
    bounds = [0.0] * 6
    amr.GetBounds(bounds)
    return bounds


def draw(reader, time, bounds, picture, field):
    lower, upper = numpy.array(bounds[0::2]), numpy.array(bounds[1::2])
    normal = int(numpy.argmin(upper - lower))
    cut = simple.Slice(Input=reader)
    cut.Triangulatetheslice = 0
    cut.SliceType.Origin = list(lower + 0.49 * (upper - lower))  # between two faces of cells
    cut.SliceType.Normal = [1.0 if axis == normal else 0.0 for axis in range(3)]
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [1200, 900]
    view.ViewTime = time
    display = simple.Show(cut, view)
    display.SetRepresentationType("Surface With Edges")
    simple.ColorBy(display, ("CELLS", field))
    display.RescaleTransferFunctionToDataRange(False, True)
    display.SetScalarBarVisibility(view, True)
    if normal < 2:
        (view.ResetActiveCameraToPositiveX, view.ResetActiveCameraToPositiveY)[normal]()
    view.ResetCamera()
    simple.Render(view)
    simple.SaveScreenshot(picture, view)


def main():
    reader, entries = open_series(sys.argv[1], "grid.hdf.series")
    for path, time in entries:
        bounds = check_frame(reader, path, time)
    if len(sys.argv) > 2:
        draw(reader, entries[-1][1], bounds, sys.argv[2], sys.argv[3] if len(sys.argv) > 3 else "density")


main()
