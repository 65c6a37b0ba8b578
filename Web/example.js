// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

/** A rough pebble with noisy stripes as the text of a PLY file, so that there is something to try at once. */
function pebble() {
  const g = (1 + Math.sqrt(5)) / 2, lines = [];
  let seed = 1, faces = [[0, 11, 5], [0, 5, 1], [0, 1, 7], [0, 7, 10], [0, 10, 11], [1, 5, 9], [5, 11, 4], [11, 10, 2],
    [10, 7, 6], [7, 1, 8], [3, 9, 4], [3, 4, 2], [3, 2, 6], [3, 6, 8], [3, 8, 9], [4, 9, 5], [2, 4, 11], [6, 2, 10],
    [8, 6, 7], [9, 8, 1]];
  const points = [[-1, g, 0], [1, g, 0], [-1, -g, 0], [1, -g, 0], [0, -1, g], [0, 1, g], [0, -1, -g], [0, 1, -g],
    [g, 0, -1], [g, 0, 1], [-g, 0, -1], [-g, 0, 1]].map(unit);
  for (let level = 0; level < 5; ++level) { // the icosahedron's triangles in four, again and again
    const middles = new Map(), middle = (a, b) => {
      const key = Math.min(a, b) * 1e6 + Math.max(a, b);
      if (!middles.has(key)) { middles.set(key, points.push(unit(points[a].map((x, axis) => x + points[b][axis]))) - 1); }
      return middles.get(key);
    };
    faces = faces.flatMap(([a, b, c]) => {
      const [d, e, f] = [middle(a, b), middle(b, c), middle(c, a)];
      return [[a, d, f], [d, b, e], [f, e, c], [d, e, f]];
    });
  }
  const noise = () => { // sums of four even random numbers, near to normal ones
    let sum = -2;
    for (let k = 0; k < 4; ++k) {
      seed = (1103515245 * seed + 12345) % 2147483648;
      sum += seed / 2147483648;
    }
    return 1.7 * sum;
  };
  points.forEach(([x, y, z]) => {
    const radius = 10 + Math.sin(3 * x) * Math.cos(2 * y) + 1.5 * y * z + 0.02 * noise();
    const wave = Math.sin(4 * x + 2 * y * z) + 0.6 * z;
    const stripe = (wave > -0.4) + (wave > 0.5) + 0.2 * noise();
    lines.push([x, y, z].map((c) => (radius * c).toFixed(4)).concat(stripe.toFixed(3)).join(" "));
  });
  const head = ["ply", "format ascii 1.0", `element vertex ${lines.length}`, "property double x", "property double y",
    "property double z", "property double stripes", `element face ${faces.length}`,
    "property list uchar int vertex_indices", "end_header"];
  return new TextEncoder().encode([...head, ...lines, ...faces.map((face) => `3 ${face.join(" ")}`), ""].join("\n")).buffer;
}
