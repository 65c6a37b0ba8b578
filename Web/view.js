// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// A view of one surface, or of two side by side that turn together, in WebGL 2. Points, corners and values
// are textures that the vertex shader reads, so that a new array costs one upload of its values, and
// isolines are exact within triangles.

const TEXTURE_WIDTH = 2048;
const MISSING = 3e38; // stands for NaN, which drivers do not treat alike
const FIELD_OF_VIEW = 0.5; // twice the tangent of half the angle

const VERTEX_SHADER = `#version 300 es
precision highp float;
precision highp int;
precision highp sampler2D;
precision highp usampler2D;
uniform sampler2D points, values, normals;
uniform usampler2D corners;
uniform mat4 projection;
uniform mat3 turn;
uniform highp int kind; // 0: no values, 1: at points, 2: at triangles
uniform bool coloured;
flat out vec3 atCorners;
out vec3 share, normal, colour, place;
ivec2 at(int i) { return ivec2(i % ${TEXTURE_WIDTH}, i / ${TEXTURE_WIDTH}); }
void main() {
  int triangle = gl_VertexID / 3, corner = gl_VertexID % 3;
  uvec3 ids = uvec3(texelFetch(corners, at(3 * triangle), 0).r,
    texelFetch(corners, at(3 * triangle + 1), 0).r, texelFetch(corners, at(3 * triangle + 2), 0).r);
  share = vec3(corner == 0, corner == 1, corner == 2);
  int own = int(ids[corner]);
  atCorners = vec3(0);
  colour = vec3(0);
  if (coloured) {
    colour = texelFetch(values, at(kind == 2 ? triangle : own), 0).rgb;
  } else if (kind == 1) {
    atCorners = vec3(texelFetch(values, at(int(ids.x)), 0).r, texelFetch(values, at(int(ids.y)), 0).r,
      texelFetch(values, at(int(ids.z)), 0).r);
  } else if (kind == 2) {
    atCorners = vec3(texelFetch(values, at(triangle), 0).r);
  }
  vec3 point = texelFetch(points, at(own), 0).rgb;
  normal = turn * texelFetch(normals, at(gl_VertexID), 0).rgb;
  place = turn * point;
  gl_Position = projection * vec4(point, 1);
}`;

const FRAGMENT_SHADER = `#version 300 es
precision highp float;
uniform highp int kind;
uniform bool coloured, labels;
uniform vec2 range; // of the colours
uniform float interval; // of isolines; 0: none
uniform sampler2D map;
uniform vec3 plain;
flat in vec3 atCorners;
in vec3 share, normal, colour, place;
out vec4 result;
void main() {
  vec3 base = plain;
  float line = 0.0;
  if (coloured) {
    base = colour;
  } else if (kind != 0) {
    vec3 known = vec3(lessThan(atCorners, vec3(${MISSING / 3})));
    float part = dot(share, known);
    float nearest = share.x >= share.y && share.x >= share.z ? atCorners.x
      : share.y >= share.z ? atCorners.y : atCorners.z;
    float value = labels ? nearest : dot(share * known, atCorners) / max(part, 1e-6);
    if (labels ? nearest < ${MISSING / 3} : part > 0.5) {
      base = texture(map, vec2(clamp((value - range.x) / max(range.y - range.x, 1e-30), 0.0, 1.0), 0.5)).rgb;
      if (interval > 0.0 && part > 0.999) {
        float phase = value / interval, width = max(fwidth(phase), 1e-6);
        line = (1.0 - smoothstep(0.6, 1.5, abs(fract(phase + 0.5) - 0.5) / width))
          * (1.0 - smoothstep(0.2, 0.5, width)); // lines that are too dense would cover all
      }
    }
  }
  vec3 n = normal;
  if (dot(n, n) < 1e-6) { n = cross(dFdx(place), dFdy(place)); }
  n = normalize(n);
  float facing = n.z;
  bool behind = facing < 0.0;
  if (behind) { n = -n; }
  // A light over the left shoulder, and a weaker one from the right, so that shapes read well.
  float light = 0.34 + 0.56 * max(dot(n, normalize(vec3(-0.35, 0.5, 1.0))), 0.0)
    + 0.14 * max(dot(n, normalize(vec3(0.9, -0.2, 0.5))), 0.0);
  base *= behind && !gl_FrontFacing ? 0.82 : 1.0;
  result = vec4(mix(base * light, base * light * 0.25, 0.8 * line), 1);
}`;

