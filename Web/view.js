// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// A view of one surface, or of two side by side that turn together, in WebGL 2. Points, corners and values
// are textures that the vertex shader reads, so that a new array costs one upload of its values, and
// isolines are exact within triangles.


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
    this.columns = 0; // sides in a row; 0: as many as there is room for
    this.sides = []; // {points, normals, values, ...}: what is seen from left to right
    this.marks = [];
    this.paths = []; // dots that are so dense that they are lines, in the camera's box
    this.camera = new Camera();
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
    if (frame || !this.camera.turn) {
      this.camera.frame(frame && frame !== true ? frame : first.points, this.viewport(0));
    } else if (old.length !== this.sides.length && this.camera.isFitted) {
      this.camera.fit(this.viewport(0));
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
      const scaled = new Float32Array(side.points.length), { middle, size } = this.camera;
      for (let i = 0; i < scaled.length; ++i) { // in double precision, since scans may be far from the origin
        scaled[i] = (side.points[i] - middle[i % 3]) / size;
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

  resetCamera() {
    if (!this.camera.turn) { return; }
    this.camera.reset(this.viewport(0));
    this.redraw();
  }

  lookFrom(from, up) {
    this.camera.lookFrom(this.viewport(0), from, up);
    this.redraw();
  }

  viewport(i) {
    const count = Math.max(1, this.sides.length), { width, height } = this.canvas;
    // Side by side, or one above the other where the page is narrow.
    const columns = this.columns || (width >= 0.9 * height ? count : 1), rows = Math.ceil(count / columns);
    const w = Math.floor(width / columns), h = Math.floor(height / rows);
    return { x: (i % columns) * w, y: (rows - 1 - Math.floor(i / columns)) * h, width: w, height: h };
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
      if (this.camera.turn && this.camera.isFitted) { this.camera.fit(this.viewport(0)); }
    }
  }

  draw() {
    const gl = this.gl, ratio = window.devicePixelRatio || 1;
    this.resize();
    gl.disable(gl.SCISSOR_TEST);
    gl.clearColor(...this.background, 1);
    gl.clear(gl.COLOR_BUFFER_BIT | gl.DEPTH_BUFFER_BIT);
    if (!this.camera.turn || !this.canvas.width || !this.canvas.height) { return; }
    gl.enable(gl.DEPTH_TEST);
    this.sides.forEach((side, i) => {
      const port = this.viewport(i);
      gl.viewport(port.x, port.y, port.width, port.height);
      const projection = this.camera.matrix(port);
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
    gl.uniformMatrix3fv(places.turn, false, [0, 1, 2].flatMap((c) => this.camera.turn.map((row) => row[c])));
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
    if (!this.marks.length && !this.paths.length) { return; }
    gl.useProgram(program);
    gl.uniformMatrix4fv(places.projection, false, projection);
    gl.bindBuffer(gl.ARRAY_BUFFER, this.markBuffer);
    gl.enableVertexAttribArray(0);
    gl.vertexAttribPointer(0, 3, gl.FLOAT, false, 0, 0);
    const drawDots = (dots, colour, size, share) => {
      gl.bufferData(gl.ARRAY_BUFFER, new Float32Array(dots), gl.STREAM_DRAW);
      gl.uniform3fv(places.fill, colour);
      gl.uniform1f(places.size, size * ratio);
      gl.uniform1f(places.share, share);
      gl.drawArrays(gl.POINTS, 0, dots.length / 3);
    };
    this.paths.forEach((dots) => { drawDots(dots, PATH_COLOUR, 5, 1); });
    this.marks.forEach(({ point, colour }) => drawDots(this.camera.scaled(side.points, 3 * point), colour, 13, 0.6));
  }

  /** Paths on the surface: [[x, y, z, ...]]. */
  setPaths(paths) {
    const step = 5e-4; // of the largest extent
    this.paths = paths.map((points) => {
      const dots = this.camera.scaled(points, 0);
      for (let i = 3; i < points.length; i += 3) {
        const to = this.camera.scaled(points, i), from = dots.slice(-3);
        const count = Math.ceil(Math.hypot(...to.map((x, axis) => x - from[axis])) / step);
        for (let k = 1; k <= count; ++k) { dots.push(...to.map((x, axis) => from[axis] + k / count * (x - from[axis]))); }
      }
      return dots;
    });
    this.redraw();
  }

  /** Marks at points of the surface: [{point, colour}]. */
  setMarks(marks) {
    this.marks = marks;
    this.redraw();
  }

  // ---- mouse, fingers and keys ------------------------------------------------------------------

  /** Changes the camera, if there is something to see. */
  move(name, ...args) {
    if (!this.camera.turn) { return; }
    this.camera[name](...args);
    this.redraw();
  }

  pan(dx, dy) {
    const ratio = window.devicePixelRatio || 1;
    this.move("pan", ratio * dx, ratio * dy, this.viewport(0));
  }

  /** A detail in the middle is turned about itself, not about the middle of the whole surface. */
  choosePivot() {
    const place = this.sides.length && !this.camera.isFitted && this.pickMiddle();
    this.camera.pivot = place ? this.camera.scaled(this.sides[0].points, 3 * place.point) : [0, 0, 0];
  }

  /** What is in the middle of the first side. */
  pickMiddle() {
    const { width, height } = this.viewport(0), ratio = window.devicePixelRatio || 1;
    return this.pick(0.5 * width / ratio, 0.5 * height / ratio);
  }

  listen() {
    const canvas = this.canvas, fingers = new Map();
    let moved = 0, spread = 0;
    canvas.addEventListener("pointerdown", (event) => {
      fingers.set(event.pointerId, event);
      canvas.setPointerCapture(event.pointerId);
      moved = fingers.size > 1 ? 99 : 0;
      spread = 0;
      this.choosePivot();
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
        if (spread) { this.move("zoom", spread / now); }
        spread = now;
        this.pan(0.5 * dx, 0.5 * dy);
      } else if (event.shiftKey || event.buttons & 6) {
        this.pan(dx, dy);
      } else if (moved > 4) {
        this.move("rotate", 0.008 * dx, 0.008 * dy);
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
      this.move("zoom", Math.exp(0.001 * Math.max(-300, Math.min(300, event.deltaY * (event.deltaMode ? 30 : 1)))));
    }, { passive: false });
    canvas.addEventListener("keydown", (event) => {
      const keys = { ArrowLeft: [-0.12, 0], ArrowRight: [0.12, 0], ArrowUp: [0, -0.12], ArrowDown: [0, 0.12] };
      if (keys[event.key]) {
        if (event.shiftKey) { this.pan(-200 * keys[event.key][0], -200 * keys[event.key][1]); }
        else { this.move("rotate", ...keys[event.key]); }
      } else if (event.key === "+" || event.key === "-") {
        this.move("zoom", event.key === "+" ? 0.9 : 1.1);
      } else if (event.key === "Home" || event.key === "0") {
        this.resetCamera();
      } else if (event.key === "Enter" && this.sides.length) {
        this.onPick(this.pickMiddle());
      } else {
        return;
      }
      event.preventDefault();
    });
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
    const { eye, ray } = this.camera.rayThrough(2 * (x * ratio - port.x) / port.width - 1,
      2 * (this.canvas.height - y * ratio - port.y) / port.height - 1, port);
    const { points, triangles } = this.sides[side];
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
