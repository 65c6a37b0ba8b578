# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Smoothing by each program: smooth(surface path, columns, fwhm) -> columns.

`python peers.py PEER SURFACE DATA FWHM OUTPUT` runs one of those that are Python functions as a
process of its own, so that time and memory can be measured; it prints the processor time of the
smoothing alone.
"""
from __future__ import annotations

import importlib
import os
import resource
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from surfaces import read_columns, read_surface, write_columns


@dataclass
class Cost:
    """Of a process; `cpu` in s of all threads, `memory` in bytes."""

    wall: float
    cpu: float
    memory: float
    output: str


#: Starts a process and prints its exit code and costs on the last line. Linux counts the memory of
#: the process that starts another one to the other one: a small one has to do it.
LAUNCHER = """
import os, sys, time
start = time.perf_counter()
child = os.posix_spawnp(sys.argv[1], sys.argv[1:], os.environ)
_, status, usage = os.wait4(child, 0)
print(f"\\n{os.waitstatus_to_exitcode(status)} {time.perf_counter() - start} "
      f"{usage.ru_utime + usage.ru_stime} {usage.ru_maxrss * 1024}")
"""


def run(command):
    """Run a process to its end and measure it."""
    words = [sys.executable, "-I", "-S", "-c", LAUNCHER, *[str(word) for word in command]]
    output, _, last = subprocess.run(
        words, stdout=subprocess.PIPE, text=True, check=True,
        env=dict(os.environ, PYTHONWARNINGS="ignore")).stdout.rstrip("\n").rpartition("\n")
    code, *costs = map(float, last.split())
    if code:
        raise RuntimeError(f"{command} failed: {output}")
    return Cost(*costs, output)


# ---- the functions of Python ---------------------------------------------------------------------

def ours(points, faces, values, fwhm, mask=None):
    from surfacediffusion import Surface, heat

    options = {} if mask is None else {"mask": mask, "mask_mode": "Exclude"}
    return heat(Surface(points, faces), values, fwhm=fwhm, time_integrator="Exponential",
                number_of_time_steps=1, **options)


def nilearn(points, faces, values, fwhm):
    from nilearn.image import smooth_img
    from nilearn.surface import InMemoryMesh, PolyMesh, SurfaceImage

    mesh = PolyMesh(left=InMemoryMesh(points, faces), right=InMemoryMesh(points, faces))
    image = SurfaceImage(mesh, {"left": values, "right": np.zeros_like(values)})
    return smooth_img(image, fwhm).data.parts["left"]


def cat(points, faces, values, fwhm):
    import cat_surf

    columns = np.reshape(values, (len(values), -1)).T
    return np.column_stack([
        cat_surf.smooth_heatkernel(points, faces, np.ascontiguousarray(column, float), fwhm)
        for column in columns]).reshape(np.shape(values))


# ---- Connectome Workbench, a process -------------------------------------------------------------

def workbench_command(surface, data, fwhm, output, *options):
    return ["wb_command", "-metric-smoothing", surface, data, fwhm, output, "-fwhm", *options]


def workbench(path, values, fwhm, *options):
    with tempfile.TemporaryDirectory() as folder:
        data, output = Path(folder) / "in.func.gii", Path(folder) / "out.func.gii"
        write_columns(data, values)
        run(workbench_command(path, data, fwhm, output, *options))
        return read_columns(output).reshape(np.shape(values))


# ---- CIFTI files ---------------------------------------------------------------------------------

OF_CIFTI = {
    "SurfaceDiffusion": lambda data, fwhm, output, left, right: [
        sys.executable, "-m", "surfacediffusion.command", "smooth", data, fwhm, output,
        "--left", left, "--right", right],
    "Workbench": lambda data, fwhm, output, left, right: [
        "wb_command", "-cifti-smoothing", data, fwhm, fwhm, "COLUMN", output, "-fwhm",
        "-left-surface", left, "-right-surface", right],
}

FUNCTIONS = {"SurfaceDiffusion": ours, "CAT": cat, "nilearn": nilearn}
MODULES = {"SurfaceDiffusion": "surfacediffusion", "CAT": "cat_surf", "nilearn": "nilearn.image"}


def smooth(peer, sample, values, fwhm):
    """Smooth on the whole surface with the program of this name."""
    if peer == "Workbench":
        return workbench(sample.path, values, fwhm)
    return np.asarray(FUNCTIONS[peer](sample.points, sample.faces, values, fwhm), float)


def process_command(peer, surface, data, fwhm, output):
    """The command line that does the same with files."""
    if peer == "Workbench":
        return workbench_command(surface, data, fwhm, output)
    return [sys.executable, __file__, peer, surface, data, fwhm, output]


def main():
    peer, surface, data, fwhm, output = sys.argv[1:]
    points, faces = read_surface(surface)
    values = read_columns(data, np.float32)
    importlib.import_module(MODULES[peer])  # not counted
    before = resource.getrusage(resource.RUSAGE_SELF)
    result = FUNCTIONS[peer](points, faces, values, float(fwhm))
    after = resource.getrusage(resource.RUSAGE_SELF)
    write_columns(output, result)
    print(after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime)


if __name__ == "__main__":
    main()
