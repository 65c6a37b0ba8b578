"""
Activation times of an atrium
=============================

A catheter measures when the wall of a heart chamber is activated, at some hundred points, with errors.
The map between them is interpolated on the surface, which has holes for veins and the valve.
"""
import numpy as np
from surfacediffusion import Surface, interpolate, sphere
from surfacediffusion.examples import show

# %%
# A surface like an atrium: a bulged ball of 5 cm with four veins and a valve cut out.
ball = sphere(5)
x, y, z = ball.points.T
points = 25 * ball.points * (1 + 0.15 * np.sin(2 * x + 1) * np.cos(2 * y))[:, None] * (1.1, 0.9, 1)
holes = [((0.8, 0.5, 0.3), 0.3), ((0.8, -0.5, 0.3), 0.3), ((-0.8, 0.5, 0.3), 0.3),
         ((-0.8, -0.5, 0.3), 0.3), ((0, 0, -1), 0.6)]
cut = np.zeros(len(points), bool)
for centre, radius in holes:
    cut |= np.linalg.norm(ball.points - np.array(centre) / np.linalg.norm(centre), axis=1) < radius
kept = ball.triangles[~cut[ball.triangles].any(axis=1)]
used, faces = np.unique(kept, return_inverse=True)
points, faces = points[used], faces.reshape(-1, 3)
atrium = Surface(points, faces)

# %%
# Activation starts in one place and spreads with 1 m/s along edges (Dijkstra's algorithm, for the
# example's truth).
edges = np.unique(np.sort(faces[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1), axis=0)
length = np.linalg.norm(points[edges[:, 0]] - points[edges[:, 1]], axis=1)
time = np.full(len(points), np.inf)
time[np.argmax(points[:, 2])] = 0.0
while True:
    before = time.copy()
    np.minimum.at(time, edges[:, 1], time[edges[:, 0]] + length)
    np.minimum.at(time, edges[:, 0], time[edges[:, 1]] + length)
    if np.array_equal(time, before):
        break

# %%
# 200 places are measured, with an error of 2 ms, and none of them in front (y > 0.6 of the ball). The
# points of a catheter lie beside the wall: they count at its nearest points.
random = np.random.default_rng(0)
seen = np.flatnonzero(points[:, 1] < 13)
chosen = random.choice(seen, 200, replace=False)
electrodes = points[chosen] + random.normal(scale=0.5, size=(200, 3))
times = time[chosen] + random.normal(scale=2.0, size=200)
result = interpolate(atrium, times, electrodes, maximum_distance=5.0, compute_error=True)
found, error = result.values, result.error
rms = np.sqrt(np.mean((found - time)[seen] ** 2))
print(f"error {rms:.1f} ms of {time.max():.0f} ms")
assert rms < 2

# %%
# The standard error shows where nobody has measured: there the map is a guess.
unseen = points[:, 1] > 17
print(f"standard error {np.median(error[seen]):.1f} ms, and {np.median(error[unseen]):.1f} ms in front")
assert np.median(error[unseen]) > 2 * np.median(error[seen])
measured = np.full(len(points), np.nan)
measured[chosen] = times
look = dict(view=(1, 1, 1), up=(0, 0, 1), nan_color="lightgrey")
show(points, faces, {"measured (ms)": measured, "map": found, "truth": time}, cmap="rainbow_r",
     clim=(0, time.max()), **look)
show(points, faces, {"standard error (ms)": error, "where it is above 3 ms": error > 3.0}, cmap="viridis",
     **look)
