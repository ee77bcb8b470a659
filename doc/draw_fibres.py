#!/usr/bin/env python3
"""Draws the fibres of a baked model's muscles as lines: draw_fibres.py MODEL PICTURE.png [MUSCLE...]

Lines follow the directions that voxels carry, both ways from voxels chosen evenly. Needs python3-h5py and python3-vtk9;
without a display run it under xvfb-run.
"""
import sys

import h5py
import numpy
import vtk


def read(path):
    """Voxel edges, and of each muscle by name: voxels and directions, in scene axes."""
    with h5py.File(path) as file:
        model = file["frontalis"]
        spacing = model["spacing"][...].ravel()
        turn = model["frames/to_scene_rotation"][...].reshape(3, 3)
        names = [n.decode() if isinstance(n, bytes) else n for n in model["muscles/name"][...]]
        begin = model["fibre_begin"][...]
        voxel = numpy.repeat(numpy.arange(len(begin) - 1), numpy.diff(begin))
        voxels = model["voxels"][...][voxel]
        directions, muscle = model["fibre_direction"][...], model["fibre_muscle"][...]
    return spacing, turn, {n: (voxels[muscle == m], directions[muscle == m]) for m, n in enumerate(names)}


def follow(cells, start, direction, step, spacing):
    """Points of a line from a voxel's centre on, until it leaves the muscle."""
    point, points = start.copy(), [start.copy()]
    for _ in range(400):
        here = cells.get(tuple(numpy.floor(point / spacing).astype(int)))
        if here is None:
            break
        direction = here if here @ direction >= 0 else -here
        point = point + step * direction
        points.append(point.copy())
    return points


def lines_of(voxels, directions, spacing, wanted=110):
    cells = {tuple(v): d for v, d in zip(voxels, directions)}
    lines = []
    for i in numpy.linspace(0, len(voxels) - 1, min(wanted, len(voxels))).astype(int):
        start, step = (voxels[i] + 0.5) * spacing, 0.4 * spacing.min()
        forth = follow(cells, start, directions[i], step, spacing)
        back = follow(cells, start, -directions[i], step, spacing)
        lines.append(back[:0:-1] + forth)
    return lines


def actor_of(lines, turn, radius):
    points, cells = vtk.vtkPoints(), vtk.vtkCellArray()
    for line in lines:
        cells.InsertNextCell(len(line))
        for point in line:
            cells.InsertCellPoint(points.InsertNextPoint(*(turn @ point)))
    data = vtk.vtkPolyData()
    data.SetPoints(points)
    data.SetLines(cells)
    tubes = vtk.vtkTubeFilter()
    tubes.SetInputData(data)
    tubes.SetRadius(radius)
    tubes.SetNumberOfSides(8)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(tubes.GetOutputPort())
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.66, 0.22, 0.2)
    return actor


def draw(path, picture, wanted):
    spacing, turn, muscles = read(path)
    unknown = [name for name in wanted if name not in muscles]
    if unknown:
        sys.exit(f"{path}: no muscle is called {', '.join(unknown)}; there are {', '.join(muscles)}")
    names = wanted or [name for name, (voxels, _) in muscles.items() if len(voxels)]
    columns = min(3, len(names))
    rows = -(-len(names) // columns)
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(8)
    window.SetSize(420 * columns, 380 * rows)
    for k, name in enumerate(names):
        voxels, directions = muscles[name]
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        i, j = k % columns, k // columns
        renderer.SetViewport(i / columns, 1 - (j + 1) / rows, (i + 1) / columns, 1 - j / rows)
        renderer.AddActor(actor_of(lines_of(voxels, directions, spacing), turn, 0.15 * spacing.min()))
        label = vtk.vtkTextActor()
        label.SetInput(name)
        label.SetPosition(12, 12)
        label.GetTextProperty().SetColor(0.2, 0.2, 0.2)
        label.GetTextProperty().SetFontSize(18)
        renderer.AddActor(label)
        # along the muscle's thinnest direction, a little from above
        centres = ((voxels + 0.5) * spacing) @ turn.T
        axes = numpy.linalg.svd(centres - centres.mean(0), full_matrices=False)[2]
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(*centres.mean(0))
        camera.SetPosition(*(centres.mean(0) + axes[2] + 0.35 * axes[1]))
        camera.SetViewUp(*axes[1])
        renderer.ResetCamera()
        camera.Zoom(1.2)
        window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.Update()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputData(image.GetOutput())
    writer.Write()


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    draw(sys.argv[1], sys.argv[2], sys.argv[3:])
