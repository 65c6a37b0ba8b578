// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// What is measured of a mesh, and what runs on it take of the memory.

/**
 * The engine's memory in bytes, and what a run takes of it for each triangle: measured with 100,000, times 1.3,
 * since factors of matrices grow faster than surfaces.
 */
const ROOM = 2e9;
const MEMORY = { curvature: 540, denoise_mesh: 540, derivatives: 640, direction_field: 1340, distance: 540,
  harmonic_map: 930, heat: 640, interpolate: 2300, intrinsic_tv: 540, mumford_shah: 770, random_field: 1340,
  relief: 770, segment: 770, tensor_diffusion: 540, turing_texture: 770 };

const rounded = (x) => Number(x.toPrecision(3));
const plural = (count, word) => `${count.toLocaleString("en")} ${word}${count === 1 ? "" : "s"}`;

/** The sentence of runs that the memory has no room for; empty for others. */
function refusal(mesh, model, options) {
  const count = trianglesOf(mesh, options), bytes = MEMORY[model] * count;
  if (!(bytes > ROOM)) { return ""; }
  return `${model} on ${plural(Math.round(count), "triangle")} takes about ${(bytes / 1e9).toFixed(1)} GB of memory; `
    + `allowed: ${ROOM / 1e9} GB, which a page has, thus up to ${plural(rounded(ROOM / MEMORY[model]), "triangle")}`;
}

/** About how many triangles a run has, which bisects edges that are longer than refine_to. */
function trianglesOf({ points, triangles }, options) {
  const { refine_to: asked, feature_size: size = 0, maximum_number_of_triangles: most = 4e6 } = options;
  const own = triangles.length / 3, length = asked === undefined || asked < 0 ? size / 8 : asked;
  if (!(length > 0)) { return own; }
  let area = 0;
  for (let i = 0; i < triangles.length; i += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => 3 * triangles[i + k]);
    const [u, v] = [b, c].map((corner) => [0, 1, 2].map((axis) => points[corner + axis] - points[a + axis]));
    area += 0.5 * Math.hypot(...cross(u, v));
  }
  // Of the edges that bisection leaves, the mean is three quarters of the longest.
  return Math.max(own, Math.min(most, area / (0.24 * length * length)));
}

/** Values at 200 of the points. */
function sampled({ values, components }) {
  const count = values.length / components, step = Math.max(1, count / 200), points = [];
  for (let i = 0.5 * step; i < count; i += step) { points.push(Math.floor(i)); }
  return { points, values: points.map((p) => values[components * p]) };
}

/**
 * Size, extent, a coordinate as the data of a mesh that has none, and the view from three quarters above:
 * y is up in scans, z in parts to print and in brains, which are seen from outside.
 */
function measure({ points }, kind) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], points[i]);
    high[i % 3] = Math.max(high[i % 3], points[i]);
  }
  const extent = high.map((x, axis) => x - low[axis]), size = Math.max(...extent);
  const isScan = /OBJ|OFF|PLY/.test(kind), isBrain = /GIFTI|FreeSurfer/.test(kind), up = isScan ? 1 : 2;
  const axis = extent[up] > 1e-3 * size ? up : extent.indexOf(size);
  const view = isScan ? [[0.55, 0.55, 1], [0, 1, 0]]
    : [isBrain ? [low[0] + high[0] < 0 ? -1 : 1, -0.6, 0.4] : [0.55, -1, 0.55]];
  return { extent, size, own: { name: axis === up ? "Height" : `Coordinate_${"xyz"[axis]}`, axis }, view };
}

function highest({ points, own: { axis } }) {
  let best = axis;
  for (let i = axis; i < points.length; i += 3) {
    if (points[i] > points[best]) { best = i; }
  }
  return (best - axis) / 3;
}
