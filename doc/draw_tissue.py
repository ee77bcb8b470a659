#!/usr/bin/env python3
"""Draws the tissue inside of a face: draw_tissue.py FOLDER NUMBER PICTURE.png

FOLDER is that of `frontalis run --frames FOLDER --vtp --vtu`, NUMBER that of a frame. On the left tissue is cut in the middle of the face and coloured by von
Mises stress, on the right only voxels with muscle are drawn, below the skin, coloured by fibre stretch. Needs python3-vtk9; without a display run it under
xvfb-run.
"""
import sys

import vtk

BLUE_TO_RED = ((0.23, 0.30, 0.75), (0.87, 0.87, 0.87), (0.71, 0.02, 0.15))
YELLOW_TO_RED = ((1.0, 0.97, 0.80), (0.99, 0.70, 0.30), (0.89, 0.20, 0.15), (0.45, 0.0, 0.15))

def actor(port, opacity=1.0):
    mapper = vtk.vtkDataSetMapper()
    mapper.SetInputConnection(port)
    made = vtk.vtkActor()
    made.SetMapper(mapper)
    made.GetProperty().SetAmbient(0.25)
    made.GetProperty().SetOpacity(opacity)
    return made


def coloured(port, array, title, lowest, highest, logarithmic, stops, renderer):
    colours = vtk.vtkLookupTable()
    colours.SetNumberOfTableValues(256)
    for entry in range(256):
        share = entry / 255 * (len(stops) - 1)
        stop = min(int(share), len(stops) - 2)
        colours.SetTableValue(entry, *(a + (share - stop) * (b - a) for a, b in zip(stops[stop], stops[stop + 1])))
    colours.SetRange(lowest, highest)
    if logarithmic:
        colours.SetScaleToLog10()
    made = actor(port)
    mapper = made.GetMapper()
    mapper.SetScalarModeToUseCellFieldData()
    mapper.SelectColorArray(array)
    mapper.UseLookupTableScalarRangeOn()
    mapper.SetLookupTable(colours)
    renderer.AddActor(made)
    scale = vtk.vtkScalarBarActor()
    scale.SetLookupTable(colours)
    scale.SetTitle(title + '\n')
    scale.SetNumberOfLabels(3)
    scale.SetLabelFormat('%.3g')
    scale.SetUnconstrainedFontSize(True)
    scale.SetBarRatio(0.25)
    scale.SetPosition(0.03, 0.05)
    scale.SetPosition2(0.18, 0.40)
    for text in (scale.GetTitleTextProperty(), scale.GetLabelTextProperty()):
        text.SetColor(0, 0, 0)
        text.SetFontSize(14)
        text.ItalicOff()
        text.BoldOff()
        text.ShadowOff()
    renderer.AddActor2D(scale)


def view(window, left, position):
    renderer = vtk.vtkRenderer()
    renderer.SetViewport(left, 0, left + 0.5, 1)
    renderer.SetBackground(1, 1, 1)
    camera = renderer.GetActiveCamera()
    camera.SetFocalPoint(0, 0, -0.03)
    camera.SetPosition(*position)
    camera.SetViewUp(0, 0, 1)
    camera.SetViewAngle(30)
    window.AddRenderer(renderer)
    return renderer


def main(folder, number, picture):
    tissue = vtk.vtkXMLUnstructuredGridReader()
    tissue.SetFileName('%s/tissue_%04d.vtu' % (folder, int(number)))
    skin = vtk.vtkXMLPolyDataReader()
    skin.SetFileName('%s/skin_%04d.vtp' % (folder, int(number)))
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetSize(1000, 520)
    window.SetMultiSamples(8)

    renderer = view(window, 0, (0.26, 0.30, -0.01))
    middle = vtk.vtkPlane()
    middle.SetNormal(0, 1, 0)
    right = vtk.vtkExtractGeometry()
    right.SetImplicitFunction(middle)
    right.SetInputConnection(tissue.GetOutputPort())
    coloured(right.GetOutputPort(), 'von_mises_stress', 'stress [Pa]', 100, 30000, True, YELLOW_TO_RED, renderer)
    renderer.ResetCameraClippingRange()

    renderer = view(window, 0.5, (0.36, 0.17, -0.01))
    muscles = vtk.vtkThreshold()
    muscles.SetInputConnection(tissue.GetOutputPort())
    muscles.SetInputArrayToProcess(0, 0, 0, vtk.vtkDataObject.FIELD_ASSOCIATION_CELLS, 'muscle')
    muscles.SetLowerThreshold(0)
    coloured(muscles.GetOutputPort(), 'fibre_stretch', 'stretch [-]', 0.6, 1.4, False, BLUE_TO_RED, renderer)
    face = actor(skin.GetOutputPort(), 0.2)
    face.GetMapper().ScalarVisibilityOff()
    face.GetProperty().SetColor(0.86, 0.68, 0.58)
    renderer.AddActor(face)
    renderer.ResetCameraClippingRange()

    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(picture)
    writer.SetInputConnection(image.GetOutputPort())
    writer.Write()


main(*sys.argv[1:])
