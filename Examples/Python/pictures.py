"""Draws coloured surfaces side by side on a white background, and writes them as a scene for the
browser beside the picture."""
import os
from dataclasses import dataclass
from pathlib import Path

import numpy as np

# These two imports register OpenGL and the fonts with the rendering classes.
import vtkmodules.vtkRenderingFreeType  # noqa: F401
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkPolyDataNormals
from vtkmodules.vtkImagingCore import vtkImageShrink3D
from vtkmodules.vtkIOImage import vtkPNGWriter
from vtkmodules.vtkRenderingAnnotation import vtkScalarBarActor
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkColorTransferFunction, vtkLight, vtkPolyDataMapper, vtkRenderer,
    vtkRenderWindow, vtkTextActor, vtkWindowToImageFilter)

from scenes import save_scene

# Colours of numbers of both signs.
COLD_TO_WARM = [(0.13, 0.30, 0.60), (0.55, 0.72, 0.88), (0.93, 0.93, 0.92), (0.95, 0.70, 0.50),
                (0.65, 0.10, 0.12)]
INK = (0.13, 0.14, 0.16)
SMALL = 300  # smaller panels, in pixels of height, have a title only
ENLARGED = 3  # magnification of close-ups
BESIDE = 0.33  # width of a close-up, a square on the right of the panel
FINER = 2  # pictures are drawn larger by this factor and shrunk, against aliasing


@dataclass
class Panel:
    surface: vtkPolyData
    array: str                     # point array: colours (unsigned char), or numbers with `table`
    title: str
    note: str = ""                 # a smaller second line
    view: tuple = (0, 0, 1)        # direction from the surface to the camera
    up: tuple = (0, 1, 0)
    table: vtkLookupTable = None
    bar: bool = False              # whether to draw the table's colour bar
    closeup: tuple = None          # point to enlarge, as fractions of width and height
    ball: tuple = None             # (centre, radius): show only this part


def display_missing():
    """Whether this VTK needs an X server to draw and there is none."""
    return vtkRenderWindow().IsA("vtkXOpenGLRenderWindow") and not os.environ.get("DISPLAY")


def colour_table(low, high, colours, below=None, steps=256):
    """A table that interpolates the colours, evenly spaced from low to high, in so many steps.
    `below`, if given, is the colour of values below low."""
    ramp = vtkColorTransferFunction()
    ramp.SetColorSpaceToLab()
    for i, colour in enumerate(colours):
        ramp.AddRGBPoint(i / (len(colours) - 1), *colour)
    table = vtkLookupTable()
    table.SetNumberOfTableValues(steps)
    table.SetTableRange(low, high)
    for i in range(steps):
        table.SetTableValue(i, *ramp.GetColor(i / (steps - 1)), 1)
    if below:
        table.SetBelowRangeColor(*below, 1)
        table.UseBelowRangeColorOn()
    return table


def actor_of(panel):
    mapper = vtkPolyDataMapper()
    mapper.SetInputData(panel.surface)
    if not panel.surface.GetPointData().GetNormals():
        normals = vtkPolyDataNormals()
        normals.SplittingOff()
        normals.SetInputData(panel.surface)
        mapper.SetInputConnection(normals.GetOutputPort())
    mapper.SetScalarModeToUsePointFieldData()
    mapper.SelectColorArray(panel.array)
    if panel.table:
        mapper.SetLookupTable(panel.table)
        mapper.UseLookupTableScalarRangeOn()
        mapper.InterpolateScalarsBeforeMappingOn()  # otherwise colours are interpolated
    actor = vtkActor()
    actor.SetMapper(mapper)
    material = actor.GetProperty()
    material.SetAmbient(0.34)
    material.SetDiffuse(0.70)
    material.SetSpecular(0.06)
    material.SetSpecularPower(20)
    return actor


def text_of(words, size, height, bold=False):
    """A centred line of text; height is its position as a fraction of the panel."""
    text = vtkTextActor()
    text.SetInput(words)
    style = text.GetTextProperty()
    style.SetFontFamilyToArial()
    style.SetFontSize(size * FINER)
    style.SetBold(bold)
    style.SetColor(*INK)
    style.SetJustificationToCentered()
    text.GetPositionCoordinate().SetCoordinateSystemToNormalizedViewport()
    text.SetPosition(0.5, height)
    return text


def bar_of(panel, size):
    bar = vtkScalarBarActor()
    bar.SetLookupTable(panel.table)
    bar.SetOrientationToHorizontal()
    bar.SetNumberOfLabels(5)
    bar.SetLabelFormat("%.3g")
    bar.SetUnconstrainedFontSize(True)
    bar.SetPosition(0.25, 0.02)
    bar.SetWidth(0.5)
    bar.SetHeight(0.1)
    style = bar.GetLabelTextProperty()
    style.SetFontFamilyToArial()
    style.SetFontSize(size * FINER)
    style.SetColor(*INK)
    style.BoldOff()
    style.ItalicOff()
    style.ShadowOff()
    return bar


