// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// The page: files, model, run, comparison. Numbers come from the engine in its worker.

const $ = (id) => document.getElementById(id);

/** What a model starts with where its default would refuse, or change nothing. h: the mean edge length. */
const STARTS = {
  heat: ({ h }) => ({ fwhm: rounded(4 * h) }),
  random_field: ({ h }) => ({ fwhm: rounded(10 * h) }),
  relief: ({ size }) => ({ height: rounded(0.01 * size) }),
  harmonic_map: () => ({ move_vertices: true }),
};
const LARGEST_FILE = 1e9; // bytes; its surface would not fit into the memory of the engine

/** What clicks add, by model: the keyword, the words, and whether each point has a value. */
const PICKS = {
  distance: { keyword: "sources", one: "source", words: "Click the points that distances start from.", valued: false },
  segment: { keyword: "seeds", one: "seed", words: "Clicks mark regions, which have the numbers 1, 2, … "
    + "Without any, the data alone decide.", valued: true },
  interpolate: { keyword: "values", one: "value", words: "Clicks give measured values, in place of the data. "
    + "Of data without gaps, values at 200 points are taken.", valued: true },
};

const rounded = (x) => Number(x.toPrecision(3));
const plural = (count, word) => `${count.toLocaleString("en")} ${word}${count === 1 ? "" : "s"}`;
const lastPart = (name) => name.split("/").pop() || name; // of arrays that are named after a file
const arrayNamed = (arrays, name) => arrays.find((array) => array.name === name);

class Page {
  constructor() {
    this.client = new EngineClient((fraction) => { $("progress").value = fraction; });
    this.mesh = null;
    this.result = null;
    this.picks = []; // [{point, value}]
    this.runs = 0;
    this.controls = new Controls($("settings"), $("more-settings"), () => $("units").value);
    this.view = new SurfaceView($("view"), (place) => this.pick(place));
    this.ready = this.client.call("describe").then(({ models }) => {
      this.models = models;
      $("model").append(...models.map(({ name, title }) => makeElement("option",
        { value: name, textContent: (PANELS[name] || { title }).title })));
      $("model").value = models.some(({ name }) => name === "heat") ? "heat" : models[0].name;
      this.chooseModel();
    });
    this.ready.catch((problem) => this.say(problem.message, "error"));
    this.listen();
    this.setTheme();
  }

  get model() { return this.models.find(({ name }) => name === $("model").value); }

  listen() {
    const on = (id, event, action) => $(id).addEventListener(event, action);
    on("file", "change", () => {
      this.openFiles([...$("file").files]);
      $("file").value = ""; // the same file may be chosen again
    });
    on("example", "click", () => this.attempt(this.open("pebble (example).ply", pebble())));
    on("controls", "submit", (event) => { event.preventDefault(); this.apply(); });
    on("model", "change", () => this.chooseModel());
    on("array", "change", () => { this.showControls(); this.attempt(this.showBefore()); });
    on("units", "change", () => { this.showControls(); this.showSides(); });
    on("cancel", "click", () => this.client.cancel());
    on("download", "click", () => this.attempt(this.download()));
    on("continue", "click", () => this.attempt(this.goOn()));
    on("clear-picks", "click", () => { this.picks = []; this.showPicks(); });
    on("shown", "change", () => this.attempt(this.showResult()));
    on("lines", "change", () => { this.lines = $("lines").checked; this.showSides(); });
    ["low", "high"].forEach((id) => on(id, "change", () => this.showSides()));
    on("look", "change", () => {
      if ($("look").value && this.mesh) {
        const [from, up] = $("look").value.split(";").map((text) => text.split(",").map(Number));
        this.view.lookFrom(from, up);
      }
      $("look").value = "";
    });
    on("reset", "click", () => this.view.resetCamera());
    on("picture", "click", () => this.savePicture());
    on("time", "input", () => this.showTime());
    const over = (event) => {
      event.preventDefault();
      document.body.classList.toggle("dropping", event.type === "dragover");
    };
    ["dragover", "dragleave", "drop"].forEach((name) => window.addEventListener(name, over));
    window.addEventListener("drop", (event) => this.openFiles([...event.dataTransfer.files]));
    matchMedia("(prefers-color-scheme: dark)").addEventListener("change", () => this.setTheme());
    new ResizeObserver(() => this.placePanes()).observe($("frame"));
  }