const MARK_VERTEX_SHADER = `#version 300 es
precision highp float;
uniform mat4 projection;
uniform float size;
in vec3 point;
void main() {
  gl_Position = projection * vec4(point, 1);
  gl_Position.z -= 0.004 * gl_Position.w;
  gl_PointSize = size;
}`;

const MARK_FRAGMENT_SHADER = `#version 300 es
precision highp float;
uniform vec3 fill;
out vec4 result;
void main() {
  float r = length(gl_PointCoord - 0.5);
  if (r > 0.5) { discard; }
  result = vec4(r > 0.3 ? vec3(1) : fill, 1);
}`;

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

/**
 * Normals at the corners of triangles: the mean of those of the triangles around the point that meet the
 * corner's own by less than 45 degrees, so that edges of parts stay sharp and skins are smooth.
 */
function cornerNormals(points, triangles) {
  const count = triangles.length / 3, n = points.length / 3;
  const faces = new Float32Array(triangles.length);
  for (let t = 0; t < count; ++t) {
    const [a, b, c] = [3 * triangles[3 * t], 3 * triangles[3 * t + 1], 3 * triangles[3 * t + 2]];
    const [ux, uy, uz] = [points[b] - points[a], points[b + 1] - points[a + 1], points[b + 2] - points[a + 2]];
    const [vx, vy, vz] = [points[c] - points[a], points[c + 1] - points[a + 1], points[c + 2] - points[a + 2]];
    const [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.sqrt(x * x + y * y + z * z) || 1;
    faces[3 * t] = x / length;
    faces[3 * t + 1] = y / length;
    faces[3 * t + 2] = z / length;
  }
  const first = new Uint32Array(n + 2);
  triangles.forEach((p) => ++first[p + 2]);
  for (let i = 2; i < n + 2; ++i) {
    first[i] += first[i - 1];
  }
  const around = new Uint32Array(triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    around[first[triangles[i] + 1]++] = Math.trunc(i / 3);
  }
  const normals = new Int8Array(4 * triangles.length);
  for (let i = 0; i < triangles.length; ++i) {
    const own = 3 * Math.trunc(i / 3), p = triangles[i];
    let x = 0, y = 0, z = 0;
    // Points of fans of hundreds of triangles take the first ones; all would take quadratic time.
    for (let k = first[p], end = Math.min(first[p + 1], first[p] + 64); k < end; ++k) {
      const other = 3 * around[k];
      if (faces[own] * faces[other] + faces[own + 1] * faces[other + 1]
        + faces[own + 2] * faces[other + 2] > 0.7) {
        x += faces[other];
        y += faces[other + 1];
        z += faces[other + 2];
      }
    }
    const scale = 127 / (Math.sqrt(x * x + y * y + z * z) || 1);
    normals[4 * i] = scale * x;
    normals[4 * i + 1] = scale * y;
    normals[4 * i + 2] = scale * z;
  }
  return normals;
}

class SurfaceView {
  /** onPick(place): a click on the surface, {point, triangle, shares, side}, or null beside it. */
  constructor(canvas, onPick) {
    this.canvas = canvas;
    this.gl = canvas.getContext("webgl2", { antialias: true, preserveDrawingBuffer: true });
    if (!this.gl) {
      throw new Error("This browser shows no WebGL 2, which the view needs.");
    }
    this.onPick = onPick;
    this.background = [1, 1, 1];
    this.bars = 60; // pixels above the surface, for titles and colour bars
    this.columns = 0; // sides in a row; 0: as many as there is room for
    this.home = null; // [from, up] of the first view; null: by the shape of the surface
    this.sides = []; // {points, normals, values, ...}: what is seen from left to right
    this.marks = [];
    this.turn = null;
    this.makePrograms();
    canvas.addEventListener("webglcontextlost", (event) => event.preventDefault());
    canvas.addEventListener("webglcontextrestored", () => this.restore());
    new ResizeObserver(() => this.redraw()).observe(canvas);
    this.listen();
  }

  makePrograms() {
    const gl = this.gl;
    const compile = (vertex, fragment) => {
      const program = gl.createProgram();
      [[gl.VERTEX_SHADER, vertex], [gl.FRAGMENT_SHADER, fragment]].forEach(([type, text]) => {
        const shader = gl.createShader(type);
        gl.shaderSource(shader, text);
        gl.compileShader(shader);
        gl.attachShader(program, shader);
      });
      gl.bindAttribLocation(program, 0, "point");
      gl.linkProgram(program);
      if (!gl.getProgramParameter(program, gl.LINK_STATUS) && !gl.isContextLost()) {
        throw new Error("The view cannot be drawn: " + gl.getProgramInfoLog(program));
      }
      const places = {};
      for (let i = gl.getProgramParameter(program, gl.ACTIVE_UNIFORMS) - 1; i >= 0; --i) {
        const { name } = gl.getActiveUniform(program, i);
        places[name] = gl.getUniformLocation(program, name);
      }
      return { program, places };
    };
    this.surfaceProgram = compile(VERTEX_SHADER, FRAGMENT_SHADER);
    this.markProgram = compile(MARK_VERTEX_SHADER, MARK_FRAGMENT_SHADER);
    this.markBuffer = gl.createBuffer();
  }

  texture(kind, data, per, old = null) {
    const gl = this.gl;
    const [internal, format, type] = { points: [gl.RGB32F, gl.RGB, gl.FLOAT],
      colours: [gl.RGB32F, gl.RGB, gl.FLOAT], values: [gl.R32F, gl.RED, gl.FLOAT],
      corners: [gl.R32UI, gl.RED_INTEGER, gl.UNSIGNED_INT], normals: [gl.RGBA8_SNORM, gl.RGBA, gl.BYTE],
      map: [gl.RGBA8, gl.RGBA, gl.UNSIGNED_BYTE] }[kind];
    const count = data.length / per, width = kind === "map" ? count : TEXTURE_WIDTH;
    const height = Math.max(1, Math.ceil(count / width));
    if (height > gl.getParameter(gl.MAX_TEXTURE_SIZE)) {
      throw new Error(`The surface is too large for the view: ${count} entries.`);
    }
    let padded = data;
    if (count !== width * height) {
      padded = new data.constructor(per * width * height);
      padded.set(data);
    }
    const texture = old || gl.createTexture();
    gl.bindTexture(gl.TEXTURE_2D, texture);
    gl.pixelStorei(gl.UNPACK_ALIGNMENT, 1);
    gl.texImage2D(gl.TEXTURE_2D, 0, internal, width, height, 0, format, type, padded);
    const filter = kind === "map" ? gl.LINEAR : gl.NEAREST;
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MIN_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_MAG_FILTER, filter);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_S, gl.CLAMP_TO_EDGE);
    gl.texParameteri(gl.TEXTURE_2D, gl.TEXTURE_WRAP_T, gl.CLAMP_TO_EDGE);
    return texture;
  }

  /** Frees what a side has on the graphics card. */
  free(side) {
    ["pointTexture", "normalTexture", "cornerTexture", "valueTexture", "mapTexture"].forEach((name) => {
      this.gl.deleteTexture(side[name] || null);
      delete side[name];
    });
  }

  /**
   * Shows these sides: {points (3n), triangles (3m), values (see colours.js; null: none)}. frame: true, or
   * the points that the camera shows; otherwise it stays.
   */
  show(sides, frame = false) {
    const old = this.sides;
    this.sides = sides.map((side) => ({ ...side }));
    const first = this.sides[0];
    if (frame || !this.turn) {
      this.setFrame(frame && frame !== true ? frame : first.points);
    } else if (old.length !== this.sides.length && this.distance === this.fitted) {
      this.fit();
    }
    this.sides.forEach((side, i) => {
      const kept = old[i];
      if (!frame && kept && kept.points === side.points && kept.triangles === side.triangles) {
        ["pointTexture", "normalTexture", "cornerTexture", "valueTexture"].forEach((name) => {
          side[name] = kept[name];
          delete kept[name];
        });
      }
      this.upload(side);
    });
    old.forEach((side) => this.free(side));
    this.redraw();
  }

  upload(side) {
    if (!side.pointTexture) {
      const scaled = new Float32Array(side.points.length);
      for (let i = 0; i < scaled.length; ++i) { // in double precision, since scans may be far from the origin
        scaled[i] = (side.points[i] - this.middle[i % 3]) / this.size;
      }
      side.pointTexture = this.texture("points", scaled, 3);
      side.normalTexture = this.texture("normals", cornerNormals(scaled, side.triangles), 4);
      side.cornerTexture = this.texture("corners", side.triangles, 1);
    }
    const values = side.values;
    if (values) {
      side.valueTexture = this.texture(values.colours ? "colours" : "values", values.numbers,
        values.colours ? 3 : 1, side.valueTexture);
      side.mapTexture = this.texture("map", values.map, 4);
    }
  }

  restore() {
    this.sides.forEach((side) => ["pointTexture", "valueTexture"].forEach((name) => delete side[name]));
    this.makePrograms();
    this.sides.forEach((side) => this.upload(side));
    this.redraw();
  }

  /** Frames the points: three quarters from above, or onto the plane of what is flat. */
  setFrame(points) {
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    for (let i = 0; i < points.length; ++i) {
      const axis = i % 3;
      if (points[i] < low[axis]) { low[axis] = points[i]; }
      if (points[i] > high[axis]) { high[axis] = points[i]; }
    }
    const size = low.map((x, axis) => high[axis] - x);
    this.middle = low.map((x, axis) => x + 0.5 * size[axis]);
    this.size = Math.max(...size) || 1;
    this.framed = points;
    this.resetCamera();
  }

  resetCamera() {
    if (!this.framed) { return; }
    if (this.home) {
      this.lookFrom(...this.home);
      return;
    }
    const extent = [0, 1, 2].map((axis) => {
      let largest = 0;
      for (let i = axis; i < this.framed.length; i += 3) {
        largest = Math.max(largest, Math.abs(this.framed[i] - this.middle[axis]) / this.size);
      }
      return largest;
    });
    const flat = extent.indexOf(Math.min(...extent));
    const from = extent[flat] > 0.04 ? [0.55, -1, 0.55] : [0, 1, 2].map((axis) =>
      axis === flat ? (axis === 1 ? -1 : 1) : axis === 1 ? -0.35 : 0.25);
    this.lookFrom(from);
  }

  /** from: the direction to the camera. up: by default z, or y where that is the view's direction. */
  lookFrom(from, up = Math.abs(unit(from)[2]) > 0.93 ? [0, 1, 0] : [0, 0, 1]) {
    const back = unit(from);
    const right = unit(cross(up, back));
    this.turn = [right, cross(back, right), back]; // rows
    this.fit();
    this.redraw();
  }

  /** Moves the camera so that the framed points fill the view, with a margin. */
  fit() {
    const { width, height } = this.viewport(0), bars = this.bars * (window.devicePixelRatio || 1);
    const aspect = width / Math.max(height, 1), points = this.framed, extent = [[9, -9], [9, -9]];
    const free = Math.max(0.5, 1 - bars / Math.max(height, 1)); // below the colour bars
    const step = 3 * Math.max(1, Math.trunc(points.length / 300000));
    const each = (use) => {
      for (let i = 0; i < points.length; i += step) {
        const p = [0, 1, 2].map((axis) => (points[i + axis] - this.middle[axis]) / this.size);
        use(this.turn.map((row) => dot(row, p)));
      }
    };
    each((q) => [0, 1].forEach((axis) => {
      extent[axis][0] = Math.min(extent[axis][0], q[axis]);
      extent[axis][1] = Math.max(extent[axis][1], q[axis]);
    }));
    this.aim = extent.map(([low, high]) => 0.5 * (low + high));
    const tangent = 0.5 * FIELD_OF_VIEW;
    this.distance = 0.05;
    each((q) => {
      this.distance = Math.max(this.distance, q[2] + 1.12 * Math.max(
        Math.abs(q[1] - this.aim[1]) / (tangent * free), Math.abs(q[0] - this.aim[0]) / (tangent * aspect)));
    });
    this.aim[1] += (1 - free) * tangent * this.distance;
    this.fitted = this.distance;
  }

  viewport(i) {
    const count = Math.max(1, this.sides.length), { width, height } = this.canvas;
    // Side by side, or one above the other where the page is narrow.
    const columns = this.columns || (width >= 0.9 * height ? count : 1), rows = Math.ceil(count / columns);
    const w = Math.floor(width / columns), h = Math.floor(height / rows);
    return { x: (i % columns) * w, y: (rows - 1 - Math.floor(i / columns)) * h, width: w, height: h };
  }

  matrix(viewport) {
    const aspect = viewport.width / Math.max(viewport.height, 1), t = 2 / FIELD_OF_VIEW;
    const near = Math.max(0.002, this.distance - 1.8), far = this.distance + 1.8;
    const rows = this.turn, d = this.distance;
    const look = [rows[0][0], rows[1][0], rows[2][0], 0, rows[0][1], rows[1][1], rows[2][1], 0,
      rows[0][2], rows[1][2], rows[2][2], 0, -this.aim[0], -this.aim[1], -d, 1];
    const lens = [t / aspect, 0, 0, 0, 0, t, 0, 0, 0, 0, (near + far) / (near - far), -1,
      0, 0, 2 * near * far / (near - far), 0];
    return multiply(lens, look);
  }

  redraw() {
    if (this.pending) { return; }
    this.pending = true;
    requestAnimationFrame(() => { this.pending = false; this.draw(); });
  }

  /** Gives the canvas as many pixels as its place on the page has. */
  resize() {
    const ratio = window.devicePixelRatio || 1;
    const width = Math.round(this.canvas.clientWidth * ratio), height = Math.round(this.canvas.clientHeight * ratio);
    if (this.canvas.width !== width || this.canvas.height !== height) {
      this.canvas.width = width;
      this.canvas.height = height;
      if (this.turn && this.distance === this.fitted) { this.fit(); }
    }
  }

  draw() {
    const gl = this.gl, ratio = window.devicePixelRatio || 1;
    this.resize();
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...this.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.turn || !this.canvas.width || !this.canvas.height) { return; }
    gl.enable(gl.DEPTH_TEST);
    this.sides.forEach((side, i) => {
      const port = this.viewport(i);
      gl.viewport(port.x, port.y, port.width, port.height);
      const projection = this.matrix(port);
      this.drawSurface(side, projection);
      this.drawMarks(side, projection, ratio);
    });
  }

  drawSurface(side, projection) {
    const gl = this.gl, { program, places } = this.surfaceProgram, values = side.values;
    gl.useProgram(program);
    gl.disableVertexAttribArray(0);
    [["points", side.pointTexture], ["normals", side.normalTexture], ["corners", side.cornerTexture],
      ["values", side.valueTexture || side.pointTexture], ["map", side.mapTexture || null],
    ].forEach(([name, texture], slot) => {
      gl.activeTexture(gl.TEXTURE0 + slot);
      gl.bindTexture(gl.TEXTURE_2D, texture);
      gl.uniform1i(places[name], slot);
    });
    gl.activeTexture(gl.TEXTURE0);
    gl.uniformMatrix4fv(places.projection, false, projection);
    gl.uniformMatrix3fv(places.turn, false, [0, 1, 2].flatMap((c) => this.turn.map((row) => row[c])));
    gl.uniform1i(places.kind, !values ? 0 : values.association === "cell" ? 2 : 1);
    gl.uniform1i(places.coloured, Number(Boolean(values && values.colours)));
    gl.uniform1i(places.labels, Number(Boolean(values && values.labels)));
    gl.uniform2fv(places.range, values ? values.range : [0, 1]);
    gl.uniform1f(places.interval, values ? values.interval || 0 : 0);
    gl.uniform3fv(places.plain, [0.78, 0.78, 0.77]);
    gl.drawArrays(gl.TRIANGLES, 0, side.triangles.length);
  }

  drawMarks(side, projection, ratio) {
    const gl = this.gl, { program, places } = this.markProgram;
    if (!this.marks.length) { return; }
    gl.useProgram(program);
    gl.uniformMatrix4fv(places.projection, false, projection);
    gl.uniform1f(places.size, 13 * ratio);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.markBuffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    this.marks.forEach(({ point, colour }) => {
      const p = [0, 1, 2].map((axis) => (side.points[3 * point + axis] - this.middle[axis]) / this.size);
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(p), gl.STREAM_DRAW);
      gl.uniform3fv(places.fill, colour);
      gl.drawArrays(gl.POINTS, 0, 1);
    });
  }

  /** Marks at points of the surface: [{point, colour}]. */
  setMarks(marks) {
    this.marks = marks;
    this.redraw();
  }

  // ---- mouse, fingers and keys ------------------------------------------------------------------

  listen() {
    const canvas = this.canvas, fingers = new Map();
    let moved = 0, spread = 0;
    canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      moved = fingers.size > 1 ? 99 : 0;
      spread = 0;
    });
    canvas.addEventListener("pointermove", (event) => {
      const before = fingers.get(event.pointerId);
      if (!before) { return; }
      const [dx, dy] = [event.clientX - before.clientX, event.clientY - before.clientY];
      fingers.set(event.pointerId, event);
      moved += Math.abs(dx) + Math.abs(dy);
      if (fingers.size === 2) {
        const [a, b] = [...fingers.values()];
        const now = Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY);
        if (spread) { this.zoom(spread / now); }
        spread = now;
        this.pan(0.5 * dx, 0.5 * dy);
      } else if (event.shiftKey || event.buttons & 6) {
        this.pan(dx, dy);
      } else if (moved > 4) {
        this.rotate(0.008 * dx, 0.008 * dy);
      }
    });
    const end = (event) => {
      const click = fingers.delete(event.pointerId) && event.type === "pointerup" && moved <= 4
        && event.button === 0;
      if (click && this.sides.length) { this.onPick(this.pick(event.offsetX, event.offsetY)); }
    };
    canvas.addEventListener("pointerup", end);
    canvas.addEventListener("pointercancel", end);
    canvas.addEventListener("contextmenu", (event) => event.preventDefault());
    canvas.addEventListener("wheel", (event) => {
      event.preventDefault();
      this.zoom(Math.exp(0.001 * Math.max(-300, Math.min(300, event.deltaY * (event.deltaMode ? 30 : 1)))));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const keys = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] };
      if (keys[event.key]) {
        if (event.shiftKey) { this.pan(-200 * keys[event.key][0], -200 * keys[event.key][1]); }
        else { this.rotate(...keys[event.key]); }
      } else if (event.key === "+" || event.key === "-") {
        this.zoom(event.key === "+" ? 0.9 : 1.1);
      } else if (event.key === "Home" || event.key === "0") {
        this.resetCamera();
      } else if (event.key === "Enter" && this.sides.length) {
        const { width, height } = this.viewport(0); // the middle of the first side
        const ratio = window.devicePixelRatio || 1;
        this.onPick(this.pick(0.5 * width / ratio, 0.5 * height / ratio));
      } else {
        return;
      }
      event.preventDefault();
    });
  }

  rotate(x, y) {
    if (!this.turn) { return; }
    const [c, s, e, f] = [Math.cos(x), Math.sin(x), Math.cos(y), Math.sin(y)];
    const [a, b, d] = this.turn, mix = (p, u, q, v) => p.map((value, i) => value * u + q[i] * v);
    const right = mix(a, c, d, s), back = mix(d, c, a, -s);
    const up = unit(mix(b, e, back, -f));
    this.turn = [unit(right), up, cross(unit(right), up)];
    this.redraw();
  }

  pan(dx, dy) {
    if (!this.turn) { return; }
    const scale = FIELD_OF_VIEW * this.distance * (window.devicePixelRatio || 1) / this.viewport(0).height;
    this.aim = [this.aim[0] - scale * dx, this.aim[1] + scale * dy];
    this.fitted = NaN;
    this.redraw();
  }

  zoom(factor) {
    if (!this.turn) { return; }
    this.distance = Math.min(40, Math.max(0.01, this.distance * factor));
    this.redraw();
  }

  /** The place of the surface below a place of the canvas in CSS pixels, or null. */
  pick(x, y) {
    const ratio = window.devicePixelRatio || 1;
    let side = 0, port = null;
    for (; side < this.sides.length; ++side) {
      port = this.viewport(side);
      const [px, py] = [x * ratio - port.x, (this.canvas.height - y * ratio) - port.y];
      if (px >= 0 && py >= 0 && px < port.width && py < port.height) { break; }
    }
    if (side === this.sides.length) { return null; }
    const t = 0.5 * FIELD_OF_VIEW, aspect = port.width / port.height;
    const inView = [t * aspect * (2 * (x * ratio - port.x) / port.width - 1),
      t * (2 * (this.canvas.height - y * ratio - port.y) / port.height - 1), -1];
    const toWorld = (v) => [0, 1, 2].map((axis) => this.turn.reduce((sum, row, i) => sum + row[axis] * v[i], 0));
    const eye = toWorld([...this.aim, this.distance]).map((value, axis) => value * this.size + this.middle[axis]);
    const ray = toWorld(inView), { points, triangles } = this.sides[side];
    let nearest = Infinity, found = null;
    for (let i = 0; i < triangles.length; i += 3) { // Möller and Trumbore
      const a = 3 * triangles[i], b = 3 * triangles[i + 1], c = 3 * triangles[i + 2];
      const e1x = points[b] - points[a], e1y = points[b + 1] - points[a + 1], e1z = points[b + 2] - points[a + 2];
      const e2x = points[c] - points[a], e2y = points[c + 1] - points[a + 1], e2z = points[c + 2] - points[a + 2];
      const px = ray[1] * e2z - ray[2] * e2y, py = ray[2] * e2x - ray[0] * e2z, pz = ray[0] * e2y - ray[1] * e2x;
      const det = e1x * px + e1y * py + e1z * pz;
      if (det === 0) { continue; }
      const sx = eye[0] - points[a], sy = eye[1] - points[a + 1], sz = eye[2] - points[a + 2];
      const u = (sx * px + sy * py + sz * pz) / det;
      if (!(u >= 0 && u <= 1)) { continue; }
      const qx = sy * e1z - sz * e1y, qy = sz * e1x - sx * e1z, qz = sx * e1y - sy * e1x;
      const v = (ray[0] * qx + ray[1] * qy + ray[2] * qz) / det;
      const far = (e2x * qx + e2y * qy + e2z * qz) / det;
      if (v >= 0 && u + v <= 1 && far > 0 && far < nearest) {
        nearest = far;
        found = { triangle: i / 3, shares: [1 - u - v, u, v] };
      }
    }
    if (!found) { return null; }
    const corner = found.shares.indexOf(Math.max(...found.shares));
    return { ...found, side, point: triangles[3 * found.triangle + corner] };
  }
}
