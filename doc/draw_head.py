#!/usr/bin/env python3
"""Draws the parametric head: draw_head.py SURFACES CAGE.obj PICTURES

SURFACES is the folder that `frontalis bake config/head.yaml --surfaces SURFACES -o MODEL` writes, CAGE.obj the control cage, whose groups
colour the skin. Writes skin.png, close.png, skull.png, muscles.png and holds.png to the folder PICTURES. Needs python3-vtk9 and python3-numpy; without a
display run it under xvfb-run.
"""
import colorsys
import pathlib
import re
import sys

import numpy
import vtk
from vtk.util.numpy_support import numpy_to_vtk

SKIN = {"face": (0.86, 0.68, 0.58), "lid_margin": (0.80, 0.52, 0.47), "lips": (0.74, 0.42, 0.40), "mucosa": (0.62, 0.28, 0.28), "mouth": (0.55, 0.22, 0.22),
        "nostril": (0.27, 0.13, 0.11), "conjunctiva": (0.8, 0.5, 0.48), "cut": (0.6, 0.4, 0.35)}
HAIR = (0.29, 0.20, 0.145)
IRIS, PUPIL = 5.85e-3, 1.9e-3  # radii [m]


def read(path):
    vertices, faces, groups, group = [], [], [], ""
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]:
            vertices.append([float(w) for w in words[1:4]])
        elif words[:1] == ["g"]:
            group = words[1]
        elif words[:1] == ["f"]:
            faces.append([int(w) - 1 for w in words[1:]])
            groups.append(group)
    return numpy.array(vertices), faces, groups


def actor_of(vertices, faces, colours, opacity=1.0):
    points, cells, data = vtk.vtkPoints(), vtk.vtkCellArray(), vtk.vtkPolyData()
    points.SetData(numpy_to_vtk(numpy.ascontiguousarray(1e3 * vertices), deep=1))
    for face in faces:
        cells.InsertNextCell(len(face), face)
    data.SetPoints(points)
    data.SetPolys(cells)
    mapper = vtk.vtkPolyDataMapper()
    actor = vtk.vtkActor()
    if isinstance(colours, tuple):
        actor.GetProperty().SetColor(*colours)
    else:
        scalars = numpy_to_vtk((255 * colours.clip(0, 1)).astype(numpy.uint8), deep=1)
        data.GetPointData().SetScalars(scalars)
    normals = vtk.vtkPolyDataNormals()
    normals.SetInputData(data)
    normals.SplittingOff()
    normals.ConsistencyOff()
    mapper.SetInputConnection(normals.GetOutputPort())
    actor.SetMapper(mapper)
    shine = actor.GetProperty()
    shine.SetOpacity(opacity)
    shine.SetAmbient(0.12)
    shine.SetSpecular(0.15)
    shine.SetSpecularPower(18)
    return actor


