"""
Are two maps related?
=====================

Two maps of a cortex that are both smooth correlate by chance much more than independent numbers do, because
neighbours are alike. Surrogates, random maps with the values and the smoothness of one of them, show how much.

From file to file this is::

    surfacediffusion surrogates lh.white.surf.gii thickness.shape.gii null.func.gii --roi lh.cortex.label
"""
import numpy as np
from surfacediffusion import Surface, curvature, heat, random_field, surrogates
from surfacediffusion.examples import fetch, show
from surfacediffusion.files import read_data, read_surface

white = read_surface(fetch("white_left.gii.gz"))
thickness = read_data(fetch("thick_left.gii.gz")).parts[0].values[:, 0].astype(float)
wall = ~read_data(fetch("rest_left.mgz")).parts[0].values.any(axis=1)
surface = Surface(white.points, white.faces)
smooth = heat(surface, thickness, fwhm=10, roi=~wall)

# %%
# 500 surrogates of the thickness have its values, each as often, at other places. The model says which
# widths the map is made of; 0 is the part without correlation.
null = surrogates(surface, smooth, 500, roi=~wall)
for width, share in zip(null.fwhm, null.variances):
    print(f"FWHM {width:5.1f} mm: {100 * share:3.0f} % of the variance")
assert np.array_equal(np.sort(null.values[~wall, 0]), np.sort(smooth[~wall]))
show(surface.points, surface.faces,
     {"thickness": np.where(wall, np.nan, smooth), "a surrogate": null.values[:, 0],
      "another one": null.values[:, 1]}, view=(-1, 0, 0.1), up=(0, 0, 1), clim=(1.5, 3.5), nan_color="white")


def share_of_larger(other):
    """The correlation of the thickness with another map, and p: the share of surrogates with a larger one."""
    found = np.corrcoef(smooth[~wall], other[~wall])[0, 1]
    random = np.corrcoef(null.values[~wall].T, other[~wall])[-1, :-1]
    return found, (1 + (abs(random) >= abs(found)).sum()) / (1 + random.size)


# %%
# Gyri are thicker than sulci. No surrogate correlates with the curvature as the thickness does.
bends = heat(surface, curvature(surface, fwhm=5).mean, fwhm=10, roi=~wall)
found, p = share_of_larger(bends)
print(f"thickness and curvature: correlation {found:.2f}, p = {p:.3f}")
assert p < 0.01

# %%
# Random fields as smooth as the thickness have nothing to do with it. If points were independent, a correlation
# of 0.02 among 9,354 of them would be significant at 5 %. Most of these fields exceed it; of the p values by
# surrogates about one in twenty is below 0.05.
fields = random_field(surface, 200, fwhm=20, mask=wall, seed=7)
results = np.array([share_of_larger(field) for field in fields.T])
naive = (abs(results[:, 0]) > 1.96 / np.sqrt((~wall).sum())).mean()
print(f"related by chance: {100 * naive:.0f} % as if points were independent, "
      f"{100 * (results[:, 1] <= 0.05).mean():.1f} % by surrogates")
assert naive > 0.5 and (results[:, 1] <= 0.05).mean() < 0.12