  setTheme() {
    const colour = getComputedStyle($("stage")).backgroundColor.match(/\d+/g).map((x) => x / 255);
    this.view.background = colour.slice(0, 3);
    this.view.redraw();
    this.drawBars();
  }

  /** kind: "error" or "". further: lines below it. */
  say(text, kind = "", further = []) {
    $("message").className = kind;
    $("message").replaceChildren(text, ...further.map((line) =>
      makeElement("span", { className: "warning", textContent: line })));
  }

  attempt(promise) {
    return promise.catch((problem) => {
      this.say(problem.message, problem instanceof Cancelled ? "" : "error");
    });
  }

  /** For scripts, who get the error, too. */
  async attemptScript(action) {
    try {
      return await action();
    } catch (problem) {
      this.say(problem.message, problem instanceof Cancelled ? "" : "error");
      throw problem;
    }
  }

  // ---- files ------------------------------------------------------------------------------------

  /** Surfaces come before the values at their points, whatever the order in which they were dropped. */
  async openFiles(files) {
    const problems = [];
    let opened = false, rest = files;
    for (let round = 0; round < 2 && rest.length; ++round) {
      const left = [];
      for (const file of rest) {
        try {
          if (file.size > LARGEST_FILE) {
            throw new Error(`${file.name} has ${plural(Math.round(file.size / 1e6), "megabyte")}; allowed: `
              + `${LARGEST_FILE / 1e6}, which the memory of a page has room for`);
          }
          await this.open(file.name, await file.arrayBuffer());
          opened = true;
        } catch (problem) {
          left.push(file);
          if (round === 1 || files.length === 1 || !opened) { problems.push([file, problem.message]); }
        }
      }
      rest = files.length > 1 && opened ? left : [];
    }
    const failed = problems.filter(([file]) => rest.length === 0 || rest.includes(file)).map(([, text]) => text);
    if (problems.length && !(files.length > 1 && rest.length === 0 && opened)) {
      this.say([...new Set(failed)].join("\n"), "error");
    }
  }

  /** Opens a file, as by dropping it. Returns what it has. */
  async open(name, bytes, unit = "") {
    await this.ready;
    const start = performance.now();
    this.say(`Reading ${name} …`);
    const opened = await this.client.open(name, bytes);
    if (opened.isSame && this.mesh) {
      this.mesh.arrays = opened.arrays.map((array) => ({ ...arrayNamed(this.mesh.arrays, array.name), ...array }));
    } else {
      this.mesh = { name, points: opened.coordinates, triangles: opened.triangles,
        cells: opened.cellOfTriangle, arrays: opened.arrays.map((array) => ({ ...array })) };
      this.result = null;
      this.file = null;
      this.picks = [];
      Object.assign(this.mesh, measure(this.mesh)); // h, extent, size, own
      $("units").value = opened.unit || unit;
      $("units-row").hidden = false;
      document.body.classList.add("loaded");
      ["low", "high"].forEach((id) => { $(id).value = ""; });
    }
    const fresh = opened.isSame ? opened.arrays[opened.arrays.length - 1] : null;
    this.offerArrays(fresh ? fresh.name : null);
    await this.showBefore(!opened.isSame);
    const { points, triangles, extent } = this.mesh, lengths = $("units").value;
    this.say(`${name}: ${plural(points.length / 3, "point")}, ${plural(triangles.length / 3, "triangle")}, `
      + `${extent.map(shortNumber).join(" × ")}${lengths && ` ${lengths}`}.`, "", opened.warnings);
    this.enable();
    this.openTime = performance.now() - start;
    return { points: opened.points, triangles: opened.triangles.length / 3, polygons: opened.polygons,
      arrays: opened.arrays, unit: opened.unit, warnings: opened.warnings };
  }

