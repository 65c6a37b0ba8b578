// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

/** A rough pebble with noisy stripes as the text of a PLY file, so that there is something to try at once. */
function pebble() {
  const rings = 70, around = 140, lines = [], faces = [];
  let seed = 1;
  const noise = () => { // sums of four even random numbers, near to normal ones
    let sum = -2;
    for (let k = 0; k < 4; ++k) {
      seed = (1103515245 * seed + 12345) % 2147483648;
      sum += seed / 2147483648;
    }
    return 1.7 * sum;
  };
  const add = (polar, angle) => {
    const [x, y, z] = [Math.sin(polar) * Math.cos(angle), Math.sin(polar) * Math.sin(angle), Math.cos(polar)];
    const radius = 10 + Math.sin(3 * x) * Math.cos(2 * y) + 1.5 * y * z + 0.02 * noise();
    const wave = Math.sin(4 * x + 2 * y * z) + 0.6 * z;
    const stripe = (wave > -0.4) + (wave > 0.5) + 0.2 * noise();
    lines.push([x, y, z].map((c) => (radius * c).toFixed(4)).concat(stripe.toFixed(3)).join(" "));
  };
  add(0, 0);
  for (let r = 1; r < rings; ++r) {
    for (let a = 0; a < around; ++a) { add(Math.PI * r / rings, 2 * Math.PI * (a + 0.5 * (r % 2)) / around); }
  }
  add(Math.PI, 0);
  const id = (r, a) => 1 + (r - 1) * around + (a + around) % around, end = lines.length - 1;
  for (let a = 0; a < around; ++a) {
    faces.push(`3 0 ${id(1, a)} ${id(1, a + 1)}`, `3 ${end} ${id(rings - 1, a + 1)} ${id(rings - 1, a)}`);
    for (let r = 1; r < rings - 1; ++r) {
      const s = r % 2; // odd rings are turned by half a step
      faces.push(s ? `3 ${id(r, a)} ${id(r + 1, a)} ${id(r + 1, a + 1)}` : `3 ${id(r, a)} ${id(r + 1, a)} ${id(r, a + 1)}`,
        s ? `3 ${id(r, a)} ${id(r + 1, a + 1)} ${id(r, a + 1)}` : `3 ${id(r, a + 1)} ${id(r + 1, a)} ${id(r + 1, a + 1)}`);
    }
  }
  const head = ["ply", "format ascii 1.0", `element vertex ${lines.length}`, "property double x", "property double y",
    "property double z", "property double stripes", `element face ${faces.length}`,
    "property list uchar int vertex_indices", "end_header"];
  return new TextEncoder().encode([...head, ...lines, ...faces, ""].join("\n")).buffer;
}
