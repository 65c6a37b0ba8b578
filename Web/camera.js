// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// Where a surface is seen from. Coordinates are scaled to a box of size 1 about the origin.

const FIELD_OF_VIEW = 0.5; // twice the tangent of half the angle

/** A matrix by columns, as WebGL has them. */
function multiply(a, b) {
  const result = new Float32Array(16);
  for (let c = 0; c < 4; ++c) {
    for (let r = 0; r < 4; ++r) {
      for (let k = 0; k < 4; ++k) {
        result[4 * c + r] += a[4 * k + r] * b[4 * c + k];
      }
    }
  }
  return result;
}

const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const unit = (a) => { const l = Math.hypot(...a) || 1; return a.map((x) => x / l); };

class Camera {
  constructor() {
    this.bars = 60; // CSS pixels above the surface, for titles and colour bars
    this.home = null; // [from, up] of the first view; null: by the shape of the surface
    this.usual = [[0.55, -1, 0.55]]; // that of shapes that are not flat
    this.turn = null; // rows: right, up and towards the camera; null: nothing is framed
    this.pivot = [0, 0, 0];
  }

  /** The whole is seen, as after reset(). */
  get isFitted() { return this.distance === this.fitted; }

  scaled(points, i) { return [0, 1, 2].map((axis) => (points[i + axis] - this.middle[axis]) / this.size); }

  /** Frames the points: as usual, or onto the plane of what is flat. */
  frame(points, port) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
      const axis = i % 3;
      if (points[i] < low[axis]) { low[axis] = points[i]; }
      if (points[i] > high[axis]) { high[axis] = points[i]; }
    }
    this.extent = low.map((x, axis) => high[axis] - x);
    this.middle = low.map((x, axis) => x + 0.5 * this.extent[axis]);
    this.size = Math.max(...this.extent) || 1;
    this.framed = points;
    this.reset(port);
  }

  reset(port) {
    const smallest = Math.min(...this.extent), flat = this.extent.indexOf(smallest);
    const onto = [0, 1, 2].map((axis) => (axis === flat ? (axis === 1 ? -1 : 1) : axis === 1 ? -0.35 : 0.25));
    this.lookFrom(port, ...(this.home || (smallest > 0.08 * this.size ? this.usual : [onto])));
  }

  /** from: the direction to the camera. up: by default z, or y where that is the view's direction. */
  lookFrom(port, from, up = Math.abs(unit(from)[2]) > 0.93 ? [0, 1, 0] : [0, 0, 1]) {
    const back = unit(from);
    const right = unit(cross(up, back));
    this.turn = [right, cross(back, right), back];
    this.pivot = [0, 0, 0];
    this.fit(port);
  }

  /** Moves so that the framed points fill the view, with a margin. */
  fit({ width, height }) {
    const aspect = width / Math.max(height, 1), points = this.framed;
    const free = Math.max(0.5, 1 - this.bars * (window.devicePixelRatio || 1) / Math.max(height, 1)); // below the bars
    const step = 3 * Math.max(1, Math.trunc(points.length / 300000));
    const seen = new Float64Array(3 * Math.ceil(points.length / step)), extent = [[9, -9], [9, -9], [9, -9]];
    for (let i = 0, k = 0; i < points.length; i += step) {
      const [x, y, z] = this.scaled(points, i);
      for (let row = 0; row < 3; ++row, ++k) {
        const [a, b, c] = this.turn[row], range = extent[row], value = a * x + b * y + c * z;
        seen[k] = value;
        if (value < range[0]) { range[0] = value; }
        if (value > range[1]) { range[1] = value; }
      }
    }
    this.aim = extent.slice(0, 2).map(([low, high]) => 0.5 * (low + high));
    const tangent = 0.5 * FIELD_OF_VIEW;
    this.distance = 0.05;
    for (let i = 0; i < seen.length; i += 3) {
      this.distance = Math.max(this.distance, seen[i + 2] + 1.12 * Math.max(
        Math.abs(seen[i + 1] - this.aim[1]) / (tangent * free), Math.abs(seen[i] - this.aim[0]) / (tangent * aspect)));
    }
    this.aim[1] += (1 - free) * tangent * this.distance;
    this.fitted = this.distance;
  }

  matrix({ width, height }) {
    const aspect = width / Math.max(height, 1), t = 2 / FIELD_OF_VIEW;
    const near = Math.max(0.002, this.distance - 1.8), far = this.distance + 1.8;
    const rows = this.turn, d = this.distance;
    const look = [rows[0][0], rows[1][0], rows[2][0], 0, rows[0][1], rows[1][1], rows[2][1], 0,
      rows[0][2], rows[1][2], rows[2][2], 0, -this.aim[0], -this.aim[1], -d, 1];
    const lens = [t / aspect, 0, 0, 0, 0, t, 0, 0, 0, 0, (near + far) / (near - far), -1,
      0, 0, 2 * near * far / (near - far), 0];
    return multiply(lens, look);
  }

  /** Turns about the pivot, which stays where it is seen. */
  rotate(x, y) {
    const place = () => this.turn.map((row) => dot(row, this.pivot));
    const before = place();
    const [c, s, e, f] = [Math.cos(x), Math.sin(x), Math.cos(y), Math.sin(y)];
    const [a, b, d] = this.turn, mix = (p, u, q, v) => p.map((value, i) => value * u + q[i] * v);
    const right = mix(a, c, d, s), back = mix(d, c, a, -s);
    const up = unit(mix(b, e, back, -f));
    this.turn = [unit(right), up, cross(unit(right), up)];
    const moved = place().map((value, i) => value - before[i]);
    this.aim = [this.aim[0] + moved[0], this.aim[1] + moved[1]];
    this.distance += moved[2];
  }

  /** In pixels of the port. */
  pan(dx, dy, { height }) {
    const scale = FIELD_OF_VIEW * this.distance / height;
    this.aim = [this.aim[0] - scale * dx, this.aim[1] + scale * dy];
    this.fitted = NaN;
  }

  zoom(factor) { this.distance = Math.min(40, Math.max(0.01, this.distance * factor)); }

  /** The ray through a place of the port, from -1 to 1 from left to right and from below: {eye, ray} in coordinates. */
  rayThrough(x, y, { width, height }) {
    const t = 0.5 * FIELD_OF_VIEW;
    const toWorld = (v) => [0, 1, 2].map((axis) => this.turn.reduce((sum, row, i) => sum + row[axis] * v[i], 0));
    const eye = toWorld([...this.aim, this.distance]).map((value, axis) => value * this.size + this.middle[axis]);
    return { eye, ray: toWorld([t * width / height * x, t * y, -1]) };
  }
}
