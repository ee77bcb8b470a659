#!/usr/bin/env python3
"""Draws skins in raking light: draw_folds.py PICTURE.png TITLE=FILE.ply ...

FILE.ply is a frame that `frontalis run SCENE --frames FOLDER` wrote. The light comes from above, which shows lines
across the forehead; TITLE=left:FILE.ply has it from the subject's left, for lines that run up. On heads, `brows:` and
`root:` show what is between the brows, lit from the left and from above, and `eye:` what is beside the left eye. A
single row of skins is drawn larger. Needs python3-vtk9; without a display run it under xvfb-run.
"""
import sys

import vtk

COLUMNS = 3
# of each view: where the light comes from; middle [m], direction towards the camera, half of the height [m]
FOREHEAD = (0, 0, 0.043), (1, 0, 0.084), 0.05
BROWS = (0, 0, 0.014), (1, 0, 0.1), 0.032
VIEWS = {"above": ((0.25, 0.35, 1.0), *FOREHEAD), "left": ((0.35, 1.0, 0.2), *FOREHEAD),
         "brows": ((0.4, 0.9, 0.45), *BROWS), "root": ((0.4, 0.2, 1.0), *BROWS),
         "eye": ((0.9, 0.3, 0.8), (-0.015, 0.05, -0.01), (0.7, 0.7, 0.1), 0.026)}


def read(path):
    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    reader.Update()
    return reader.GetOutput()


def draw(meshes, picture):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    columns = min(COLUMNS, len(meshes))
    rows = -(-len(meshes) // columns)
    width, height = (296, 232) if rows > 1 else (480, 376)
    window.SetSize(width * columns, height * rows)
    window.SetMultiSamples(8)
    for k, (title, view, mesh) in enumerate(meshes):
        light_from, middle, towards, half = VIEWS[view]
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
        for place, strength in ((light_from, 0.85), (towards, 0.3)):
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
        camera.SetFocalPoint(*middle)
        camera.SetPosition(*(m + 0.5 * t for m, t in zip(middle, towards)))
        camera.SetViewUp(0, 0, 1)
        camera.SetParallelProjection(1)
        camera.SetParallelScale(half)
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


def main(picture, frames):
    meshes = []
    for title, path in (f.split("=", 1) for f in frames):
        view, path = path.split(":", 1) if ":" in path else ("above", path)
        meshes.append((title, view, read(path)))
    draw(meshes, picture)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
