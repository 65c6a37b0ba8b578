"""
A texture to print
==================

A texture becomes relief: each point moves along its normal, and the surface is written as STL for a 3D
printer.
"""
import tempfile
from pathlib import Path

from tutorial_data import show

import numpy as np
import pyvista
from surfacediffusion import sphere, turing_texture

ball = sphere(5, radius=30.0)
result = turing_texture(ball, feature_size=7.0, diffusion_rate1=2.6 * 18)

# %%
# Half a millimetre of relief on a ball of 30 mm.
normals = ball.points / 30.0
relief = ball.points + 0.5 * result.texture[:, None] * normals
show(ball.points, ball.triangles, {"texture": result.texture, "relief": relief})

# %%
with tempfile.TemporaryDirectory() as folder:
    file = Path(folder, "ball.stl")
    pyvista.PolyData.from_regular_faces(relief, ball.triangles).save(file)
    again = pyvista.read(file).clean()
print(f"{again.n_points} points, volume {again.volume / 1000:.1f} ml, closed: {again.n_open_edges == 0}")
assert again.n_open_edges == 0 and 4 / 3 * np.pi * 30**3 < again.volume < 4 / 3 * np.pi * 30.5**3
