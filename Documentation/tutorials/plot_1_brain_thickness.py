"""
Cortical thickness with a given width
=====================================

Thickness is smoothed by 10 mm. The medial wall, where the surface is no cortex, is left out: nothing
flows across its boundary. It has 888 of the 10,242 vertices of fsaverage5's left hemisphere. The wall
cannot be read from the map, which is 0 at 263 vertices and small around them.

From file to file this is one line::

    surfacediffusion smooth lh.white.surf.gii thickness.shape.gii 10 smooth.shape.gii --roi lh.cortex.label

or, in the folder of a subject of FreeSurfer, ``--cortex`` in place of ``--roi lh.cortex.label``.
"""
import numpy as np
from surfacediffusion import Surface, heat
from surfacediffusion.examples import fetch, show
from surfacediffusion.files import read_data, read_surface

white = read_surface(fetch("white_left.gii.gz"))
points, faces = white.points, white.faces
thickness = read_data(fetch("thick_left.gii.gz")).parts[0].values[:, 0]
# A time series has no signal at the medial wall. FreeSurfer's lh.cortex.label has the other vertices.
wall = ~read_data(fetch("rest_left.mgz")).parts[0].values.any(axis=1)
print(f"{wall.sum()} of {wall.size} vertices are the wall; {(thickness == 0).sum()} have no thickness")
assert wall.sum() == 888

surface = Surface(points, faces)
smooth = heat(surface, thickness, fwhm=10, roi=~wall)

# %%
# The integral over the cortex is kept, and the wall keeps its values.
corners = points[faces]
area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
inside = ~wall[faces].any(axis=1)  # triangles without a point of the wall


def mean(values):
    return (area * values[faces].mean(axis=1))[inside].sum() / area[inside].sum()


print(f"mean {mean(thickness):.4f} mm before, {mean(smooth):.4f} mm after")
assert abs(mean(smooth) - mean(thickness)) < 0.001 * mean(thickness)
assert np.array_equal(smooth[wall], thickness[wall])

# %%
# With the zeros alone left out, the rest of the wall would thin the cortex beside it.
thin = heat(surface, thickness, fwhm=10, roi=thickness != 0)
beside = (thin - smooth)[~wall]
print(f"up to {-beside.min():.2f} mm thinner, by more than 0.1 mm at {(beside < -0.1).sum()} vertices")
assert beside.min() < -0.5
show(points, faces, {"thickness": np.where(wall, 0, thickness), "smoothed": np.where(wall, 0, smooth)},
     view=(1, 0, 0.1), up=(0, 0, 1), clim=(0, 4))
