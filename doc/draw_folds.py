#!/usr/bin/env python3
"""Measures and draws the folds of a forehead: draw_folds.py PICTURE.png TITLE=FRAMES ...

FRAMES is a folder that `frontalis run SCENE --frames FRAMES` wrote. Prints the number, spacing and depth of the furrows in its last
frame, along lines up the forehead, and draws all frames side by side in light that comes from above at a grazing angle. Needs
python3-vtk9; without a display run it under xvfb-run.
"""
import pathlib
import sys

import numpy
import vtk
from vtk.util.numpy_support import vtk_to_numpy

LINES = (-30, -25, -20, -15, 15, 20, 25, 30)  # y of the lines [mm]; frontalis lies below them
RANGE = (25, 75)  # z at rest between brow and hairline [mm]
SMOOTH = 7.0  # [mm] standard deviation of the filter whose result is the skin without folds
LEAST = 0.15  # depth below both neighbouring ridges from which a furrow counts [mm]


def read(path):
    reader = vtk.vtkPLYReader()
    reader.SetFileName(str(path))
    reader.Update()
    return reader.GetOutput()


def points(mesh):
    return vtk_to_numpy(mesh.GetPoints().GetData()).astype(float) * 1e3


def furrows(rest, now, y):
    """Arc lengths [mm] of the furrows along the line at this y, and their depths [mm]."""
    near = (abs(rest[:, 1] - y) < 2) & (rest[:, 2] > RANGE[0] - 15) & (rest[:, 2] < RANGE[1] + 8) & (rest[:, 0] > -60)
    height = numpy.arange(RANGE[0] - 12, RANGE[1] + 5, 0.25)
    weight = numpy.exp(-((rest[near, 2][None] - height[:, None]) ** 2 + (rest[near, 1] - y)[None] ** 2) / (2 * 0.7 ** 2))
    line = weight @ now[near] / weight.sum(1)[:, None]
    line = line[:, [0, 2]]
    arc = numpy.concatenate([[0], numpy.cumsum(numpy.hypot(*numpy.diff(line, axis=0).T))])
    filter_ = numpy.exp(-((arc[:, None] - arc[None]) / SMOOTH) ** 2 / 2)
    smooth = filter_ @ line / filter_.sum(1)[:, None]
    along = numpy.gradient(smooth, axis=0)
    out = numpy.stack([along[:, 1], -along[:, 0]], 1) / numpy.hypot(*along.T)[:, None]
    depth = -((line - smooth) * out).sum(1)
    inside = (height > RANGE[0]) & (height < RANGE[1])
    places, depths = [], []
    extremes = [i for i in range(1, len(arc) - 1) if inside[i] and (depth[i] - depth[i - 1]) * (depth[i + 1] - depth[i]) <= 0]
    for i in extremes:
        if depth[i] < depth[i - 1] or depth[i] < depth[i + 1]:
            continue
        ridges = []
        for step in (-1, 1):
            k = i
            while 0 < k < len(arc) - 1 and depth[k + step] <= depth[k]:
                k += step
            ridges.append(depth[i] - depth[k])
        if min(ridges) > LEAST:
            places.append(arc[i])
            depths.append(numpy.mean(ridges))
    return places, depths


def measure(rest, now):
    counts, gaps, depths = [], [], []
    for y in LINES:
        places, deep = furrows(rest, now, y)
        counts.append(len(places))
        gaps += list(numpy.diff(places))
        depths += deep
    return numpy.mean(counts), numpy.median(gaps) if gaps else numpy.nan, numpy.mean(depths) if depths else numpy.nan


def draw(meshes, picture, columns):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    rows = -(-len(meshes) // columns)
    window.SetSize(296 * columns, 232 * rows)
    window.SetMultiSamples(8)
    for k, (title, mesh) in enumerate(meshes):
        normals = vtk.vtkPolyDataNormals()
        normals.SetInputData(mesh)
        normals.SplittingOff()
        mapper = vtk.vtkPolyDataMapper()
        mapper.SetInputConnection(normals.GetOutputPort())
        mapper.ScalarVisibilityOff()
        actor = vtk.vtkActor()
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(0.86, 0.70, 0.61)
        actor.GetProperty().SetAmbient(0.08)
        renderer = vtk.vtkRenderer()
        row, column = divmod(k, columns)
        renderer.SetViewport(column / columns, 1 - (row + 1) / rows, (column + 1) / columns, 1 - row / rows)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(actor)
        renderer.AutomaticLightCreationOff()
        for place, strength in (((0.25, 0.35, 1.0), 1.0), ((1.0, 0.0, 0.0), 0.18)):
            light = vtk.vtkLight()
            light.SetLightTypeToSceneLight()
            light.SetPosition(*place)
            light.SetFocalPoint(0, 0, 0)
            light.SetIntensity(strength)
            renderer.AddLight(light)
        label = vtk.vtkTextActor()
        label.SetInput(title)
        label.SetPosition(10, 8)
        label.GetTextProperty().SetColor(0.1, 0.1, 0.1)
        label.GetTextProperty().SetBackgroundColor(1, 1, 1)
        label.GetTextProperty().SetBackgroundOpacity(1)
        label.GetTextProperty().SetFontSize(14)
        renderer.AddActor2D(label)
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(0.0, 0, 0.047)
        camera.SetPosition(0.5, 0, 0.09)
        camera.SetViewUp(0, 0, 1)
        camera.SetParallelProjection(1)
        camera.SetParallelScale(0.047)
        renderer.ResetCameraClippingRange()
        window.AddRenderer(renderer)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


def main(picture, folders):
    print("%-34s %9s %13s %11s" % ("", "furrows", "spacing [mm]", "depth [mm]"))
    meshes = []
    for title, folder in (f.split("=", 1) for f in folders):
        frames = sorted(pathlib.Path(folder).glob("skin_*.ply"))
        rest, now = read(frames[0]), read(frames[-1])
        print("%-34s %9.1f %13.1f %11.2f" % ((title,) + measure(points(rest), points(now))))
        meshes.append((title, now))
    draw(meshes, picture, 3)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
