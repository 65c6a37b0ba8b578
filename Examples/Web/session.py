# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The page of one person: a process of its own, which app.py starts and ends. It prints its port."""
import asyncio
import html as text
import os
import sys
import threading
import warnings

import numpy as np
from trame.app import get_server
from trame.ui.vuetify3 import SinglePageWithDrawerLayout
from trame.widgets import html, vtk as vtk_widgets, vuetify3 as v3

import vtkmodules.vtkInteractionStyle  # noqa: F401 (registers what the window needs)
import vtkmodules.vtkRenderingOpenGL2  # noqa: F401
from vtkmodules.vtkCommonCore import vtkLookupTable
from vtkmodules.vtkRenderingCore import (
    vtkActor, vtkPolyDataMapper, vtkRenderer, vtkRenderWindow, vtkRenderWindowInteractor)

from surfacediffusion import SurfaceDiffusionWarning

from filters import FILTERS
from meshes import FORMATS, as_polydata, example, read_mesh, result_file, result_names

VIRIDIS = np.array([(68, 1, 84), (58, 82, 139), (32, 144, 140), (94, 201, 97), (253, 231, 36)]) / 255
REGIONS = np.array([(102, 194, 165), (252, 141, 98), (141, 160, 203), (231, 138, 195),
                    (166, 216, 84), (255, 217, 47), (229, 196, 148), (179, 179, 179)]) / 255
GREY = (0.75, 0.75, 0.75)
MEGABYTES = float(os.environ.get("SURFACEDIFFUSION_WEB_MEGABYTES", "200"))
NORMALS = "Normals"
WAIT = 0.3  # seconds without a change before a run starts


