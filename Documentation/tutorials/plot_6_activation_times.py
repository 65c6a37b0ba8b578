"""
Activation times of an atrium
=============================

A catheter measures when the wall of a heart chamber is activated, at some hundred points, with errors.
The map between them is interpolated on the surface, which has holes for veins and the valve, and the
conduction velocity follows from its slopes. :doc:`/files` has the lines that read maps of CARTO, EnSite,
OpenEP and openCARP.
"""
import numpy as np
import pyvista
from surfacediffusion import Surface, conduction_velocity, distance, interpolate, sphere
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
# Activation starts in two places and spreads with 0.6 mm/ms, which is 0.6 m/s.
starts = [np.argmax(points[:, 2]), np.argmin(points @ (1.0, 1.0, 1.0))]
time = distance(atrium, starts) / 0.6

# %%
# 400 places are measured, with an error of 2 ms, and none of them in front (y > 13 mm). The points of a
# catheter lie beside the wall: they count at its nearest points. Where the system has no time it writes
# -10000.
random = np.random.default_rng(0)
seen = np.flatnonzero(points[:, 1] < 13)
chosen = random.choice(seen, 400, replace=False)
electrodes = points[chosen] + random.normal(scale=0.5, size=(400, 3))
times = time[chosen] + random.normal(scale=2.0, size=400)
times[::50] = -10000
result = interpolate(atrium, times, electrodes, maximum_distance=5.0, missing_value=-10000, compute_error=True)
found, error = result.values, result.error
rms = np.sqrt(np.mean((found - time)[seen] ** 2))
print(f"error {rms:.1f} ms of {time.max():.0f} ms")
assert rms < 2

# %%
# The standard error shows where nobody has measured: there the map is a guess. `distance_to_data` says how far
# the nearest value is.
far = result.distance_to_data > 10.0
print(f"standard error {np.median(error[~far]):.1f} ms, and {np.median(error[far]):.1f} ms beyond 10 mm of any value")
assert np.median(error[far]) > 2 * np.median(error[~far])
measured = np.full(len(points), np.nan)
measured[chosen[times > -10000]] = times[times > -10000]
look = dict(view=(-1, -1, 1), up=(0, 0, 1), nan_color="lightgrey")
show(points, faces, {"measured (ms)": measured, "map": found, "truth": time}, cmap="rainbow_r",
     clim=(0, time.max()), **look)
show(points, faces, {"standard error (ms)": np.where(far, np.nan, error)}, cmap="viridis", **look)

# %%
# The conduction velocity is the inverse of the slope of the map, with a band from the error of slopes. Where fronts
# meet, or begin, the direction turns within an edge: `collision` and `focus` mark such points, and the map, which
# is smooth, rounds off what is around them, so that 6 mm there are left out, too.
waves = conduction_velocity(atrium, found, error=result)
masked = far | (distance(atrium, waves.collision) < 6) | (distance(atrium, waves.focus) < 6)
clear = ~masked & ~np.isnan(waves.speed)
inside = (waves.speed_lower <= 0.6) & (0.6 <= waves.speed_upper)
print(f"speed {np.median(waves.speed[clear]):.2f} m/s, 0.6 is in {100 * inside[clear].mean():.0f} % of the bands")
assert abs(np.median(waves.speed[clear]) - 0.6) < 0.05 and inside[clear].mean() > 0.87

# %%
# Isochrones every 20 ms, white where they may be with the band from `lower` to `upper`, and arrows of the velocity
# where it is determined.
may_be = np.floor(result.lower / 20) < np.floor(result.upper / 20)
mesh = pyvista.PolyData.from_regular_faces(points, faces)
mesh["time"] = found
plotter = pyvista.Plotter(shape=(1, 2), window_size=(900, 450), border=False)
plotter.add_mesh(mesh, scalars=np.where(may_be, np.nan, found), cmap="rainbow_r", clim=(0, found.max()),
                 nan_color="white", show_scalar_bar=False)
plotter.add_mesh(mesh.contour(np.arange(20, found.max(), 20), scalars="time"), color="black", line_width=3,
                 render_lines_as_tubes=True)
plotter.add_text("isochrones every 20 ms, bands of 90 %", font_size=10)
plotter.view_vector(look["view"], look["up"])
plotter.subplot(0, 1)
plotter.add_mesh(mesh, scalars=np.where(masked, np.nan, waves.speed), clim=(0.3, 0.9), cmap="viridis",
                 nan_color="lightgrey", show_scalar_bar=False)
some = np.flatnonzero(clear)[::25]
plotter.add_arrows(points[some] * 1.01, waves.direction[some], mag=4, color="black")
plotter.add_text("speed and direction", font_size=10)
plotter.view_vector(look["view"], look["up"])
plotter.link_views()
plotter.show()
