"""
Cortical thickness with a given width
=====================================

Thickness is smoothed by 10 mm. The medial wall, where the surface is no cortex, is left out: nothing
flows across its boundary. It has 888 of the 10,242 vertices of fsaverage5's left hemisphere. The wall
cannot be read from the map, which is 0 at 263 vertices and small around them.

From file to file this is one line::

    surfacediffusion smooth surf/lh.white thickness.mgh 10 smooth.mgh --cortex

or, with any other region, ``--roi cortex.label`` in place of ``--cortex``.
"""
from tutorial_data import cortex, medial_wall, show

import numpy as np
from surfacediffusion import Surface, heat

points, faces, thickness = cortex()
wall = medial_wall()
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