class Page:
    """State, picture and runs of the page."""

    def __init__(self):
        self.server = get_server(client_type="vue3")
        self.state, self.ctrl = self.server.state, self.server.controller
        self.mesh, self.outcome = None, None
        self.window, self.views = make_window()
        self.request = 0  # of the latest run; an older one is abandoned
        self.running = None
        self.state.update({"filters": [{"title": f.title, "value": f.name} for f in FILTERS.values()],
                           "filter": "heat", "arrays": [], "array": "", "sliders": [], "values": {},
                           "message": "", "note": "", "busy": False, "progress": 0, "files": None,
                           "mesh_name": "", "curve": "", "history": {"names": [], "rows": []},
                           "formats": FORMATS, "done": 0, "unit": "", "bars": [],
                           "download_names": [], "download_name": ""})
        self.state.trame__title = "SurfaceDiffusion"
        self.state.change("files")(self.open_files)
        self.state.change("filter", "array")(self.choose)
        self.state.change("values")(lambda **_: self.start())
        self.server.trigger("download")(self.download)
        self.make_layout()
        self.show_mesh(example())

    # ---- input ----------------------------------------------------------------------------------

    def open_files(self, files, **_):
        if not files:
            return
        files = files if isinstance(files, list) else [files]
        given = [(f["name"], b"".join(f["content"]) if isinstance(f["content"], list)
                  else f["content"] or b"") for f in files]
        try:
            mesh = read_mesh(given, MEGABYTES)
        except Exception as problem:  # a file that cannot be read leaves the page as it was
            self.state.message = str(problem) or type(problem).__name__
            return
        self.state.message = ""
        self.show_mesh(mesh)

    def show_mesh(self, mesh):
        self.mesh, self.outcome = mesh, None
        self.state.mesh_name = (f"{mesh.name}: {mesh.surface.n_points:,} points, "
                                f"{mesh.surface.n_faces:,} faces")
        self.state.unit = f" {mesh.unit}" if mesh.unit else " (unit of the coordinates)"
        self.state.arrays = list(mesh.arrays)
        self.state.array = next(iter(mesh.arrays))
        self.set_sliders()
        self.draw(reset=True)
        self.start()

    def choose(self, **_):
        """A filter or an array was chosen."""
        if self.mesh is None:
            return
        entry = FILTERS[self.state.filter]
        vectors = [name for name, array in self.mesh.arrays.items() if array.ndim == 2]
        self.state.arrays = {"values": list(self.mesh.arrays), "vectors": [NORMALS, *vectors],
                             "none": []}[entry.input]
        if self.state.arrays and self.state.array not in self.state.arrays:
            self.state.array = self.state.arrays[0]
        if [slider["name"] for slider in self.state.sliders] != [s.name for s in entry.sliders]:
            self.set_sliders()
        self.start()

    def set_sliders(self):
        shown, values = [], {}
        for slider in FILTERS[self.state.filter].sliders:
            low, high, step, default = slider.range(self.mesh.diagonal)
            shown.append({"name": slider.name, "label": slider.label, "min": low, "max": high,
                          "step": step, "look": slider.look, "length": slider.of_diagonal,
                          "choices": [{"title": word, "value": i}
                                      for i, word in enumerate(slider.choices)]})
            values[slider.name] = default
        self.state.update({"sliders": shown, "values": values})

    def data(self):
        """The chosen array; None for normals and for filters of the surface alone."""
        if FILTERS[self.state.filter].input == "none" or self.state.array == NORMALS:
            return None
        return self.mesh.arrays[self.state.array]

    # ---- runs -----------------------------------------------------------------------------------

    def start(self):
        """Start a run with the settings of the page, after a moment without another change."""
        self.request += 1
        try:
            asyncio.get_running_loop()
        except RuntimeError:
            return  # the server has not started; it starts the first run
        with self.state:  # at once: the result that is there belongs to other settings
            self.state.busy, self.state.progress = True, 0
        asyncio.ensure_future(self.run(self.request))

    async def run(self, request):
        await asyncio.sleep(WAIT)
        if self.running:  # one at a time: the surface's factors belong to one run
            await asyncio.wait([self.running])
        if request != self.request:
            return
        mesh, entry, data = self.mesh, FILTERS[self.state.filter], self.data()
        values = {name: float(value) for name, value in self.state["values"].items()}
        loop = asyncio.get_running_loop()

        def advance(fraction):
            if request != self.request:
                raise Abandoned
            loop.call_soon_threadsafe(self.show_progress, request, fraction)

        self.running = loop.run_in_executor(None, run_with_warnings, entry, mesh, data, values, advance)
        message, outcome = "", None
        try:
            outcome = await self.running
        except Abandoned:
            return
        except Exception as problem:
            message = str(problem) or type(problem).__name__
        finally:
            self.running = None
        if request != self.request:
            return
        with self.state:
            self.outcome = outcome
            self.state.busy, self.state.message = False, message
            self.state.note = outcome.note if outcome else ""
            self.show_history(outcome.history if outcome else {})
            self.offer_downloads()
            self.draw()
            self.state.done += 1

    def show_progress(self, request, fraction):
        if request == self.request and fraction - self.state.progress / 100 > 0.05:
            with self.state:
                self.state.progress = round(100 * fraction)

    def show_history(self, history):
        names = [name for name in history if name != "Seconds"]
        steps = len(next(iter(history.values()))) if history else 0
        rows = [[f"{history[name][i]:.6g}" for name in names]
                for i in np.unique(np.linspace(0, steps - 1, min(steps, 40)).astype(int))]
        self.state.history = {"names": names, "rows": rows}
        self.state.curve = curve_of(history)

    def offer_downloads(self):
        names = result_names(self.mesh, self.outcome, self.state.array) if self.outcome else []
        if names != self.state.download_names:
            self.state.update({"download_names": names, "download_name": names[0] if names else ""})

    def download(self):
        return self.server.protocol.addAttachment(
            result_file(self.mesh, self.outcome, self.state.array, self.state.download_name))

    # ---- picture --------------------------------------------------------------------------------

    def draw(self, reset=False):
        triangles, before, after = self.mesh.surface.triangles, self.data(), None
        points = moved = self.mesh.surface.points
        turned = triangles
        labels = False
        if self.outcome is not None:
            after, labels = self.outcome.shown, self.outcome.labels
            moved = points if self.outcome.points is None else self.outcome.points
            turned = triangles if self.outcome.triangles is None else self.outcome.triangles
        if FILTERS[self.state.filter].input == "vectors":
            normals = self.mesh.surface, before is None
            before = colours_of_vectors(vectors_or_normals(*normals, before))
            after = None if after is None else colours_of_vectors(after)
            if self.outcome is not None and self.outcome.points is not None:
                before = after = None
        bars = (place(self.views[0], points, triangles, before, before),
                place(self.views[1], moved, turned, after,
                      after if labels or before is None else before, labels))
        name = "" if labels or self.data() is None else self.state.array
        unit = self.mesh.unit_of(name) if name else ""
        self.state.bars = [{**bar, "left": left, "title": f"{name}, {unit}" if unit else name}
                           for bar, left in zip(bars, (0, 50)) if bar]
        if reset:
            self.views[0][0].ResetCamera()
        self.ctrl.update_view()
        if reset:  # after the geometry: the browser has another surface until then
            self.ctrl.push_camera()

    # ---- layout ---------------------------------------------------------------------------------

    def make_layout(self):
        with SinglePageWithDrawerLayout(self.server, width=380) as layout:
            layout.title.set_text("SurfaceDiffusion")
            layout.footer.hide()
            with layout.toolbar:
                v3.VSpacer()
                html.Span("{{ mesh_name }}", id="mesh", classes="mr-4 text-body-2")
                v3.VSelect(v_model=("download_name",), items=("download_names",), id="format",
                           v_show="download_names.length > 1", density="compact", hide_details=True,
                           variant="plain", style="max-width: 300px", classes="mr-2")
                v3.VBtn("Download result", id="download", disabled=("busy || !done || !!message",),
                        prepend_icon="mdi-download", variant="tonal", classes="mr-2",
                        click="utils.download(download_name, trigger('download'), "
                              "'application/octet-stream')")
            with layout.drawer, v3.VContainer(classes="pa-4"):
                v3.VFileInput(v_model=("files",), multiple=True, id="files", show_size=True,
                              label="Drop a mesh here, with a file of values",
                              prepend_icon="mdi-tray-arrow-down", hint=("formats",),
                              persistent_hint=True, variant="outlined", classes="mb-4")
                v3.VSelect(v_model=("filter",), items=("filters",), label="Filter", id="filter",
                           variant="outlined", density="compact")
                v3.VSelect(v_model=("array",), items=("arrays",), label="Array", id="array",
                           v_show="arrays.length", variant="outlined", density="compact")
                with html.Div(v_for="s in sliders", key="s.name", id=("'slider-' + s.name",)):
                    html.Div("{{ s.label }}: {{ values[s.name] }}{{ s.length ? unit : '' }}",
                             v_if="s.look == 'slider'", classes="text-body-2")
                    v3.VSlider(
                        v_if="s.look == 'slider'",
                        model_value=("values[s.name]",), min=("s.min",), max=("s.max",),
                        step=("s.step",), density="compact", hide_details=True,
                        update_modelValue="values = {...values, "
                                          "[s.name]: Number($event.toPrecision(6))}")
                    v3.VSelect(
                        v_if="s.look == 'menu'", model_value=("values[s.name]",),
                        items=("s.choices",), label=("s.label",), id=("s.name",),
                        variant="outlined", density="compact",
                        update_modelValue="values = {...values, [s.name]: $event}")
                    v3.VSwitch(
                        v_if="s.look == 'switch'", model_value=("values[s.name]",),
                        true_value=(1,), false_value=(0,), label=("s.label",), color="primary",
                        density="compact", hide_details=True,
                        update_modelValue="values = {...values, [s.name]: $event}")
                v3.VProgressLinear(model_value=("progress",), active=("busy",), id="busy")
                v3.VAlert("{{ message }}", v_if="message", type="error", id="message",
                          density="compact", classes="mt-4", style="max-height: 10em; overflow: auto")
                html.Div("{{ note }}", id="note", classes="mt-4 text-body-2")
                html.Div(v_html=("curve",), id="curve", classes="mt-4")
                with v3.VTable(density="compact", height=220, fixed_header=True, id="history",
                               v_if="history.rows.length"):
                    with html.Thead(), html.Tr():
                        html.Th("{{ name }}", v_for="name in history.names", key="name")
                    with html.Tbody():
                        with html.Tr(v_for="(row, i) in history.rows", key="i"):
                            html.Td("{{ cell }}", v_for="(cell, j) in row", key="j")
            with layout.content, v3.VContainer(fluid=True, classes="pa-0 fill-height",
                                               style="position: relative"):
                view = vtk_widgets.VtkLocalView(self.window, ref="view")
                self.ctrl.update_view, self.ctrl.push_camera = view.update, view.push_camera
                for left, word in ((0, "Before"), (50, "After")):
                    html.Div(word, classes="text-h6 pa-3",
                             style=f"position: absolute; top: 0; left: {left}%; pointer-events: none")
                with html.Div(v_for="bar in bars", key="bar.left", classes="bar text-body-2 pa-3",
                              style=("`position: absolute; bottom: 0; left: ${bar.left}%; width: 240px; "
                                     "pointer-events: none`",)):
                    html.Div("{{ bar.title }}")
                    html.Div(style=("`height: 12px; background: ${bar.colours}`",))
                    with html.Div(style="display: flex; justify-content: space-between"):
                        html.Span("{{ word }}", v_for="word in bar.words", key="word")
                html.Div("{{ done }}", id="done", style="display: none")