  offerArrays(chosen) {
    this.chosen = chosen || $("array").value || this.chosen; // also while a model takes none
    const { arrays } = this.mesh, { data } = this.model;
    const options = arrays.map(({ name, association, components }) => makeElement("option", { value: name,
      textContent: lastPart(name) + (components > 1 ? `, ${components} components` : "")
        + (association === "cell" ? ", on cells" : "") }));
    const none = { vectors: "normals of the surface", sources: "clicked points", initial: "random noise" }[data];
    if (none) { options.unshift(makeElement("option", { value: "", textContent: none })); }
    if (!arrays.length && !none) { options.push(makeElement("option", { value: this.mesh.own.name, textContent: this.mesh.own.name })); }
    $("array").replaceChildren(...options);
    if (!none && options.some(({ value }) => value === this.chosen)) { $("array").value = this.chosen; }
    $("array-row").firstElementChild.textContent = data ? "Data" : "Shown";
    this.showControls();
  }

  // ---- model and settings -----------------------------------------------------------------------

  chooseModel() {
    const { name } = this.model;
    $("model-help").textContent = (PANELS[name] || { help: "" }).help;
    this.picks = [];
    if (this.mesh) {
      this.offerArrays(null);
      this.attempt(this.showBefore());
    } else {
      this.showControls();
    }
    this.showPicks();
  }

  showControls() {
    const { model } = this, start = this.mesh && STARTS[model.name] ? STARTS[model.name](this.mesh) : {};
    const array = this.mesh && arrayNamed(this.mesh.arrays, $("array").value);
    this.controls.association = array ? array.association : "point";
    this.controls.show(model, this.mesh ? this.mesh.arrays : [], start);
  }

  showPicks() {
    const kind = PICKS[this.model.name];
    $("picks").hidden = !kind;
    $("clear-picks").hidden = !this.picks.length;
    $("pick-value-row").hidden = !kind || !kind.valued;
    if (kind) {
      $("picks-help").textContent = kind.words;
      $("pick-list").replaceChildren(...this.picks.map((pick, i) => makeElement("li", {},
        `Point ${pick.point}${kind.valued ? `: ${shortNumber(pick.value)}` : ""}`,
        makeElement("button", { type: "button", textContent: "Remove", ariaLabel: `Remove point ${pick.point}`,
          onclick: () => { this.picks.splice(i, 1); this.showPicks(); } }))));
    }
    this.view.setMarks(this.picks.map(({ point, value }) => ({ point,
      colour: kind && kind.keyword === "seeds" ? LABELS[(value - 1 + 12) % 12].map((x) => x / 255) : [0.8, 0.1, 0.2] })));
  }

  /** A click: the value there, and for some models an input. */
  pick(place) {
    if (!place) {
      $("readout").textContent = "There is no surface at this place.";
      return;
    }
    const side = this.view.sides[place.side], at = [0, 1, 2].map((axis) => shortNumber(side.points[3 * place.point + axis]));
    const words = [`Point ${place.point} at (${at.join(", ")})`];
    this.shownArrays().forEach(({ array, title, on }) => { // a refined surface has other triangles
      if (array && on.triangles === side.triangles) { words.push(`${title}: ${this.valueAt(array, place, on)}`); }
    });
    $("readout").textContent = words.join(" · ");
    const kind = PICKS[this.model.name];
    if (kind && side.triangles === this.mesh.triangles) {
      const value = Number($("pick-value").value.replace("−", "-").replace(",", "."));
      if (kind.valued && !Number.isFinite(value)) {
        this.say(`The value of the next click is “${$("pick-value").value}”; allowed: a number.`, "error");
        return;
      }
      this.picks = [...this.picks.filter(({ point }) => point !== place.point), { point: place.point, value }];
      this.showPicks();
    }
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
    const unit = this.unitOf(array.name);
    return numbers.map(shortNumber).join(", ") + (unit && ` ${unit}`);
  }

