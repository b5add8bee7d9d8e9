#!/usr/bin/python3
"""Read every VDB file of a result directory with pyopenvdb and check what viewers rely on.

    tools/check_vdb.py FILE.vdb|DIR...        exit 0: all good; 1: the first problem is printed

Needs the Debian package python3-openvdb, whose readAll refuses a file with any grid that is not float, bool or vec3s.
"""
import pathlib
import sys

import pyopenvdb

SCALARS = {"density", "damage", "eq_plastic_strain"}
VECTORS = {"velocity", "vel"}


def require(condition, path, text):
    if not condition:
        sys.exit(f"{path}: {text}")


def check(path):
    grids, metadata = pyopenvdb.readAll(str(path))
    for key in ("time", "step", "units", "creator", "scene_units_per_mm"):
        require(key in metadata, path, f"no metadata '{key}'")
    require(grids, path, "no grids")
    transform = grids[0].transform
    for grid in grids:
        require(grid.name in SCALARS | VECTORS, path, f"unexpected grid '{grid.name}'")
        kind = pyopenvdb.Vec3SGrid if grid.name in VECTORS else pyopenvdb.FloatGrid
        require(isinstance(grid, kind), path, f"'{grid.name}' is a {grid.valueTypeName} grid")
        require(grid.saveFloatAsHalf, path, f"'{grid.name}' is not stored as half floats")
        require(grid.transform == transform, path, f"'{grid.name}' lies elsewhere than '{grids[0].name}'")
        require(grid.activeVoxelCount() == grids[0].activeVoxelCount(), path, f"'{grid.name}' covers other voxels")
        if grid.name in SCALARS:
            require(grid.gridClass == "fog volume", path, f"'{grid.name}' has class '{grid.gridClass}'")
            low, high = grid.evalMinMax()
            require(low >= 0, path, f"'{grid.name}' is negative: {low}")
            require(grid.name != "damage" or high <= 1, path, f"damage above 1: {high}")
    text = ", ".join(f"{grid.name} {grid.activeVoxelCount()} voxels" for grid in grids)
    density = {grid.name: grid for grid in grids}.get("density")
    if density is not None:
        scale = metadata["scene_units_per_mm"]
        voxel = (density.transform.voxelSize()[0] / scale) ** 3
        mass = voxel * sum(item.value * item.count for item in density.iterOnValues())
        text += f"; mass {mass:.6g} g"
    print(f"{path}: t = {metadata['time']:.6g} ms, {text}")


def main():
    paths = []
    for name in sys.argv[1:]:
        path = pathlib.Path(name)
        paths += sorted(path.glob("**/vol_*.vdb")) if path.is_dir() else [path]
    if not paths:
        sys.exit(__doc__ if len(sys.argv) < 2 else "no vol_*.vdb found")
    for path in paths:
        check(path)


if __name__ == "__main__":
    main()