def renderer_of(panel, height):
    renderer = lit_renderer(panel)
    renderer.AddActor(actor_of(panel))
    renderer.AddActor(text_of(panel.title, max(13, height // 26), 0.93, bold=True))
    if height >= SMALL:
        renderer.AddActor(text_of(panel.note, height // 34, 0.885))
        if panel.bar:
            renderer.AddActor(bar_of(panel, height // 40))
    return renderer


def lit_renderer(panel):
    """A renderer with lights and a camera in the panel's view direction."""
    renderer = vtkRenderer()
    renderer.SetBackground(1, 1, 1)
    renderer.AutomaticLightCreationOff()
    for place, strength in (((-0.5, 0.7, 1), 0.88), ((0.8, -0.1, 0.8), 0.35)):
        light = vtkLight()
        light.SetLightTypeToCameraLight()
        light.SetPosition(*place)
        light.SetIntensity(strength)
        renderer.AddLight(light)
    camera = renderer.GetActiveCamera()
    camera.ParallelProjectionOn()
    camera.SetPosition(*panel.view)
    camera.SetViewUp(*panel.up)
    return renderer


def seen(renderer, panel):
    """The bounds of the surface, or of its ball, in the two directions of the image: low and
    high."""
    renderer.ResetCamera()
    matrix = renderer.GetActiveCamera().GetViewTransformMatrix()
    to_eye = np.array([[matrix.GetElement(i, j) for j in range(4)] for i in range(2)])
    if panel.ball:
        centre, radius = panel.ball
        middle = to_eye[:, :3] @ centre + to_eye[:, 3]
        return middle - radius, middle + radius
    places = vtk_to_numpy(panel.surface.GetPoints().GetData()) @ to_eye[:, :3].T + to_eye[:, 3]
    return places.min(axis=0), places.max(axis=0)


def fit(renderer, panel, height):
    """Fits the surface into the panel, between the title and the bar and to the left of the
    close-up. Returns the scale."""
    low, high = seen(renderer, panel)
    top = 0.85 if height >= SMALL else 0.9
    bottom = 0.17 if panel.bar and height >= SMALL else 0.04
    right = 1 - BESIDE if panel.closeup else 1
    aspect = renderer.GetTiledAspectRatio()
    wide, tall = high - low
    scale = 0.5 * max(1.06 * wide / aspect / right, tall / (top - bottom))
    camera = renderer.GetActiveCamera()
    camera.SetParallelScale(scale)
    x, y = (low + high) / 2 / scale
    camera.SetWindowCenter(x / aspect + 1 - right, y - (top + bottom - 1))
    return scale


def enlarge(renderer, panel, scale):
    """Points the camera at the panel's close-up at this scale."""
    low, high = seen(renderer, panel)
    camera = renderer.GetActiveCamera()
    camera.SetParallelScale(scale)
    camera.SetWindowCenter(*((low + (high - low) * panel.closeup) / scale))


def save_picture(path, panels, columns, panel_size):
    """Writes a PNG file, and a scene of the same name as an HTML file."""
    save_scene(Path(path).with_suffix(".html"), panels, columns, Path(path).stem.replace("_", " "))
    rows = -(-len(panels) // columns)
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    window.SetMultiSamples(0)
    window.SetSize(FINER * columns * panel_size[0], FINER * rows * panel_size[1])
    for i, panel in enumerate(panels):
        x, y = i % columns, rows - 1 - i // columns
        renderer = renderer_of(panel, panel_size[1])
        renderer.SetViewport(x / columns, y / rows, (x + 1) / columns, (y + 1) / rows)
        window.AddRenderer(renderer)
        scale = fit(renderer, panel, panel_size[1])
        if panel.closeup:
            closeup = lit_renderer(panel)
            closeup.AddActor(actor_of(panel))
            half = BESIDE / 2 * panel_size[0] / panel_size[1]  # half its height, in panels
            closeup.SetViewport((x + 0.99 - BESIDE) / columns, (y + 0.45 - half) / rows,
                                (x + 0.99) / columns, (y + 0.45 + half) / rows)
            window.AddRenderer(closeup)
            enlarge(closeup, panel, 2 * half * scale / ENLARGED)
    window.Render()
    grab = vtkWindowToImageFilter()
    grab.SetInput(window)
    grab.ReadFrontBufferOff()
    shrink = vtkImageShrink3D()
    shrink.SetInputConnection(grab.GetOutputPort())
    shrink.SetShrinkFactors(FINER, FINER, 1)
    shrink.MeanOn()
    writer = vtkPNGWriter()
    writer.SetInputConnection(shrink.GetOutputPort())
    writer.SetFileName(str(path))
    writer.SetCompressionLevel(9)
    writer.Write()