def skin_colours(vertices, faces, cage):
    """Tints by the group of the cage's face that a triangle comes from, and the brows."""
    groups = cage[2] * 2  # and those of the mirror image
    each = len(faces) // len(groups)
    colours = numpy.zeros((len(vertices), 3))
    count = numpy.zeros(len(vertices))
    for i, face in enumerate(faces):
        for v in face:
            colours[v] += SKIN.get(groups[i // each], SKIN["face"])
            count[v] += 1
    colours /= count[:, None]
    x, y, z = 1e3 * vertices.T
    out = (abs(y) - 14) / 37  # 0 at the medial end of the brow, 1 at the lateral one
    t = out.clip(0, 1)
    middle = 9.5 + 4.5 * t - 14.4 * (t - 0.62).clip(0, 1) ** 1.2
    hair = (1.3 - abs(z - middle) / (3.6 * (1 - 0.55 * t))).clip(0, 1)
    hair *= ((out + 0.02) * 6).clip(0, 1) * ((1 - out) * 6).clip(0, 1) * (x > -40)
    return colours * (1 - 0.75 * hair[:, None]) + 0.75 * hair[:, None] * numpy.array([0.25, 0.17, 0.13])


def eye_of(vertices):
    """An eyeball of its own triangles, dense in front, with iris and pupil, at the place of the part."""
    centre = 0.5 * (vertices.min(0) + vertices.max(0))
    size = 0.5 * (vertices.max(0) - vertices.min(0))[0]
    around, down = 120, numpy.concatenate([numpy.linspace(0, 0.55, 60), numpy.linspace(0.58, numpy.pi, 40)])
    turn = numpy.linspace(0, 2 * numpy.pi, around, endpoint=False)
    ball = numpy.array([[numpy.cos(t), numpy.sin(t) * numpy.cos(p), numpy.sin(t) * numpy.sin(p)] for t in down for p in turn])
    faces = [[i * around + j, (i + 1) * around + j, (i + 1) * around + (j + 1) % around, i * around + (j + 1) % around]
             for i in range(len(down) - 1) for j in range(around)]
    radius = size * numpy.hypot(*ball.T[1:])
    colours = numpy.tile([0.93, 0.91, 0.88], (len(ball), 1))
    front = ball[:, 0] > 0
    colours[front & (radius < IRIS)] = (0.36, 0.25, 0.16)
    colours[front & (abs(radius - 0.95 * IRIS) < 0.06 * IRIS)] = (0.2, 0.14, 0.1)
    colours[front & (radius < PUPIL)] = (0.03, 0.03, 0.03)
    return actor_of(centre + size * ball, faces, colours)


def draw(actors, views, picture, size=420):
    """views: azimuth and elevation [degrees], the point looked at and half the height of the picture there [mm]."""
    window = vtk.vtkRenderWindow()
    window.SetOffScreenRendering(1)
    window.SetMultiSamples(0)  # which depth peeling needs; the picture is drawn at twice its size instead
    window.SetSize(2 * size * len(views), 2 * int(1.2 * size))
    for k, (azimuth, elevation, focus, half) in enumerate(views):
        renderer = vtk.vtkRenderer()
        renderer.SetBackground(1, 1, 1)
        renderer.SetViewport(k / len(views), 0, (k + 1) / len(views), 1)
        renderer.SetUseDepthPeeling(1)
        renderer.SetMaximumNumberOfPeels(20)
        for actor in actors:
            renderer.AddActor(actor)
        a, e = numpy.radians([azimuth, elevation])
        towards = numpy.array([numpy.cos(e) * numpy.cos(a), numpy.cos(e) * numpy.sin(a), numpy.sin(e)])
        aside = numpy.cross(towards, [0, 0, 1])
        camera = renderer.GetActiveCamera()
        camera.SetFocalPoint(*focus)
        camera.SetPosition(*(focus + 1100 * towards))
        camera.SetViewUp(0, 0, 1)
        camera.SetViewAngle(2 * numpy.degrees(numpy.arctan(half / 1100)))
        for place, strength in ((900 * towards - 700 * aside + [0, 0, 900], 0.75), (900 * towards + 900 * aside + [0, 0, 200], 0.35),
                                (1000 * towards, 0.12)):
            light = vtk.vtkLight()
            light.SetLightTypeToSceneLight()
            light.SetPosition(*(focus + place))
            light.SetFocalPoint(*focus)
            light.SetIntensity(strength)
            renderer.AddLight(light)
        window.AddRenderer(renderer)
        renderer.ResetCameraClippingRange()
    window.SetAlphaBitPlanes(1)
    window.Render()
    image = vtk.vtkWindowToImageFilter()
    image.SetInput(window)
    image.ReadFrontBufferOff()
    half_size = vtk.vtkImageShrink3D()
    half_size.SetInputConnection(image.GetOutputPort())
    half_size.SetShrinkFactors(2, 2, 1)
    half_size.MeanOn()
    writer = vtk.vtkPNGWriter()
    writer.SetFileName(str(picture))
    writer.SetInputConnection(half_size.GetOutputPort())
    writer.Write()


def main(surfaces, cage, pictures):
    surfaces, pictures = pathlib.Path(surfaces), pathlib.Path(pictures)
    pictures.mkdir(exist_ok=True)
    parts = {path.stem: read(path)[:2] for path in sorted(surfaces.glob("*.obj"))}
    skin, hair = parts.pop("skin"), parts.pop("hair")
    colours = skin_colours(*skin, read(cage))
    hair = actor_of(*hair, HAIR)
    eyes = [eye_of(parts[name][0]) for name in ("eye_left", "eye_right")]
    bones = [actor_of(*parts[name], colour) for name, colour in (("skull", (0.9, 0.86, 0.76)), ("mandible", (0.87, 0.82, 0.70)),
                                                                 ("teeth_upper", (0.97, 0.96, 0.92)), ("teeth_lower", (0.97, 0.96, 0.92)))]
    # muscles.yaml, beside the cage, tells muscles from volumes without fibres
    entries = re.findall(r"^(\w+):\n((?:  .*\n)+)", (pathlib.Path(cage).parent / "muscles.yaml").read_text(), re.MULTILINE)
    sides = {name: [part for part in (name, name + "_left", name + "_right") if part in parts] for name, text in entries}
    pads = {name for name, text in entries if "pad: true" in text}
    holds = {"fat": (0.93, 0.78, 0.35), "ligament": (0.97, 0.97, 0.95), "adhesion": (0.97, 0.97, 0.95), "glide": (0.2, 0.45, 0.75)}
    held = [actor_of(*parts[part], holds.get(name.split("_")[0], (0.55, 0.68, 0.85)), 1 if "_" in name else 0.55)
            for name in sorted(pads) for part in sides[name]]
    kinds = sorted(set(sides) - pads)
    muscles = [actor_of(*parts[part], colorsys.hls_to_rgb((0.95 + 0.382 * n * 0.4) % 1, 0.42 + 0.05 * (n % 3), 0.55))
               for n, name in enumerate(kinds) for part in sides[name]]
    head = numpy.array([-70.0, 0, -20])
    whole = [(0, 0, head, 150), (40, 3, head, 150), (90, 0, head, 150)]
    draw([actor_of(*skin, colours), hair] + eyes, whole, pictures / "skin.png")
    draw([actor_of(*skin, colours), hair] + eyes, [(0, 0, numpy.array([0, 31.0, -9]), 32), (0, -10, numpy.array([0, 0, -60.0]), 42),
                                             (50, 0, numpy.array([0, 0, -60.0]), 45)], pictures / "close.png")
    draw(bones + eyes, whole, pictures / "skull.png")
    draw([actor_of(*skin, (0.86, 0.68, 0.58), 0.22)] + eyes + bones + muscles, whole, pictures / "muscles.png")
    draw([actor_of(*skin, (0.86, 0.68, 0.58), 0.22)] + eyes + bones + held, whole, pictures / "holds.png")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
