"""
Cortical thickness with a given width
=====================================

Thickness is smoothed by 10 mm. The medial wall, which has no cortex, is excluded.
"""
from tutorial_data import cortex, show

import numpy as np
from surfacediffusion import Surface, heat

points, faces, thickness = cortex()
wall = thickness == 0
surface = Surface(points, faces)
smooth = heat(surface, thickness, fwhm=10, mask=wall, mask_mode="Exclude")

# %%
# The integral over the cortex is kept, and the wall keeps its zeros.
corners = points[faces]
area = np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) / 2
inside = ~wall[faces].any(axis=1)  # triangles without a point of the wall


def mean(values):
    return (area * values[faces].mean(axis=1))[inside].sum() / area[inside].sum()


print(f"mean {mean(thickness):.4f} mm before, {mean(smooth):.4f} mm after")
assert abs(mean(smooth) - mean(thickness)) < 0.001 * mean(thickness)
assert np.array_equal(smooth[wall], thickness[wall])
show(points, faces, {"thickness": thickness, "smoothed": smooth}, view=(-1, 0, 0.1), up=(0, 0, 1),
     clim=(0, 4))
