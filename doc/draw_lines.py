#!/usr/bin/env python3
"""Draws foreheads side by side in raking light from above: draw_lines.py PICTURE.png TITLE=SKIN.ply ...

Each SKIN.ply is a frame that `frontalis run SCENE --frames FOLDER` wrote. Needs python3-vtk9; without a display run it under xvfb-run.
"""
import sys

import vtk

SIZE = (480, 350)


def skin(path):
    reader = vtk.vtkPLYReader()
    reader.SetFileName(path)
    mapper = vtk.vtkPolyDataMapper()
    mapper.SetInputConnection(reader.GetOutputPort())
    mapper.ScalarVisibilityOff()
    actor = vtk.vtkActor()
    actor.SetMapper(mapper)
    actor.GetProperty().SetColor(0.86, 0.70, 0.61)
    actor.GetProperty().SetAmbient(0.08)
    return actor


def main(picture, frames):
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(SIZE[0] * len(frames), SIZE[1])
    window.SetMultiSamples(8)
    for i, (title, path) in enumerate(f.split("=", 1) for f in frames):
        renderer = vtk.vtkRenderer()
        renderer.SetViewport(i / len(frames), 0, (i + 1) / len(frames), 1)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(skin(path))
        renderer.AutomaticLightCreationOff()
        for place, strength in (((0.35, 0.3, 1), 1), ((1, 0, 0), 0.18)):
            light = vtk.vtkLight()
            light.SetLightTypeToSceneLight()
            light.SetPosition(*place)
            light.SetIntensity(strength)
            renderer.AddLight(light)
        label = vtk.vtkTextActor()
        label.SetInput(title)
        label.SetPosition(10, 8)
        label.GetTextProperty().SetColor(0.1, 0.1, 0.1)
        label.GetTextProperty().SetFontSize(16)
        renderer.AddActor2D(label)
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(0, 0, 0.047)
        camera.SetPosition(0.5, 0, 0.09)
        camera.SetViewUp(0, 0, 1)
        camera.SetParallelProjection(1)
        camera.SetParallelScale(0.042)
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


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    main(sys.argv[1], sys.argv[2:])
