#!/usr/bin/python3
"""Bakes the generated forehead and reads the file with ParaView's reader: read_with_vtk.py PROGRAM"""
import os
import subprocess
import sys
import tempfile

try:
    from vtkmodules.vtkIOHDF import vtkHDFReader
except ImportError as error:
    print('skipped: python3-vtk9 is not installed:', error)
    sys.exit(77)

SCENE = os.path.join(os.path.dirname(__file__), '../../config/forehead.yaml')
FREE, RIGID, SLIDING = 0, 1, 2


def bake(program, path):
    """Bakes the model and returns the numbers that the program prints, by their names."""
    said = subprocess.run([program, 'bake', SCENE, '--voxel', '3', '-o', path], check=True, stdout=subprocess.PIPE)
    lines = [line.split() for line in said.stdout.decode().splitlines()]
    voxels = next(words for words in lines if words[0] == 'voxels' and words[1] != '...')
    nodes = next(words for words in lines if words[0] == 'nodes')
    return int(voxels[1]), int(nodes[1].strip(',')), int(nodes[5].strip(',')), int(nodes[7])


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, 'forehead.vtkhdf')
        voxels, nodes, rigid, sliding = bake(program, path)
        reader = vtkHDFReader()
        reader.SetFileName(path)
        assert reader.CanReadFile(path)
        reader.Update()
        grid = reader.GetOutput()

    assert grid.GetNumberOfCells() == voxels, grid.GetNumberOfCells()
    assert grid.GetNumberOfPoints() == nodes, grid.GetNumberOfPoints()
    for cell in (0, voxels // 2, voxels - 1):
        low, high = grid.GetCell(cell).GetBounds()[::2], grid.GetCell(cell).GetBounds()[1::2]
        assert all(abs(b - a - 3e-3) < 1e-6 for a, b in zip(low, high)), (low, high)
    cells, points = grid.GetCellData(), grid.GetPointData()
    for name in ('material', 'fill', 'muscle', 'muscle_weight', 'fibre'):
        assert cells.GetArray(name).GetNumberOfTuples() == voxels, name
    fill = [cells.GetArray('fill').GetValue(cell) for cell in range(voxels)]
    assert 0 < min(fill) and max(fill) <= 1, (min(fill), max(fill))
    fibre, muscle = cells.GetArray('fibre'), cells.GetArray('muscle')
    for cell in range(voxels):
        length = sum(c * c for c in fibre.GetTuple3(cell))
        assert abs(length - (1 if muscle.GetValue(cell) >= 0 else 0)) < 1e-5, (cell, length)
    assert {muscle.GetValue(cell) for cell in range(voxels)} == set(range(-1, 5))
    constraint = [int(points.GetArray('constraint').GetValue(node)) for node in range(nodes)]
    assert constraint.count(RIGID) == rigid and constraint.count(SLIDING) == sliding
    assert constraint.count(FREE) == nodes - rigid - sliding
    held_by = [int(points.GetArray('held_by').GetValue(node)) for node in range(nodes)]
    assert set(held_by) == set(range(-1, 6)), set(held_by)
    assert all((by < 0) == (kind == FREE) for by, kind in zip(held_by, constraint))
    print(voxels, 'voxels and', nodes, 'nodes read back')


if __name__ == '__main__':
    main(sys.argv[1])