  /** The unit of an array; empty if it is not known. */
  unitOf(name) {
    const unit = $("units").value;
    if (!unit) { return ""; }
    if (/gauss.*curvature/i.test(name)) { return `1/${unit}²`; }
    if (/curvature/i.test(name)) { return `1/${unit}`; }
    return /distance|displacement|thickness|sulc|height/i.test(name) ? unit : "";
  }

  // ---- runs -------------------------------------------------------------------------------------

  /** The options of the form, with what a first run needs and does not have yet; notes say what. */
  options() {
    const notes = [], options = { ...this.controls.read() }, { model, mesh } = this;
    const name = $("array").value, kind = PICKS[model.name];
    if (model.data && name) {
      options.array = name;
      options.association = (arrayNamed(mesh.arrays, name) || { association: "point" }).association;
    }
    if (kind && this.picks.length) {
      Object.assign(options, this.pickedInputs(kind));
    } else if (model.name === "distance" && !name) {
      const point = highest(mesh.points);
      options.sources = [point];
      notes.push(`The distance is that from the highest point, ${point}. Clicks choose others.`);
    } else if (model.name === "interpolate") {
      const array = arrayNamed(mesh.arrays, name);
      if (array && array.values && array.association === "point" && !array.values.some(Number.isNaN)) {
        Object.assign(options, this.sampled(array));
        notes.push("The data have no gaps: the values at 200 points are given, and those between them are found.");
      }
    }
    if (model.name === "heat" && options.fwhm === STARTS.heat(mesh).fwhm) {
      notes.push(`The width, FWHM, is ${options.fwhm} ${$("units").value}, four mean edge lengths.`.replace(" ,", ","));
    }
    return { options, notes };
  }

  pickedInputs(kind) {
    const points = this.picks.map(({ point }) => point), values = this.picks.map(({ value }) => value);
    return kind.valued ? { [kind.keyword]: { points, values } } : { [kind.keyword]: points };
  }

  sampled({ values, components }) {
    const count = values.length / components, step = Math.max(1, count / 200), points = [];
    for (let i = 0.5 * step; i < count; i += step) { points.push(Math.floor(i)); }
    return { values: { points, values: points.map((p) => values[components * p]) } };
  }

  async apply() {
    if (!this.mesh || $("apply").disabled) { return; }
    await this.attempt((async () => {
      await this.ensureHeight();
      const { options, notes } = this.options();
      await this.run(this.model.name, options, notes);
    })());
  }

  /** The engine gets the height of the points as data, as a file of values, when it is first used. */
  async ensureHeight() {
    const { mesh } = this;
    const { name, axis } = mesh.own;
    if (!this.model.data || $("array").value !== name || arrayNamed(mesh.arrays, name)) { return; }
    const lines = [name];
    for (let i = axis; i < mesh.points.length; i += 3) { lines.push(mesh.points[i]); }
    const { arrays } = await this.client.open(`${name}.csv`, new TextEncoder().encode(lines.join("\n") + "\n"));
    mesh.arrays = arrays.map((array) => ({ ...array }));
    this.offerArrays(name);
    await this.valuesOf(arrayNamed(mesh.arrays, name));
  }

