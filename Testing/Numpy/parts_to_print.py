# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Parts as users bring them: clean ones, and what programs make of them. A part is points (n, 3), triangles (m, 3)."""

import numpy as np


def box(size=(24, 24, 24), place=(0, 0, 0)):
    points = np.array([[i & 1, i >> 1 & 1, i >> 2] for i in range(8)]) * size + place
    squares = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]]
    return points.astype(float), np.array([t for a, b, c, d in squares for t in ((a, b, c), (a, c, d))])


def prism(ring, height, place=(0, 0, 0)):
    """Over a polygon (n, 2) that is seen whole from the origin."""
    n = len(ring)
    flat = np.vstack([ring, ring, [[0, 0]], [[0, 0]]])
    z = np.repeat([0, height, 0, height], [n, n, 1, 1])
    i = np.arange(n)
    j = (i + 1) % n
    rows = np.concatenate([np.stack([i, j, n + j], 1), np.stack([i, n + j, n + i], 1),
                           np.stack([j, i, np.full(n, 2 * n)], 1), np.stack([n + i, n + j, np.full(n, 2 * n + 1)], 1)])
    return np.column_stack([flat, z]) + place, rows


def rod(radius=15.0, height=20.0, facets=60, place=(0, 0, 0)):
    angle = 2 * np.pi * np.arange(facets) / facets
    return prism(radius * np.column_stack([np.cos(angle), np.sin(angle)]), height, place)


def gear(teeth=12, radius=20.0, tooth=4.0, height=8.0):
    angle = 2 * np.pi * (np.arange(4 * teeth) + 0.5) / (4 * teeth)
    r = np.where(np.arange(4 * teeth) % 4 < 2, radius + tooth, radius)
    return prism(r[:, None] * np.column_stack([np.cos(angle), np.sin(angle)]), height)


def ball(radius=10.0, place=(0, 0, 0), rings=12):
    theta = np.pi * np.arange(1, rings) / rings
    phi = np.pi * np.arange(2 * rings) / rings
    rows = [np.column_stack([np.sin(t) * np.cos(phi), np.sin(t) * np.sin(phi), np.full(len(phi), np.cos(t))])
            for t in theta]
    points = np.vstack([*rows, [[0, 0, 1]], [[0, 0, -1]]]) * radius + place
    n, i = len(phi), np.arange(len(phi))
    j = (i + 1) % n
    faces = [np.stack([np.full(n, len(points) - 2), i, j], 1),
             np.stack([np.full(n, len(points) - 1), (rings - 2) * n + j, (rings - 2) * n + i], 1)]
    for k in range(rings - 2):
        a, b, c, d = k * n + i, k * n + j, (k + 1) * n + j, (k + 1) * n + i
        faces += [np.stack([a, d, c], 1), np.stack([a, c, b], 1)]
    return points, np.concatenate(faces)


def tube(outer=20.0, inner=12.0, height=40.0, around=32):
    angle = 2 * np.pi * np.arange(around) / around
    ring = np.column_stack([np.cos(angle), np.sin(angle), np.zeros(around)])
    rings = [outer * ring, outer * ring + [0, 0, height], inner * ring + [0, 0, height], inner * ring]
    i = np.arange(around)
    j, faces = (i + 1) % around, []
    for k in range(4):
        a, b = k * around, (k + 1) % 4 * around
        faces += [np.stack([a + i, a + j, b + j], 1), np.stack([a + i, b + j, b + i], 1)]
    return np.vstack(rings), np.concatenate(faces)


def inside_out(part):
    return part[0], part[1][:, ::-1]


def together(*parts):
    """All in one, with points of their own."""
    starts = np.cumsum([0, *(len(points) for points, _ in parts)])
    return (np.vstack([points for points, _ in parts]),
            np.vstack([faces + start for (_, faces), start in zip(parts, starts)]))


def hollow(part, cavity):
    return together(part, inside_out(cavity))


def soup(part):
    """Three points of its own for each triangle."""
    return part[0][part[1]].reshape(-1, 3), np.arange(3 * len(part[1])).reshape(-1, 3)


def rounded_apart(part, share=1e-6, seed=1):
    """As programs write them: each corner rounded to itself. share: of the size of the part."""
    points, faces = soup(part)
    size = np.linalg.norm(np.ptp(points, axis=0))
    return points + share * size * np.random.default_rng(seed).uniform(-1, 1, points.shape), faces


def with_t_junctions(part, count=5, seed=1):
    """Vertices on edges that only one of the two triangles knows."""
    points, faces = list(part[0]), part[1].tolist()
    random = np.random.default_rng(seed)
    for t in random.choice(len(faces), count, replace=False):
        a, b, c = np.roll(faces[t], random.integers(3))
        share = random.uniform(0.2, 0.8)
        points.append((1 - share) * part[0][a] + share * part[0][b])
        faces[t] = [a, len(points) - 1, c]
        faces.append([len(points) - 1, b, c])
    return np.array(points), np.array(faces)


def with_repeats(part, count=7, opposite=False, seed=1):
    rows = part[1][np.random.default_rng(seed).choice(len(part[1]), count, replace=False)]
    return part[0], np.vstack([part[1], rows[:, ::-1] if opposite else np.roll(rows, 1, axis=1)])


def with_flat_facets(part, count=4, seed=1):
    """A facet of no area in a T-junction, as CAD programs fill these."""
    points, faces = with_t_junctions(part, count, seed)
    m = len(part[1])
    flat = [[faces[t][0], faces[m + k][1], faces[t][1]]
            for k in range(count) for t in [np.flatnonzero(faces[:m, 1] == faces[m + k, 0])[0]]]
    return points, np.vstack([faces, flat])


def stacked(height=12.0):
    """Two boxes on each other, with both facets of the wall between them."""
    return together(box((24, 24, height)), box((24, 24, height), (0, 0, height)))


def renumbered(part, seed=1):
    random = np.random.default_rng(seed)
    order = random.permutation(len(part[0]))
    number = np.argsort(order)
    return part[0][order], number[part[1]][random.permutation(len(part[1]))]


def volume(points, faces):
    places = np.asarray(points, dtype=float) - np.mean(points, axis=0, dtype=float)
    a, b, c = (places[faces[:, i]] for i in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c)) / 6)
