"""
Shortest paths
==============

The shortest path along the edges of a mesh (Dijkstra) zigzags and is too long, on fine meshes as on coarse ones.
The geodesic path is straight over the faces, and is shortened until no other one near it is shorter.
"""
import numpy as np
import pyvista
from surfacediffusion import distance, geodesic_path, sphere

# %%
# Two points of a bumpy ball, and the path between them.
ball = sphere(4)
x, y, z = ball.points.T
points = 25 * ball.points * (1 + 0.1 * np.sin(5 * x) * np.cos(4 * y))[:, None]
start, end = int(np.argmin(x + z)), int(np.argmax(x + y))
path = geodesic_path((points, ball.faces), start, end)
shortest = distance((points, ball.faces), [start], method="exact")[end]

# %%
# Dijkstra's path, by PyVista.
mesh = pyvista.PolyData.from_regular_faces(points, ball.faces)
along_edges = mesh.geodesic(start, end)
length = mesh.geodesic_distance(start, end)
print(f"{path.length:.2f} mm, {length:.2f} mm along edges, and at least {shortest:.2f} mm")
assert shortest * (1 - 1e-9) <= path.length < 1.001 * shortest and length > 1.02 * path.length

# %%
# The geodesic path in red, Dijkstra's in black, over the distance from the start.
plotter = pyvista.Plotter(window_size=(600, 500))
mesh["distance"] = distance((points, ball.faces), [start])
plotter.add_mesh(mesh, scalars="distance", cmap="Blues", show_edges=True, edge_color="lightgrey", show_scalar_bar=False)
plotter.add_mesh(pyvista.lines_from_points(1.01 * path.points), color="red", line_width=5)
plotter.add_mesh(pyvista.lines_from_points(1.01 * along_edges.points), color="black", line_width=4)
plotter.view_vector(points[start] + points[end] + (0.0, 10.0, 0.0), (0, 0, 1))
plotter.show()
