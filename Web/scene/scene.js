// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// A scene of the documentation and the examples: coloured surfaces that turn together. Examples/Python/scenes.py
// writes it as one file with the view of the page.

/**
 * packed: per panel its coordinates (3 float32 a point), triangles (3 uint32) and colours (3 bytes a point,
 * padded to whole words), which unpack() reads.
 */
async function showScene({ columns, panels, packed }) {
  const buffer = await unpack(packed);
  let at = 0;
  const take = (Type, count) => {
    const numbers = new Type(buffer, at, count);
    at += 4 * Math.ceil(numbers.byteLength / 4);
    return numbers;
  };
  const sides = panels.map(({ points, triangles }) => ({ points: take(Float32Array, 3 * points),
    triangles: take(Uint32Array, 3 * triangles), values: { association: "point", colours: true, range: [0, 1],
      numbers: Float32Array.from(take(Uint8Array, 3 * points), (x) => x / 255), map: new Uint8Array(4) } }));
  const view = new SurfaceView(document.querySelector("canvas"), () => {});
  view.columns = columns;
  Object.assign(view.camera, { home: [[0, 0, 1], [0, 1, 0]], bars: 28 });
  const rows = Math.ceil(panels.length / columns);
  const all = new Float32Array(sides.reduce((sum, { points }) => sum + points.length, 0));
  sides.reduce((end, { points }) => { all.set(points, end); return end + points.length; }, 0);
  view.show(sides, all);
  panels.forEach(({ title }, i) => {
    const element = Object.assign(document.createElement("div"), { className: "title", textContent: title });
    Object.assign(element.style, { left: `${100 * (i % columns) / columns}%`, top: `${100 * Math.floor(i / columns) / rows}%` });
    document.body.append(element);
  });
}
