#!/usr/bin/python3
"""Reads the frames of `frontalis run --vtp --vtu` with VTK's readers: read_vtk.py PROGRAM"""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

try:
    from vtkmodules.vtkFiltersVerdict import vtkCellSizeFilter
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader, vtkXMLUnstructuredGridReader
except ImportError as error:
    print('skipped: python3-vtk9 is not installed:', error)
    sys.exit(77)

SCENE = os.path.join(os.path.dirname(__file__), '../ros/small.yaml')


def read(reader, path):
    reader.SetFileName(path)
    assert reader.CanReadFile(path), path
    reader.Update()
    return reader.GetOutput()


def series(folder, name):
    entries = xml.parse(os.path.join(folder, name)).getroot().findall('Collection/DataSet')
    return ([float(entry.get('timestep')) for entry in entries],
            [os.path.join(folder, entry.get('file')) for entry in entries])


def check_displacements(first, last):
    """Returns by how much points rise [m]."""
    moved = last.GetPointData().GetVectors('displacement')
    rises = 0
    for point in range(last.GetNumberOfPoints()):
        for now, before, by in zip(last.GetPoint(point), first.GetPoint(point), moved.GetTuple3(point)):
            assert abs(now - before - by) < 1e-7, (point, now, before, by)
        rises = max(rises, moved.GetTuple3(point)[2])
    return rises


def volumes(grid):
    sizes = vtkCellSizeFilter()
    sizes.SetInputData(grid)
    sizes.Update()
    array = sizes.GetOutput().GetCellData().GetArray('Volume')
    return [array.GetValue(cell) for cell in range(array.GetNumberOfTuples())]


def check_tissue(first, last):
    assert last.GetNumberOfCells() == first.GetNumberOfCells() > 0
    data = last.GetCellData()
    for name, components in (('von_mises_stress', 1), ('cauchy_stress', 6), ('green_lagrange_strain', 6), ('muscle', 1),
                             ('fibre_stretch', 1), ('material', 1), ('fill', 1)):
        assert data.GetArray(name).GetNumberOfComponents() == components, name
    ratio = data.GetArray('volume_ratio')
    for cell, (now, then) in enumerate(zip(volumes(last), volumes(first))):
        # a hexahedron's volume is not that of its centre's deformation
        assert now > 0 and abs(now / then - ratio.GetValue(cell)) < 0.1, (cell, now, then, ratio.GetValue(cell))
    assert data.GetArray('von_mises_stress').GetRange()[1] > 1e3
    names = last.GetFieldData().GetAbstractArray('muscles')
    assert data.GetArray('muscle').GetRange()[1] < names.GetNumberOfValues()
    assert names.GetValue(0) == 'lift', names.GetValue(0)


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        arguments = ['run', SCENE, '--expression', 'shorten', '--seconds', '0.2', '--frames', folder, '--vtp', '--vtu']
        subprocess.run([program] + arguments + ['--threads', '1'], check=True, stdout=subprocess.PIPE)
        times, skins = series(folder, 'skin.pvd')
        first, last = (read(vtkXMLPolyDataReader(), skins[end]) for end in (0, -1))
        tissue_times, tissues = series(folder, 'tissue.pvd')
        tissue_first, tissue_last = (read(vtkXMLUnstructuredGridReader(), tissues[end]) for end in (0, -1))

    assert times[0] == 0 and abs(times[-1] - 0.2) < 1e-6 and times == sorted(times), times
    assert tissue_times == times
    assert last.GetNumberOfPoints() == first.GetNumberOfPoints() > 0
    assert last.GetNumberOfPolys() == first.GetNumberOfPolys() > 0
    assert all(last.GetCell(cell).GetNumberOfPoints() == 3 for cell in range(last.GetNumberOfCells()))
    normals = last.GetPointData().GetNormals()
    for point in range(last.GetNumberOfPoints()):
        assert abs(sum(n * n for n in normals.GetTuple3(point)) - 1) < 1e-5
    rises = check_displacements(first, last)
    assert rises > 1e-3, rises
    check_displacements(tissue_first, tissue_last)
    check_tissue(tissue_first, tissue_last)
    print('%d frames of %d points, which rise by up to %.2f mm' % (len(times), last.GetNumberOfPoints(), 1e3 * rises))


main(sys.argv[1])
