// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// Arrays as colours: ranges without outliers, maps, bars.

const VIRIDIS = [[68, 1, 84], [71, 45, 123], [59, 82, 139], [44, 114, 142], [33, 144, 141], [39, 173, 129],
  [92, 200, 99], [170, 220, 50], [253, 231, 37]];
const COOL_WARM = [[43, 85, 168], [98, 143, 210], [164, 194, 232], [221, 224, 228], [240, 188, 162],
  [218, 120, 96], [165, 30, 44]];
const LABELS = [[76, 120, 168], [245, 133, 24], [84, 162, 75], [228, 87, 86], [114, 183, 178], [238, 202, 59],
  [178, 121, 162], [255, 157, 166], [157, 117, 93], [150, 150, 150], [36, 80, 100], [140, 190, 240]];

/** 256 colours, RGBA, through the given ones. */
function mapThrough(colours) {
  const map = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) {
    const place = i / 255 * (colours.length - 1), k = Math.min(Math.trunc(place), colours.length - 2);
    for (let c = 0; c < 3; ++c) {
      map[4 * i + c] = Math.round(colours[k][c] + (place - k) * (colours[k + 1][c] - colours[k][c]));
    }
    map[4 * i + 3] = 255;
  }
  return map;
}

/** 256 colours in as many steps as there are labels. */
function mapOfLabels(count) {
  const map = new Uint8Array(1024);
  for (let i = 0; i < 256; ++i) {
    const place = Math.min(count - 1, Math.round(i / 255 * Math.max(count - 1, 1)));
    map.set([...LABELS[place % LABELS.length], 255], 4 * i);
  }
  return map;
}

/** Smallest and largest finite value, and those that all but one in a hundred at each end keep to. */
function rangeOf(numbers) {
  let low = Infinity, high = -Infinity;
  for (let i = 0; i < numbers.length; ++i) {
    const value = numbers[i];
    if (value - value === 0) { // finite
      if (value < low) { low = value; }
      if (value > high) { high = value; }
    }
  }
  if (low > high) { return null; }
  const step = Math.max(1, Math.trunc(numbers.length / 50000)), sample = [];
  for (let i = 0; i < numbers.length; i += step) {
    if (numbers[i] - numbers[i] === 0) { sample.push(numbers[i]); }
  }
  const sorted = Float64Array.from(sample).sort();
  let [first, last] = [low, high];
  if (sorted.length > 100) {
    first = sorted[Math.floor(0.01 * (sorted.length - 1))];
    last = sorted[Math.ceil(0.99 * (sorted.length - 1))];
    const width = last - first; // only outliers are cut off
    if (width > 0 && first - low < 0.5 * width) { first = low; }
    if (width > 0 && high - last < 0.5 * width) { last = high; }
    if (!(width > 0)) { [first, last] = [low, high]; }
  }
  if (first === last) { // a constant has the colour of the middle
    const part = 0.1 * Math.abs(first) || 1;
    [first, last] = [first - part, last + part];
  }
  return { low, high, first, last };
}

/** The values are numbers of regions: few integers. Colours repeat after a dozen. */
function isLabels(numbers, name) {
  if (!/region|label|nearest|parcel|annot|aparc|component/i.test(name)) { return false; }
  const seen = new Set();
  for (let i = 0; i < numbers.length; ++i) {
    if (numbers[i] !== Math.trunc(numbers[i]) && !Number.isNaN(numbers[i])) { return false; }
    if (!Number.isNaN(numbers[i]) && seen.size <= 64) { seen.add(numbers[i]); }
  }
  return seen.size <= 64;
}

