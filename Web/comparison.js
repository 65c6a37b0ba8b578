// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// The view with what belongs to it: one surface, or before and after, their colours and bars, isolines, the
// value below a click, and pictures.

class Comparison {
  /** onPick(place): a click, see SurfaceView. */
  constructor(onPick) {
    this.sides = []; // from left to right: {array, title, on}, on: the surface {points, triangles, cells}
    this.view = new SurfaceView($("view"), (place) => {
      this.read(place);
      onPick(place);
    });
    const on = (id, event, action) => $(id).addEventListener(event, action);
    on("lines", "change", () => { this.lines = $("lines").checked; this.update(); });
    ["low", "high"].forEach((id) => on(id, "change", () => this.update()));
    on("look", "change", () => {
      if ($("look").value && this.sides.length) {
        const [from, up] = $("look").value.split(";").map((text) => text.split(",").map(Number));
        this.view.lookFrom(from, up);
      }
      $("look").value = "";
    });
    on("reset", "click", () => this.view.resetCamera());
    on("picture", "click", () => this.savePicture());
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.setTheme());
    new ResizeObserver(() => this.placePanes()).observe($("frame"));
    this.setTheme();
  }

  setTheme() {
    const colour = getComputedStyle($("stage")).backgroundColor.match(/\d+/g).map((x) => x / 255);
    this.view.background = colour.slice(0, 3);
    this.view.redraw();
    this.drawBars();
  }

  /** name: that of the file. isSameQuantity: before and after have one range of colours where they can. */
  show(sides, name, isSameQuantity, frame = false) {
    Object.assign(this, { sides, name, isSameQuantity });
    this.update(frame);
  }

  update(frame = false) {
    if (!this.sides.length) { return; }
    this.setRanges();
    this.view.show(this.sides.map(({ array, on }) => ({ points: on.points, triangles: on.triangles,
      values: array && array.shown })), frame);
    this.placePanes();
  }

  /** Says what is at a place of the surface. */
  read(place) {
    if (!place) {
      $("readout").textContent = "There is no surface at this place.";
      return;
    }
    const { points, triangles } = this.sides[place.side].on;
    const at = [0, 1, 2].map((axis) => shortNumber(points[3 * place.point + axis]));
    const words = [`Point ${place.point} at (${at.join(", ")})`];
    this.sides.forEach(({ array, title, on }) => { // a refined surface has other triangles
      if (array && on.triangles === triangles) { words.push(`${title}: ${this.valueAt(array, place, on)}`); }
    });
    $("readout").textContent = words.join(" · ");
  }

  valueAt(array, { triangle, point, shares }, { triangles, cells }) {
    const { components, values } = array;
    const numbers = [];
    for (let c = 0; c < components; ++c) {
      if (array.association === "cell") {
        numbers.push(values[components * cells[triangle] + c]);
      } else if (isLabels(values, array.name)) {
        numbers.push(values[components * point + c]);
      } else {
        numbers.push(shares.reduce((sum, share, k) =>
          sum + share * values[components * triangles[3 * triangle + k] + c], 0));
      }
    }
    const unit = unitOf(array.name);
    return numbers.map(shortNumber).join(", ") + (unit && ` ${unit}`);
  }

  /** The same colours before and after if the result is the same quantity; given limits win. */
  setRanges() {
    const [before, after] = this.sides.map(({ array }) => array && array.shown);
    const automatic = (shown) => {
      const { first, last } = shown.extent;
      return shown.signed ? symmetric(first, last) : [first, last];
    };
    const plain = (shown) => shown && !shown.colours;
    [before, after].filter(plain).forEach((shown) => setRange(shown, automatic(shown)));
    const width = plain(before) ? before.extent.last - before.extent.first : 0;
    const shares = plain(before) && plain(after) && !after.labels && !before.labels && width > 0
      && this.isSameQuantity && after.extent.first >= before.extent.first - 0.3 * width
      && after.extent.last <= before.extent.last + 0.3 * width
      && after.extent.last - after.extent.first > 0.02 * width;
    if (shares) {
      after.signed = before.signed;
      setRange(after, before.limits);
    }
    const target = plain(after) ? after : before, numbers = ["low", "high"].map((id, i) => {
      const text = $(id).value.trim().replace("−", "-"), given = Number(text.replace(",", "."));
      if (plain(target)) { $(id).placeholder = shortNumber(target.limits[i]); }
      return text && Number.isFinite(given) ? given : null;
    });
    if (numbers.some((x) => x !== null)) {
      [before, after].filter((shown) => plain(shown) && (shown === target || shares)).forEach((shown) =>
        setRange(shown, shown.limits.map((x, i) => (numbers[i] === null ? x : numbers[i]))));
    }
    const isDistance = this.sides.length > 1 && /distance|arrival/i.test(this.sides[1].title);
    const lines = this.lines === undefined ? isDistance : this.lines;
    $("lines").checked = lines;
    [before, after].filter(plain).forEach((shown) => {
      shown.interval = lines && !shown.labels ? roundInterval(shown.limits[1] - shown.limits[0]) : 0;
    });
  }

  placePanes() {
    if (!this.sides.length) { return; }
    const ratio = window.devicePixelRatio || 1, height = $("frame").clientHeight;
    this.view.resize();
    this.view.redraw();
    [0, 1].forEach((i) => {
      const pane = $(`pane-${i}`);
      pane.hidden = i >= this.view.sides.length;
      const port = this.view.viewport(i);
      Object.assign(pane.style, { left: `${port.x / ratio}px`, width: `${port.width / ratio}px`,
        top: `${height - (port.y + port.height) / ratio}px` });
    });
    this.drawBars();
  }

  drawBars() {
    this.sides.forEach(({ array, title }, i) => {
      const canvas = $(`pane-${i}`).firstElementChild, ratio = window.devicePixelRatio || 1;
      const unit = array ? unitOf(array.name) : "", name = title + (unit && ` (${unit})`);
      Object.assign(canvas, { width: 230 * ratio, height: 50 * ratio });
      const context = canvas.getContext("2d");
      context.scale(ratio, ratio);
      const shown = array && array.shown;
      drawBar(context, { x: 2, y: 0, width: 226, title: name, shown, colour: getComputedStyle($("stage")).color });
      canvas.setAttribute("aria-label", shown && !shown.colours
        ? `${i ? "After" : "Before"}: ${name} from ${shown.limits.map(shortNumber).join(" to ")}` : name || "Surface");
    });
  }

  /** The view with its bars as PNG. */
  savePicture() {
    if (!this.sides.length) { return; }
    this.view.draw();
    const canvas = makeElement("canvas", { width: $("view").width, height: $("view").height });
    const context = canvas.getContext("2d");
    context.drawImage($("view"), 0, 0);
    this.view.sides.forEach((_, i) => {
      const port = this.view.viewport(i), bar = $(`pane-${i}`).firstElementChild, ratio = window.devicePixelRatio || 1;
      context.drawImage(bar, port.x + 14 * ratio, canvas.height - port.y - port.height + 11 * ratio);
    });
    canvas.toBlob((blob) => save(`${this.name.replace(/\.[^.]*$/, "")}.png`, blob), "image/png");
  }
}

/** The unit of an array; empty if it is not known. */
function unitOf(name) {
  const unit = $("units").value;
  if (!unit) { return ""; }
  if (/gauss.*curvature/i.test(name)) { return `1/${unit}²`; }
  if (/curvature/i.test(name)) { return `1/${unit}`; }
  return /distance|displacement|thick|sulc|height/i.test(name) ? unit : "";
}

function save(name, blob) {
  const link = makeElement("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