  /** Runs a model, as by Apply. Returns arrays by name, moved points, history, numbers and warnings. */
  async run(model, options = {}, notes = [], shown = null) {
    await this.ready;
    if (!this.mesh) { throw new Error("There is no surface; open a file first."); }
    const { mesh } = this, start = performance.now(), number = ++this.runs;
    this.running = number;
    $("progress").removeAttribute("value");
    this.enable();
    this.say("Running …");
    let found;
    try {
      found = await this.client.call("run", model, JSON.stringify(options, (key, value) =>
        (ArrayBuffer.isView(value) ? [...value] : value)));
    } finally {
      if (this.running === number) { this.running = 0; }
      this.enable();
    }
    if (mesh !== this.mesh) { throw new Cancelled("Another file has been opened."); }
    const moved = found.coordinates && mesh.points.some((x, i) => x !== found.coordinates[i]);
    this.result = { ...found, model, options, input: options.array || "", points: found.coordinates,
      triangles: found.resultTriangles || mesh.triangles, cells: found.resultCellOfTriangle || mesh.cells };
    this.saveLater();
    const names = found.arrays.map(({ name }) => name);
    $("shown").replaceChildren(...found.arrays.map(({ name }) => makeElement("option", { value: name, textContent: lastPart(name) })),
      makeElement("option", { value: "", textContent: "the surface alone" }));
    $("shown").value = shown !== null ? shown : moved ? "" : mainResult(names, this.result.input);
    if (shown === null) { this.offerTimes(); }
    const seconds = ((performance.now() - start) / 1000).toFixed(2);
    this.say([...notes, `Done in ${seconds} s.`].join("\n"), "", found.warnings);
    this.showNumbers();
    await this.showResult();
    this.enable();
    return { arrays: Object.fromEntries(found.arrays.map(({ name, values }) => [name, values])),
      points: found.coordinates, history: found.history, numbers: found.numbers, times: found.times,
      warnings: found.warnings };
  }

  enable() {
    $("apply").disabled = !this.mesh || Boolean(this.running);
    $("cancel").disabled = !this.running;
    $("progress").hidden = !this.running;
    $("download").disabled = !this.result;
    $("results").hidden = !this.result;
    $("empty").hidden = Boolean(this.mesh);
    $("shown-row").hidden = !this.result;
  }

  // ---- results ----------------------------------------------------------------------------------

  /** The file of the result is made in the background, so that a later run or its end does not take it. */
  saveLater() {
    const { name } = this.mesh, dot = name.lastIndexOf(".");
    const gz = /\.gz$/i.test(name);
    const stem = dot > 0 ? name.slice(0, dot) : name, ending = dot > 0 ? name.slice(dot) : "";
    const target = gz ? name.replace(/(\.[^.]+)?\.gz$/i, "_result$1") : `${stem}_result${ending}`;
    this.file = { name: target, bytes: this.client.call("write", target) };
    this.file.bytes.catch(() => {}); // the download says it
  }

  async download() {
    const { name, bytes } = this.file;
    save(name, new Blob([await bytes], { type: "application/octet-stream" }));
  }

  /** The result as the next input: its arrays are data, and its points those of the surface. */
  async goOn() {
    const bytes = await this.client.call("write", "result.vtp");
    const { name } = this.mesh, shown = $("shown").value, unit = $("units").value;
    await this.open(name.replace(/(\.[^.]*)?$/, ".vtp"), bytes.buffer, unit);
    if (arrayNamed(this.mesh.arrays, shown)) {
      this.offerArrays(shown);
      await this.showBefore();
    }
  }

  showNumbers() {
    const { numbers, history } = this.result;
    $("numbers").replaceChildren(...Object.entries(numbers).flatMap(([name, value]) => {
      const list = [value].flat(3).filter((x) => typeof x === "number");
      return list.length && list.length <= 8 ? [makeElement("dt", { textContent: wordsOf(name) }),
        makeElement("dd", { textContent: list.map(shortNumber).join(", ") })] : [];
    }));
    const curve = curveOf(history || []);
    $("curve").replaceChildren(...(curve ? [curve.svg, makeElement("figcaption", { textContent: curve.words })] : []));
  }

