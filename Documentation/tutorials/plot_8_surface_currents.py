"""
Surface currents with eddies
============================

Currents are vectors in the surface. Smoothing their components one by one takes them out of it; the heat
filter carries them along instead, and ``helmholtz`` has the potentials that filters by scale work on.
"""
import numpy as np
from surfacediffusion import curl, divergence, gradient, heat, helmholtz, random_field, scale_filter, sphere
from surfacediffusion.examples import land, show

earth = sphere(5, radius=6371.0)
normals = earth.points / np.linalg.norm(earth.points, axis=1, keepdims=True)
dry = land(earth)
water = earth.triangles[~dry[earth.triangles].any(axis=1)]
used = np.unique(water)
number = np.full(earth.n_points, -1)
number[used] = np.arange(used.size)
ocean = earth.points[used], number[water]

# %%
# A stream function with eddies of some 1,500 km, in 1,000 km^2/day. Currents run along its contours, n x grad
# of it, in km/day. They are measured with an error in the surface.
stream = 20 * random_field(ocean, 1, fwhm=1500, seed=3)[:, 0]
true = np.cross(normals[used], gradient(ocean, stream)) * 1000
random = np.random.default_rng(0)
noise = random.normal(scale=0.7 * np.sqrt((true ** 2).sum(1).mean() / 2), size=true.shape)
noise -= (noise * normals[used]).sum(1, keepdims=True) * normals[used]
measured = true + noise

# %%
# Smoothed as tangent vectors they stay in the surface, which they leave as three scalars.
settings = {"mode": "SteadyState", "automatic_fidelity": True}
smooth = heat(ocean, measured, vector_type="Tangent", **settings)
apart = heat(ocean, measured, vector_type="Components", **settings)
for name, found in (("measured", measured), ("as vectors", smooth), ("as components", apart)):
    error = np.sqrt(((found - true) ** 2).sum(1).mean() / (true ** 2).sum(1).mean())
    out = np.abs((found * normals[used]).sum(1)).max()
    print(f"{name:14s} error {100 * error:3.0f} %, up to {out:.2g} km/day out of the surface")
# At coasts the planes are those of the triangles there, not of the sphere.
inside = np.setdiff1d(np.arange(len(used)), number[earth.triangles[dry[earth.triangles].any(axis=1)]])
assert np.abs((smooth * normals[used]).sum(1))[inside].max() < 1e-6


def everywhere(values):
    whole = np.full(earth.n_points, np.nan)
    whole[used] = values
    return whole


def speed(vectors):
    return everywhere(np.linalg.norm(vectors, axis=1))


show(earth.points, earth.triangles,
     {"measured": speed(measured), "smoothed": speed(smooth), "truth": speed(true)}, view=(-0.5, -1, 0.2),
     up=(0, 0, 1), cmap="viridis", clim=(0, np.percentile(np.linalg.norm(true, axis=1), 98)),
     nan_color="white")

# %%
# The parts: eddies have no gradient part, what is left of the noise has both. The potential is the stream
# function, but for a constant on each basin, since it is 0 on coasts.
parts = helmholtz(ocean, smooth)
of_curl, of_gradient = (np.sqrt((part ** 2).sum(1).mean()) for part in (parts.curl_part, parts.gradient_part))
print(f"curl part {of_curl:.2f}, gradient part {of_gradient:.2f} km/day")
assert of_gradient < 0.7 * of_curl

# %%
# A filter by scale of the potentials filters the currents: what is longer than 6,000 km, and the eddies.
large = scale_filter(ocean, parts.curl_potential, 6000, order=2)
eddies = parts.curl_potential - large
show(earth.points, earth.triangles,
     {"potential": everywhere(parts.curl_potential), "above 6,000 km": everywhere(large),
      "eddies": everywhere(eddies)}, view=(-0.5, -1, 0.2), up=(0, 0, 1), cmap="coolwarm", nan_color="white")
spin = curl(ocean, smooth)
print(f"curl of the smoothed currents {spin.std():.4f} per day, divergence {divergence(ocean, smooth).std():.4f}")