class Abandoned(Exception):
    """Ends a run whose settings have changed."""


def run_with_warnings(entry, *arguments):
    """The outcome, whose note has the warnings of the run."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always", SurfaceDiffusionWarning)
        outcome = entry.run(*arguments)
    sentences = [outcome.note, *(f"Warning: {warning.message}" for warning in caught)]
    outcome.note = "; ".join(filter(None, sentences))
    return outcome


def make_window():
    """A window with two views of one camera: for each, renderer, mapper and actor."""
    window = vtkRenderWindow()
    window.SetOffScreenRendering(True)
    views = []
    for i in range(2):
        renderer, mapper, actor = vtkRenderer(), vtkPolyDataMapper(), vtkActor()
        renderer.SetViewport(i / 2, 0, (i + 1) / 2, 1)
        renderer.SetBackground(1, 1, 1)
        actor.SetMapper(mapper)
        actor.GetProperty().SetColor(*GREY)
        renderer.AddActor(actor)
        window.AddRenderer(renderer)
        views.append((renderer, mapper, actor))
    views[1][0].SetActiveCamera(views[0][0].GetActiveCamera())
    interactor = vtkRenderWindowInteractor()
    interactor.SetRenderWindow(window)
    interactor.GetInteractorStyle().SetCurrentStyleToTrackballCamera()
    window.interactor = interactor  # kept as long as the window
    return window, views


def place(view, points, triangles, values, scale, labels=False):
    """Show a surface with values; scale: the array whose range the colours have. Returns the colour bar:
    CSS colours and the words below them; None for a surface without values or with colours of its own."""
    _, mapper, _ = view
    if values is not None and values.ndim == 2 and values.dtype != np.uint8:
        values, scale = (None if a is None else np.linalg.norm(a, axis=1) for a in (values, scale))
    arrays = {} if values is None else {
        "shown": values if values.dtype == np.uint8 else values.astype(np.float32)}
    surface = as_polydata(points, triangles, arrays)
    if values is not None:
        surface.GetPointData().SetActiveScalars("shown")
    mapper.SetInputData(surface)
    mapper.SetScalarVisibility(values is not None)
    if values is None:
        return None
    if values.ndim == 2:
        mapper.SetColorModeToDirectScalars()
        return None
    mapper.SetColorModeToMapScalars()
    finite = scale[np.isfinite(scale)] if scale.ndim == 1 else np.zeros(0)
    low, high = (finite.min(), finite.max()) if finite.size else (0.0, 1.0)
    colours = REGIONS[np.arange(max(int(high), 1)) % len(REGIONS)] if labels else VIRIDIS
    mapper.SetLookupTable(table_of(colours, 1 if labels else 256))
    mapper.SetScalarRange(*((1, max(2, int(high))) if labels else (low, high)))
    css = [f"rgb({', '.join(str(round(255 * part)) for part in colour)})" for colour in colours]
    if labels:  # one block each
        css = [f"{colour} {100 * (i + k) / len(css):.4g}%" for i, colour in enumerate(css) for k in (0, 1)]
    words = map(str, range(1, len(colours) + 1)) if labels else (f"{low:.4g}", f"{high:.4g}")
    return {"colours": f"linear-gradient(to right, {', '.join(css)})", "words": list(words)}


def table_of(colours, size):
    """A table of the colours themselves if size is 1, or of so many between them."""
    table, count = vtkLookupTable(), len(colours) if size == 1 else size
    table.SetNumberOfTableValues(count)
    for i in range(count):
        place_of = i / max(1, count - 1) * (len(colours) - 1)
        rgb = [np.interp(place_of, range(len(colours)), colours[:, axis]) for axis in range(3)]
        table.SetTableValue(i, *rgb, 1)
    table.SetNanColor(*GREY, 1)
    return table


def vectors_or_normals(surface, normals, vectors):
    if not normals:
        return vectors
    a, b, c = (surface.points[surface.triangles[:, i]] for i in range(3))
    sums, area = np.zeros((surface.n_points, 3)), np.cross(b - a, c - a)
    for axis in range(3):
        for corner in range(3):
            sums[:, axis] += np.bincount(surface.triangles[:, corner], area[:, axis],
                                         surface.n_points)
    return sums


def colours_of_vectors(vectors):
    """x, y and z of the unit vectors as red, green and blue."""
    vectors = np.asarray(vectors, float)[:, :3]
    if vectors.shape[1] < 3:
        vectors = np.pad(vectors, ((0, 0), (0, 3 - vectors.shape[1])))
    length = np.maximum(np.linalg.norm(vectors, axis=1, keepdims=True), 1e-300)
    return np.nan_to_num(127.5 + 127.5 * vectors / length).astype(np.uint8)


def curve_of(history):
    """The energy over time as an SVG picture; empty if there is none."""
    energy, time = (np.asarray(history.get(name, ()), float) for name in ("Energy", "Time"))
    keep = np.isfinite(energy) & np.isfinite(time) if energy.shape == time.shape else []
    if np.sum(keep) < 2:
        return ""
    energy, time = energy[keep], time[keep]
    x = 40 + 290 * (time - time[0]) / max(time[-1] - time[0], 1e-300)
    y = 20 + 110 * (energy.max() - energy) / max(energy.max() - energy.min(), 1e-300)
    line = " ".join(f"{a:.1f},{b:.1f}" for a, b in zip(x, y))
    words = ((40, 12, "start", f"energy {energy.max():.4g} to {energy[-1]:.4g}"),
             (40, 150, "start", f"time {time[0]:.4g}"), (330, 150, "end", f"{time[-1]:.4g}"))
    return ('<svg viewBox="0 0 340 156" width="340" height="156" font-size="12" fill="currentColor">'
            '<path d="M40 20V130H330" fill="none" stroke="currentColor"/>'
            f'<polyline points="{line}" fill="none" stroke="#d33" stroke-width="2"/>'
            + "".join(f'<text x="{a}" y="{b}" text-anchor="{anchor}">{text.escape(word)}</text>'
                      for a, b, anchor, word in words) + "</svg>")


def main():
    page = Page()

    def ready(**_):
        print(f"port {page.server.port}", flush=True)
        page.start()

    page.ctrl.on_server_ready.add(ready)
    # The front process holds the other end of standard input: the page ends with it.
    threading.Thread(target=lambda: (sys.stdin.read(), os._exit(0)), daemon=True).start()
    page.server.start(open_browser=False, show_connection_info=False, disable_logging=True)
    os._exit(0)  # at once, although a run may be under way


if __name__ == "__main__":
    main()