  /** The numbers of an array of the mesh, from the engine when they are first asked for. */
  async valuesOf(array) {
    if (!array.values) { array.values = await this.client.call("array", array.name, array.association); }
    return array;
  }

  async showBefore(frame = false) {
    const { mesh } = this, array = arrayNamed(mesh.arrays, $("array").value);
    if (array) {
      await this.valuesOf(array);
      array.shown = array.shown || prepareValues(array, mesh.cells);
    }
    this.before = array || null;
    if (!this.before && $("array").value === mesh.own.name) {
      this.before = { name: mesh.own.name, association: "point", components: 1,
        values: mesh.points.filter((_, i) => i % 3 === mesh.own.axis) };
      this.before.shown = prepareValues(this.before, mesh.cells);
    }
    this.showSides(frame);
  }

  async showResult() {
    const { result } = this, array = arrayNamed(result.arrays, $("shown").value);
    if (array && !array.shown) { array.shown = prepareValues(array, result.cells); }
    this.showSides();
  }

  /** Offers the steps of a run that has time steps of one length: a run of fewer steps is a state on the way. */
  offerTimes() {
    const { times, model, options } = this.result, steps = times ? times.length - 1 : 0;
    const hasSteps = this.models.find(({ name }) => name === model).settings.some(({ name }) => name === "time_step");
    const isSteady = options.mode === "SteadyState" || options.automatic_time_step || !hasSteps
      || !this.result.history.some(({ name }) => name === "Time") || model === "mumford_shah";
    this.series = steps > 1 && !isSteady ? { model, options, times } : null;
    $("times").hidden = !this.series;
    if (this.series) {
      $("time").max = steps;
      $("time").value = steps;
      $("time-value").textContent = shortNumber(times[steps]);
    }
  }

  /** Runs to the step that the slider is at; while it moves on, only to the last one. */
  showTime() {
    const step = Number($("time").value), { series } = this, steps = series.times.length - 1;
    $("time-value").textContent = shortNumber(series.times[step]);
    clearTimeout(this.timer);
    this.timer = setTimeout(async () => {
      if (this.running) {
        this.showTime();
        return;
      }
      const options = { ...series.options, number_of_time_steps: step };
      if (options.fwhm) { options.fwhm *= Math.sqrt(step / steps); } // squared widths add
      await this.attempt(this.run(series.model, options, [`Step ${step} of ${steps}.`], $("shown").value));
    }, 150);
  }

  /** What is on the left and on the right. */
  shownArrays() {
    const { result, mesh } = this;
    if (!result) { return [{ array: this.before, title: this.before ? lastPart(this.before.name) : "", on: mesh }]; }
    const alone = $("shown").value === "";
    const after = alone ? null : arrayNamed(result.arrays, $("shown").value);
    return [{ array: alone ? null : this.before, on: mesh,
      title: this.before && !alone ? lastPart(this.before.name) : "Before" },
    { array: after, on: result, title: after ? lastPart(after.name) : "After" }];
  }

  showSides(frame = false) {
    if (!this.mesh) { return; }
    const { mesh, result } = this, arrays = this.shownArrays();
    this.setRanges(arrays.map(({ array }) => array && array.shown));
    const sides = arrays.map(({ array, on }, i) => ({ triangles: on.triangles, values: array && array.shown,
      points: i === 1 && result.points ? result.points : mesh.points }));
    this.view.show(sides, frame);
    this.placePanes();
  }

