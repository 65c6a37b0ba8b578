"""Writes coloured surfaces as one HTML file that shows them in a browser, without a server: the mouse
turns them. The viewer is that of the page, Web/view.js, which the file has in it.
"""
import base64
import gzip
import html
import json
from pathlib import Path

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkDecimatePro, vtkTriangleFilter

LARGEST = 100_000  # points in a scene; surfaces with more than their share are simplified
VIEWER = Path(__file__).resolve().parent.parent.parent / "Web"


def save_scene(path, panels, columns, title):
    """Writes the panels, so many in a row, to one HTML file. Returns whether the viewer is there, which
    copies of the examples elsewhere lack."""
    if not VIEWER.is_dir():
        return False
    arrays, described = [], []
    for panel in panels:
        surface = _placed(panel, LARGEST // len(panels))
        points = vtk_to_numpy(surface.GetPoints().GetData())
        triangles = vtk_to_numpy(surface.GetPolys().GetConnectivityArray())
        colours = vtk_to_numpy(surface.GetPointData().GetArray("Colour"))
        described.append({"title": panel.title, "points": len(points), "triangles": len(triangles) // 3})
        arrays += [points.astype("<f4").tobytes(), triangles.astype("<u4").tobytes(),
                   colours.tobytes() + bytes(-colours.size % 4)]
    packed = base64.b64encode(gzip.compress(b"".join(arrays), mtime=0)).decode()
    scene = json.dumps({"columns": columns, "panels": described, "packed": packed}).replace("<", "\\u003c")
    text = (VIEWER / "scene" / "scene.html").read_text()
    for name in ("unpack.js", "shaders.js", "camera.js", "view.js", "scene/scene.js"):
        text = text.replace(f'<script src="{name}"></script>', f"<script>\n{(VIEWER / name).read_text()}</script>")
    text = text.replace("@title@", html.escape(title)).replace("@scene@", scene)
    Path(path).write_text(text)
    return True


def _placed(panel, largest):
    """The surface in the panel's view, in a square of size 1, with its colours and not many more points
    than `largest`."""
    view = np.asarray(panel.view, float) / np.linalg.norm(panel.view)
    right = np.cross(panel.up, view)
    right /= np.linalg.norm(right)
    points = vtk_to_numpy(panel.surface.GetPoints().GetData()) @ np.array(
        [right, np.cross(view, right), view]).T
    low, high = points.min(axis=0), points.max(axis=0)
    points = (points - (low + high) / 2) / (high - low)[:2].max()
    coordinates, surface = vtkPoints(), vtkPolyData()
    coordinates.SetData(numpy_to_vtk(points.astype(np.float32), deep=True))
    surface.SetPoints(coordinates)
    surface.SetPolys(panel.surface.GetPolys())
    colours = numpy_to_vtk(_colours(panel), deep=True)
    colours.SetName("Colour")
    surface.GetPointData().SetScalars(colours)
    triangles, fewer = vtkTriangleFilter(), vtkDecimatePro()
    triangles.SetInputData(surface)
    triangles.PassVertsOff()
    triangles.PassLinesOff()
    fewer.SetInputConnection(triangles.GetOutputPort())  # it keeps a part of the points, with their colours
    fewer.BoundaryVertexDeletionOff()  # nor single triangles
    fewer.SetTargetReduction(max(0.0, 1 - largest / surface.GetNumberOfPoints()))
    last = fewer if surface.GetNumberOfPoints() > largest else triangles
    last.Update()
    return last.GetOutput()


def _colours(panel):
    """The panel's array as red, green and blue."""
    values = np.asarray(WrapDataObject(panel.surface).PointData[panel.array])
    if panel.table is None:
        return np.ascontiguousarray(values[:, :3], dtype=np.uint8)
    numbers = vtkFloatArray()
    numbers.DeepCopy(numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float32)))
    mapped = vtk_to_numpy(panel.table.MapScalars(numbers, 0, -1))
    return np.ascontiguousarray(mapped[:, :3])
