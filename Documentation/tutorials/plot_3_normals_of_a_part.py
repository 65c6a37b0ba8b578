"""
Normals of a machine part
=========================

A scanned part has noise. A harmonic map with exponent 1 makes its faces even and keeps its creases;
exponent 2 rounds them. The part without noise is known here, and the time step is near the best of
twelve for it; without one, try a few and look.
"""
import numpy as np
from pyvista.examples import load_nut
from surfacediffusion import Surface, harmonic_map, refine
from surfacediffusion.examples import show

# A nut from CAD, whose long edges are bisected to 1 mm
nut = load_nut()
fine = refine((nut.points, nut.regular_faces), 1.0).surface
points, faces = fine.points, fine.triangles
edges = np.linalg.norm(points[faces] - np.roll(points[faces], 1, axis=1), axis=2)
noisy = points + np.random.default_rng(0).normal(scale=0.12 * edges.mean(), size=points.shape)
surface = Surface(noisy, faces)
creases = harmonic_map(surface, exponent=1.0, move_vertices=True, time_step=0.03,
                       number_of_time_steps=4)
rounded = harmonic_map(surface, exponent=2.0, move_vertices=True, time_step=0.03,
                       number_of_time_steps=4)

# %%
show(points, faces, {"scan": noisy, "exponent 1": creases.points, "exponent 2": rounded.points},
     view=(1, 0.6, 1))


def normals(points):
    a, b, c = (points[faces[:, i]] for i in range(3))
    normal = np.cross(b - a, c - a)
    return normal / np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-300)


def error(points_found):
    """The mean angle between the normals of faces and those of the part without noise."""
    cosine = np.clip((normals(points_found) * normals(points)).sum(axis=1), -1, 1)
    return np.degrees(np.arccos(cosine)).mean()


for name, found in (("scan", noisy), ("exponent 1", creases.points), ("exponent 2", rounded.points)):
    print(f"{name}: normals are off by {error(found):.1f} degrees")
assert error(creases.points) < 0.6 * error(noisy)