  /** The same colours before and after if the result is the same quantity; given limits win. */
  setRanges([before, after]) {
    const automatic = (shown) => {
      const { first, last } = shown.extent;
      return shown.signed ? symmetric(first, last) : [first, last];
    };
    const plain = (shown) => shown && !shown.colours;
    [before, after].filter(plain).forEach((shown) => setRange(shown, automatic(shown)));
    const width = plain(before) ? before.extent.last - before.extent.first : 0;
    const shares = plain(before) && plain(after) && !after.labels && !before.labels && width > 0
      && this.result.model !== "derivatives" && after.extent.first >= before.extent.first - 0.3 * width
      && after.extent.last <= before.extent.last + 0.3 * width
      && after.extent.last - after.extent.first > 0.02 * width
      && $("shown").value.startsWith(this.result.input || "\n");
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
    const isDistance = /distance|arrival/i.test($("shown").value) && Boolean(this.result);
    const lines = this.lines === undefined ? isDistance : this.lines;
    $("lines").checked = lines;
    [before, after].filter(plain).forEach((shown) => {
      shown.interval = lines && !shown.labels ? roundInterval(shown.limits[1] - shown.limits[0]) : 0;
    });
  }

  placePanes() {
    if (!this.mesh) { return; }
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
    if (!this.mesh) { return; }
    this.shownArrays().forEach(({ array, title }, i) => {
      const canvas = $(`pane-${i}`).firstElementChild, ratio = window.devicePixelRatio || 1;
      const unit = array ? this.unitOf(array.name) : "", name = title + (unit && ` (${unit})`);
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
    if (!this.mesh) { return; }
    this.view.draw();
    const canvas = makeElement("canvas", { width: $("view").width, height: $("view").height });
    const context = canvas.getContext("2d");
    context.drawImage($("view"), 0, 0);
    this.view.sides.forEach((_, i) => {
      const port = this.view.viewport(i), bar = $(`pane-${i}`).firstElementChild, ratio = window.devicePixelRatio || 1;
      context.drawImage(bar, port.x + 14 * ratio, canvas.height - port.y - port.height + 11 * ratio);
    });
    canvas.toBlob((blob) => save(`${this.mesh.name.replace(/\.[^.]*$/, "")}.png`, blob), "image/png");
  }
}

/** The result that is shown first: that of the data, or the one that the model is named for. */
function mainResult(names, input) {
  const ofData = input && names.find((name) => name.startsWith(input) && name !== input);
  const wanted = [/^texture$/i, /region/i, /^(distance|arrivaltime)$/i, /meancurvature/i, /^mean$/i, /direction/i];
  return ofData || wanted.map((pattern) => names.find((name) => pattern.test(name))).find(Boolean) || names[0] || "";
}

/** Mean edge length, size and extent of a mesh. */
function measure({ points, triangles }) {
  const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
  for (let i = 0; i < points.length; ++i) {
    low[i % 3] = Math.min(low[i % 3], points[i]);
    high[i % 3] = Math.max(high[i % 3], points[i]);
  }
  let sum = 0;
  for (let i = 0; i < triangles.length; ++i) {
    const a = 3 * triangles[i], b = 3 * triangles[i % 3 === 2 ? i - 2 : i + 1];
    sum += Math.hypot(points[a] - points[b], points[a + 1] - points[b + 1], points[a + 2] - points[b + 2]);
  }
  const extent = high.map((x, axis) => x - low[axis]);
  const size = Math.max(...extent), axis = extent[2] > 1e-3 * size ? 2 : extent.indexOf(size);
  // The data of a mesh that has none: a coordinate
  const own = { name: axis === 2 ? "Height" : `Coordinate_${"xy"[axis]}`, axis };
  return { h: sum / triangles.length || 1, extent, size, own };
}

function highest(points) {
  let best = 2;
  for (let i = 5; i < points.length; i += 3) {
    if (points[i] > points[best]) { best = i; }
  }
  return (best - 2) / 3;
}

function save(name, blob) {
  const link = makeElement("a", { href: URL.createObjectURL(blob), download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}

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

const page = new Page();
/** For scripts: what the page does, with the numbers that it shows. */
window.surfaceDiffusion = {
  ready: page.ready,
  open: (name, buffer) => page.attemptScript(() => page.open(name, buffer)),
  run: (model, options) => page.attemptScript(() => page.run(model, options)),
};
