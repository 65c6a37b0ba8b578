"""
Ocean temperature with coasts
=============================

Buoys measure the temperature of the sea at a few places, with errors. Between them it is interpolated
within the water, not across land.
"""
import numpy as np
from surfacediffusion import interpolate, random_field, scale_filter, spectrum, sphere
from surfacediffusion.examples import land, show

earth = sphere(5, radius=6371.0)

# %%
# VTK has the coasts as polygons. A point is land if an odd number of their edges lies to its north.
dry = land(earth)
latitude = np.degrees(np.arcsin(earth.points[:, 2] / 6371.0))
longitude = np.degrees(np.arctan2(earth.points[:, 1], earth.points[:, 0]))
print(f"{100 * dry.mean():.0f} % land")

# %%
# 400 buoys, with an error of 1 degree. The other points are NaN, which is missing, and land is left out by the
# mask.
random = np.random.default_rng(0)
truth = 30 * np.cos(np.radians(latitude)) ** 2 - 2 + 3 * np.sin(np.radians(3 * longitude))
buoys = random.choice(np.flatnonzero(~dry), 400, replace=False)
measured = np.full(earth.n_points, np.nan)
measured[buoys] = truth[buoys] + random.normal(scale=1.0, size=buoys.size)
result = interpolate(earth, measured, mask=dry)
temperature = np.where(dry, np.nan, result.values)
error = np.sqrt(np.nanmean((temperature - truth) ** 2))
print(f"error {error:.2f} degrees, of buoys estimated as {result.noise_level[0]:.2f}")
assert error < 1
show(earth.points, earth.triangles, {"buoys": measured, "temperature": temperature}, view=(-0.5, -1, 0.4),
     up=(0, 0, 1), cmap="coolwarm", clim=(-3, 31), nan_color="white")

# %%
# Eddies of some 500 km, which no buoy resolves, on top of the temperature. The filter by scale leaves what is
# longer than 3,000 km, within the water: land is left out by the mask.
eddies = random_field(earth, 1, fwhm=500, mask=dry)[:, 0]
sea = truth + eddies
large = scale_filter(earth, sea, 3000, order=2, mask=dry)
show(earth.points, earth.triangles, {"with eddies": sea, "above 3,000 km": large, "eddies": sea - large},
     view=(-0.5, -1, 0.4), up=(0, 0, 1), cmap="coolwarm", nan_color="white")
assert np.corrcoef((sea - large)[np.isfinite(large)], eddies[np.isfinite(large)])[0, 1] > 0.8

# %%
# The variance of the eddies between wavelengths, in km and degrees squared.
found = spectrum(earth, eddies, [1000, 2000, 4000, 8000], mask=dry)
for low, high, variance in zip([0, *found.wavelength], [*found.wavelength, np.inf], found.variance):
    print(f"{low:5.0f} to {high:5.0f} km: {variance:.2f}")