/** Whether three or four components are red, green and blue from 0 to 255, or a unit vector. */
function kindOfComponents(array) {
  const { values, components } = array;
  if (components !== 3 && components !== 4) { return "length"; }
  let integers = true, units = components === 3, largest = 0, longest = 0;
  const step = components * Math.max(1, Math.trunc(values.length / components / 2000));
  for (let i = 0; i + components <= values.length; i += step) {
    let square = 0;
    for (let c = 0; c < components; ++c) {
      const x = values[i + c];
      integers = integers && x >= 0 && x <= 255 && x === Math.trunc(x);
      largest = Math.max(largest, x);
      square += x * x;
    }
    longest = Math.max(longest, square);
    units = units && (Number.isNaN(square) || square === 0 || Math.abs(square - 1) < 0.01);
  }
  if (integers && largest > 1) { return "colours"; }
  if (units && longest > 0) { return "directions"; }
  return /colou?r|rgb/i.test(array.name) && largest <= 1 ? "shares" : "length";
}

/**
 * What the view shows of an array {name, association, components, values}: numbers as 32 bits relative to
 * `base`, range, map. triangleCells: the cell of each triangle.
 */
function prepareValues(array, triangleCells) {
  const { association, components, values } = array, onCells = association === "cell";
  const rows = onCells ? triangleCells.length : values.length / components;
  const rowOf = onCells ? (i) => triangleCells[i] : (i) => i;
  const kind = components > 1 ? kindOfComponents(array) : "number";
  if (kind !== "number" && kind !== "length") {
    const [scale, shift] = { colours: [1 / 255, 0], shares: [1, 0], directions: [0.5, 0.5] }[kind];
    const numbers = new Float32Array(3 * rows);
    for (let i = 0; i < rows; ++i) {
      for (let c = 0; c < 3; ++c) {
        const x = values[components * rowOf(i) + c];
        numbers[3 * i + c] = Number.isNaN(x) ? 0.6 : shift + scale * x;
      }
    }
    return { association, colours: true, kind, numbers, base: 0, range: [0, 1], map: mapThrough(VIRIDIS) };
  }
  let plain = values;
  if (components > 1) {
    plain = new Float64Array(values.length / components);
    for (let i = 0; i < plain.length; ++i) {
      let square = 0;
      for (let c = 0; c < components; ++c) { square += values[components * i + c] ** 2; }
      plain[i] = Math.sqrt(square);
    }
  }
  const extent = rangeOf(plain) || { low: 0, high: 1, first: 0, last: 1 };
  const base = extent.low, numbers = new Float32Array(rows);
  for (let i = 0; i < rows; ++i) {
    const x = plain[rowOf(i)];
    numbers[i] = x - x === 0 ? x - base : MISSING;
  }
  const labels = components === 1 && isLabels(values, array.name);
  if (labels) { [extent.first, extent.last] = [extent.low, extent.high]; }
  // Values of both signs about zero have a map with a middle.
  const signed = !labels && extent.first < 0 && extent.last > 0
    && Math.min(-extent.first, extent.last) > 0.4 * Math.max(-extent.first, extent.last);
  const shown = { association, kind, numbers, base, labels, signed, extent };
  setRange(shown, signed ? symmetric(extent.first, extent.last) : [extent.first, extent.last]);
  return shown;
}

function symmetric(first, last) {
  const most = Math.max(Math.abs(first), Math.abs(last));
  return [-most, most];
}

/** Gives what is shown these limits of its colours, and the map that goes with them. */
function setRange(shown, [first, last]) {
  shown.limits = [first, last];
  shown.range = [first - shown.base, last - shown.base];
  shown.map = shown.labels ? mapOfLabels(last - first + 1) : mapThrough(shown.signed ? COOL_WARM : VIRIDIS);
}

/** Isolines at round values, about a dozen: their distance. */
function roundInterval(width, count = 12) {
  if (!(width > 0)) { return 0; }
  const raw = width / count, power = 10 ** Math.floor(Math.log10(raw));
  return power * [1, 2, 5, 10].find((step) => step * power >= raw * 0.999);
}

