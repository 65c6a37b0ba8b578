"""Writes coloured surfaces as one HTML file that shows them in a browser, without a server: the mouse
turns them.

The viewer is that of the package trame-vtk (pip install trame-vtk==2.11.17 --no-deps), with vtk.js
in it. The variable SURFACEDIFFUSION_SCENE_VIEWER may name its file static_viewer.html, or the wheel
that has it. Without it, no scenes are written.
"""
import base64
import html
import importlib.util
import io
import json
import os
import re
import tempfile
import zipfile
from pathlib import Path

import numpy as np
from vtkmodules.numpy_interface.dataset_adapter import WrapDataObject
from vtkmodules.util.numpy_support import numpy_to_vtk, vtk_to_numpy
from vtkmodules.vtkCommonCore import vtkFloatArray, vtkPoints
from vtkmodules.vtkCommonDataModel import vtkPolyData
from vtkmodules.vtkFiltersCore import vtkDecimatePro, vtkPolyDataNormals
from vtkmodules.vtkIOExport import vtkJSONRenderWindowExporter
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkCamera, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow)

LARGEST = 100_000  # points in a scene; surfaces with more than their share are simplified
TITLE = ('<div class="title" style="position: fixed; left: %g%%; top: %g%%; padding: 8px; z-index: 1; '
         'font: 14px sans-serif; color: #222; pointer-events: none">%s</div>\n')


def find_viewer():
    """The viewer as text; None if there is none."""
    given = os.environ.get("SURFACEDIFFUSION_SCENE_VIEWER")
    if not given:
        package = importlib.util.find_spec("trame_vtk")
        if package is None:
            return None
        given = Path(list(package.submodule_search_locations)[0], "tools", "static_viewer.html")
    if str(given).endswith(".whl"):
        if not Path(given).is_file():
            return None
        with zipfile.ZipFile(given) as wheel:
            return wheel.read("trame_vtk/tools/static_viewer.html").decode()
    return Path(given).read_text() if Path(given).is_file() else None


def save_scene(path, panels, columns, title):
    """Writes the panels, so many in a row, to one HTML file. Returns whether there is a viewer."""
    viewer = find_viewer()
    if viewer is None:
        return False
    packed = base64.b64encode(_pack(panels, columns)).decode()
    rows = -(-len(panels) // columns)
    titles = "".join(TITLE % (100 * (i % columns) / columns, 100 * (i // columns) / rows,
                              html.escape(panel.title)) for i, panel in enumerate(panels))
    viewer = viewer.replace("https://kitware.github.io/vtk-js/icon/", "data:,")  # no network
    script = ('<div class="content" style="position: fixed; inset: 0"></div>\n'
              "<script>\nfunction loadDataSet() {\n"
              "  OfflineLocalView.load(document.querySelector('.content'), "
              '{ base64Str: "' + packed + '" });\n}\n</script>\n')
    page = re.sub("<title>.*?</title>", lambda _: f"<title>{html.escape(title)}</title>", viewer,
                  count=1)
    end = page.rindex("</body>")
    Path(path).write_text(page[:end] + script + titles + page[end:])
    return True


def _pack(panels, columns):
    """The scene for the viewer: a zip file with the description and the arrays that it refers to."""
    window, rows = vtkRenderWindow(), -(-len(panels) // columns)
    window.SetOffScreenRendering(True)
    camera = vtkCamera()  # of all panels: they turn together
    for panel in panels:
        mapper, actor, renderer = vtkPolyDataMapper(), vtkActor(), vtkRenderer()
        mapper.SetInputData(_placed(panel, LARGEST // len(panels)))
        mapper.SetScalarModeToUsePointFieldData()
        mapper.SelectColorArray("Colour")
        actor.SetMapper(mapper)
        actor.GetProperty().SetAmbient(0.3)
        actor.GetProperty().SetDiffuse(0.75)
        renderer.SetBackground(1, 1, 1)
        renderer.AddActor(actor)
        renderer.SetActiveCamera(camera)
        window.AddRenderer(renderer)
    renderer.ResetCamera(-0.5, 0.5, -0.5, 0.5, -0.5, 0.5)
    with tempfile.TemporaryDirectory() as folder:
        exporter = vtkJSONRenderWindowExporter()
        exporter.GetArchiver().SetArchiveName(str(Path(folder, "scene")))
        exporter.SetRenderWindow(window)
        exporter.Write()
        scene = json.loads(Path(folder, "scene", "index.json").read_text())
        arrays = {}
        for entry in _arrays_in(scene):
            content = Path(folder, "scene", "data", entry["hash"]).read_bytes()
            arrays[entry["hash"]] = {**entry, "content": base64.b64encode(content).decode()}
    # Viewports and parallel projection are missing in what VTK 9.2 writes.
    _remove_addresses(scene)
    for number, renderer in enumerate(scene["dependencies"]):
        x, y = number % columns, rows - 1 - number // columns
        renderer["properties"]["viewport"] = [
            x / columns, y / rows, (x + 1) / columns, (y + 1) / rows]
        for part in renderer["dependencies"]:
            if part["type"] == "vtkCamera":
                part["properties"].update(parallelProjection=True, parallelScale=0.6)
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("index.json", json.dumps({"scene": scene, "hashes": arrays}))
    return packed.getvalue()


def _arrays_in(part):
    """All parts of the description that name an array."""
    if isinstance(part, dict):
        if "hash" in part:
            yield part
        part = list(part.values())
    if isinstance(part, list):
        for inner in part:
            yield from _arrays_in(inner)


def _remove_addresses(part):
    """Remove the addresses of VTK's objects, which differ between runs."""
    part["properties"].pop("address", None)
    for inner in part.get("dependencies", ()):
        _remove_addresses(inner)


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
    normals = vtkPolyDataNormals()
    if surface.GetNumberOfPoints() > largest:
        fewer = vtkDecimatePro()  # which keeps a part of the points, with their colours
        fewer.SetInputData(surface)
        fewer.BoundaryVertexDeletionOff()  # nor single triangles
        fewer.SetTargetReduction(1 - largest / surface.GetNumberOfPoints())
        normals.SetInputConnection(fewer.GetOutputPort())
    else:
        normals.SetInputData(surface)
    normals.SplittingOff()
    normals.ConsistencyOff()
    normals.Update()
    return normals.GetOutput()


def _colours(panel):
    """The panel's array as red, green and blue."""
    values = np.asarray(WrapDataObject(panel.surface).PointData[panel.array])
    if panel.table is None:
        return np.ascontiguousarray(values[:, :3], dtype=np.uint8)
    numbers = vtkFloatArray()
    numbers.DeepCopy(numpy_to_vtk(np.ascontiguousarray(values, dtype=np.float32)))
    mapped = vtk_to_numpy(panel.table.MapScalars(numbers, 0, -1))
    return np.ascontiguousarray(mapped[:, :3])
