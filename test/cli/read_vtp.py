#!/usr/bin/python3
"""Reads the frames of `frontalis run --vtp` with VTK's reader: read_vtp.py PROGRAM"""
import os
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

try:
    from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
except ImportError as error:
    print('skipped: python3-vtk9 is not installed:', error)
    sys.exit(77)

SCENE = os.path.join(os.path.dirname(__file__), '../ros/small.yaml')


def read(path):
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(path)
    assert reader.CanReadFile(path), path
    reader.Update()
    return reader.GetOutput()


def main(program):
    with tempfile.TemporaryDirectory() as folder:
        arguments = ['run', SCENE, '--expression', 'shorten', '--seconds', '0.2', '--frames', folder, '--vtp', '--threads', '1']
        subprocess.run([program] + arguments, check=True, stdout=subprocess.PIPE)
        series = xml.parse(os.path.join(folder, 'skin.pvd')).getroot().findall('Collection/DataSet')
        times = [float(entry.get('timestep')) for entry in series]
        first, last = (read(os.path.join(folder, series[end].get('file'))) for end in (0, -1))

    assert times[0] == 0 and abs(times[-1] - 0.2) < 1e-6 and times == sorted(times), times
    assert last.GetNumberOfPoints() == first.GetNumberOfPoints() > 0
    assert last.GetNumberOfPolys() == first.GetNumberOfPolys() > 0
    assert all(last.GetCell(cell).GetNumberOfPoints() == 3 for cell in range(last.GetNumberOfCells()))
    moved = last.GetPointData().GetVectors('displacement')
    normals = last.GetPointData().GetNormals()
    rises = 0
    for point in range(last.GetNumberOfPoints()):
        for now, before, by in zip(last.GetPoint(point), first.GetPoint(point), moved.GetTuple3(point)):
            assert abs(now - before - by) < 1e-7, (point, now, before, by)
        assert abs(sum(n * n for n in normals.GetTuple3(point)) - 1) < 1e-5
        rises = max(rises, moved.GetTuple3(point)[2])
    assert rises > 1e-3, rises
    print('%d frames of %d points, which rise by up to %.2f mm' % (len(times), last.GetNumberOfPoints(), 1e3 * rises))


main(sys.argv[1])