/** Four digits, as the formats of the command have. */
function shortNumber(x) {
  if (Number.isNaN(x)) { return "missing"; }
  if (!Number.isFinite(x)) { return x > 0 ? "infinite" : "−infinite"; }
  const size = Math.abs(x);
  const text = size !== 0 && (size < 1e-3 || size >= 1e6) ? x.toExponential(2) : String(Number(x.toPrecision(4)));
  return text.replace("-", "−");
}

/** Draws the title, the bar and its numbers into a context; the same on the page and in pictures. */
function drawBar(context, { x, y, width, title, shown, colour }) {
  const line = 15;
  context.fillStyle = colour;
  context.font = "600 13px system-ui, sans-serif";
  context.textAlign = "left";
  context.textBaseline = "top";
  let words = title;
  while (words.length > 4 && context.measureText(words).width > width) { words = words.slice(0, -2) + "…"; }
  context.fillText(words, x, y);
  if (!shown || shown.colours) { return; }
  const [first, last] = shown.limits, top = y + line + 4, labels = shown.labels ? last - first + 1 : 0;
  for (let i = 0; i < width; ++i) {
    const share = labels ? Math.floor(labels * i / width) / Math.max(labels - 1, 1) : i / width;
    const k = 4 * Math.min(255, Math.round(255 * share));
    context.fillStyle = `rgb(${shown.map[k]},${shown.map[k + 1]},${shown.map[k + 2]})`;
    context.fillRect(x + i, top, 1.5, 10);
  }
  context.fillStyle = colour;
  context.font = "12px system-ui, sans-serif";
  const below = top + 14, { low, high } = shown.extent;
  if (labels && labels <= 12) { // each below its colour
    context.textAlign = "center";
    for (let k = 0; k < labels; ++k) { context.fillText(shortNumber(first + k), x + (k + 0.5) * width / labels, below); }
    return;
  }
  context.fillText((low < first ? "≤ " : "") + shortNumber(first), x, below);
  context.textAlign = "right";
  context.fillText((high > last ? "≥ " : "") + shortNumber(last), x + width, below);
  if (!shown.labels) {
    context.textAlign = "center";
    context.fillText(shortNumber(0.5 * (first + last)), x + width / 2, below);
  }
}

/** The history as a picture: values over time, or over steps. */
function curveOf(history) {
  const find = (name) => history.find((column) => column.name === name);
  const column = find("Energy") || find("EdgeEnergy") || history.find(({ name }) => /energy/i.test(name));
  const time = find("Time");
  if (!column) { return null; }
  const points = [];
  column.values.forEach((value, i) => {
    const at = time ? time.values[i] : i;
    if (Number.isFinite(value) && Number.isFinite(at)) { points.push([at, value]); }
  });
  if (points.length < 2) { return null; }
  const [xs, ys] = [0, 1].map((axis) => points.map((point) => point[axis]));
  const [x0, x1, y0, y1] = [Math.min(...xs), Math.max(...xs), Math.min(...ys), Math.max(...ys)];
  const place = ([x, y]) => `${(6 + 288 * (x - x0) / (x1 - x0 || 1)).toFixed(1)},`
    + `${(84 - 74 * (y - y0) / (y1 - y0 || 1)).toFixed(1)}`;
  const make = (tag, attributes) => {
    const element = document.createElementNS("http://www.w3.org/2000/svg", tag);
    Object.entries(attributes).forEach(([name, value]) => element.setAttribute(name, value));
    return element;
  };
  const words = `${column.name} from ${shortNumber(ys[0])} to ${shortNumber(ys[ys.length - 1])}, `
    + `${time ? "time" : "step"} ${shortNumber(x0)} to ${shortNumber(x1)}`;
  const svg = make("svg", { viewBox: "0 0 300 90", role: "img", "aria-label": words });
  svg.append(make("path", { d: "M6 4V84H296", class: "axis" }),
    make("polyline", { points: points.map(place).join(" "), class: "curve" }));
  return { svg, words };
}
