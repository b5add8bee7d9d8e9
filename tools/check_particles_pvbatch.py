"""Open the particle series of a result directory in ParaView and compare what it shows with the files.

    xvfb-run -a pvbatch tools/check_particles_pvbatch.py DIR [PICTURE.png]

Debian's pvbatch needs a display, hence xvfb-run. Needs: paraview python3-paraview python3-h5py xvfb xauth.
Checks the true times of the series, the number of points and vertex cells, and name, components and range of every
field of every frame. Exit 0: all good; 1: the first problem is printed.
"""
import sys

import h5py
import numpy
from paraview import servermanager, simple
from pvbatch_series import close, open_series, require


def check_frame(reader, path, time):
    simple.UpdatePipeline(time, reader)
    shown = servermanager.Fetch(reader)
    if shown.IsA("vtkMultiBlockDataSet"):
        shown = shown.GetBlock(0)
    with h5py.File(path) as file:
        require(file.attrs["time"] == time, f"{path}: time {file.attrs['time']} is not {time} of the series")
        points = file["VTKHDF/Points"][:]
        require(shown.GetNumberOfPoints() == len(points), f"{path}: {shown.GetNumberOfPoints()} points are shown")
        require(shown.GetNumberOfCells() == len(points), f"{path}: {shown.GetNumberOfCells()} cells are shown")
        low, high = points.min(axis=0), points.max(axis=0)
        require(close(shown.GetBounds(), numpy.stack([low, high], axis=1).ravel()), f"{path}: bounds {shown.GetBounds()}")
        for name, data in file["VTKHDF/PointData"].items():
            array = shown.GetPointData().GetArray(name)
            require(array is not None, f"{path}: field '{name}' is not shown")
            values = data[:].reshape(len(points), -1)
            require(array.GetNumberOfComponents() == values.shape[1], f"{path}: components of '{name}'")
            for component in range(values.shape[1]):
                expected = (values[:, component].min(), values[:, component].max())
                require(close(array.GetRange(component), expected), f"{path}: range of '{name}' {component}")
    print(f"{path}: {len(points)} particles, {shown.GetPointData().GetNumberOfArrays()} fields, t = {time:.6g} ms")


def draw(reader, picture):
    view = simple.GetActiveViewOrCreate("RenderView")
    view.ViewSize = [800, 600]
    display = simple.Show(reader, view)
    display.SetRepresentationType("Points")
    display.PointSize = 6
    if "damage" in reader.PointData.keys():
        simple.ColorBy(display, ("POINTS", "damage"))
    view.ResetCamera()
    simple.Render(view)
    simple.SaveScreenshot(picture, view)


def main():
    reader, entries = open_series(sys.argv[1], "particles.hdf.series")
    for path, time in entries:
        check_frame(reader, path, time)
    if len(sys.argv) > 2:
        draw(reader, sys.argv[2])


main()
