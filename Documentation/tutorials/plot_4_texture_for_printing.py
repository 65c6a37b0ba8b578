"""
A texture to print
==================

A labyrinth grows on a part from CAD, across its edges, and becomes relief for a 3D printer. The command
``surfacediffusion texture part.stl 5mm out.stl --relief 0.3mm`` does the same with a file.
"""
import tempfile
from pathlib import Path

import numpy as np
from pyvista.examples import load_nut
from surfacediffusion import Surface, random_field, relief, sphere, turing_texture
from surfacediffusion.examples import show
from surfacediffusion.files import read_surface
from surfacediffusion.files.export import export

nut = load_nut()
points = nut.points * (20 / np.ptp(nut.points, axis=0).max())  # 20 mm long
part = Surface(points, nut.regular_faces)
print(part)

# %%
# The triangles of CAD are far too large for a pattern. Their edges are bisected to eight per wavelength.
# Flat faces stay flat and sharp edges stay sharp.
texture = turing_texture(part, feature_size=5.0, diffusion_rate1=2.6 * 18, refine_to=5.0 / 8,
                         coarse_start_size=0)
fine = texture.surface
print(fine)
show(fine.points, fine.triangles, {"texture": texture.texture}, view=(1, 1, 1.5), up=(0, 0, 1))

# %%
# A smooth relief of 0.3 mm, and one of two levels with slopes of 0.4 mm. The result says whether it is
# closed, whether it crosses itself, and where its thinnest wall is.
smooth = relief(fine, texture.texture, 0.3)
levels = relief(fine, texture.texture, 0.3, levels="Two", flank=0.4)
print(levels)
show(fine.points, fine.triangles,
     {"smooth": smooth.surface.points, "two levels": levels.surface.points}, view=(1, 1, 1.5), up=(0, 0, 1))
assert levels.open_edges == 0 and levels.crossing_triangles == 0

# %%
# For the slicer, STL or 3MF.
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder, "part.stl")
    export(file, levels.surface.points, levels.surface.triangles)
    again = read_surface(file)
print(f"{len(again.points)} points, {len(again.faces)} triangles")
assert len(again.faces) == fine.n_faces

# %%
# A rough stone: a ball with a random field of Matern's class, whose coarse shapes are 8 mm wide and which is rough
# down to the triangles.
ball = sphere(6, radius=12.0)
stone = relief(ball, random_field(ball, 1, range=8.0, nu=1, seed=3)[:, 0], 0.8).surface
show(stone.points, stone.triangles, {"a stone": stone.points}, view=(1, 1, 1.5), up=(0, 0, 1))
assert abs(np.linalg.norm(stone.points, axis=1) - 12.0).max() > 1.0
