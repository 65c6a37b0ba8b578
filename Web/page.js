// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// The page: files, model, run, comparison. Numbers come from the engine in its worker.

/** What a model starts with where its default would refuse, or change nothing. h: the mean edge length. */
const STARTS = {
  heat: ({ h }) => ({ fwhm: rounded(4 * h) }),
  random_field: ({ h }) => ({ fwhm: rounded(10 * h) }),
  relief: ({ size }) => ({ height: rounded(0.01 * size) }),
  harmonic_map: () => ({ move_vertices: true }),
};
const LARGEST_FILE = 5e8; // bytes; readers take four times as much
/** Names of files that have values and no surface. */
const VALUES = /\.((csv|txt|tsv|mgh|mgz|label|annot|(func|shape|label)\.gii)(\.gz)?)$|(^|\/)[lr]h\.(thickness|curv|sulc|area|volume)[^/]*$/i;

const lastPart = (name) => name.split("/").pop() || name; // of arrays that are named after a file
const arrayNamed = (arrays, name) => arrays.find((array) => array.name === name);

class Page {
  constructor() {
    this.client = new EngineClient((fraction) => { $("progress").value = fraction; });
    this.mesh = null;
    this.result = null;
    this.runs = 0;
    this.controls = new Controls($("settings"), $("more-settings"), () => $("units").value);
    this.comparison = new Comparison((place) => this.pick(place));
    this.picks = new Picks((marks) => this.comparison.view.setMarks(marks));
    this.ready = this.client.call("describe").then(({ models }) => {
      this.models = models;
      $("model").append(...models.map(({ name, title }) => makeElement("option",
        { value: name, textContent: (PANELS[name] || { title }).title })));
      $("model").value = models.some(({ name }) => name === "heat") ? "heat" : models[0].name;
      this.chooseModel();
    });
    this.ready.catch((problem) => this.say(problem.message, "error"));
    this.listen();
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
    on("units", "change", () => { this.showControls(); this.comparison.update(); });
    on("cancel", "click", () => this.cancel());
    on("download", "click", () => this.attempt(this.download(this.file)));
    on("download-paths", "click", () => this.attempt(this.download(this.file.paths)));
    on("continue", "click", () => this.attempt(this.goOn()));
    on("shown", "change", () => this.attempt(this.showResult()));
    on("time", "input", () => this.showTime());
    const over = (event) => {
      event.preventDefault();
      document.body.classList.toggle("dropping", event.type === "dragover");
    };
    ["dragover", "dragleave", "drop"].forEach((name) => window.addEventListener(name, over));
    window.addEventListener("drop", (event) => this.openFiles([...event.dataTransfer.files]));
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
    let left = [...files].sort((a, b) => VALUES.test(a.name) - VALUES.test(b.name)), problems = [];
    for (let opened = true; opened && left.length;) { // values may have to wait for their surface
      const failed = [];
      problems = [];
      opened = false;
      for (const file of left) {
        try {
          if (file.size > LARGEST_FILE) {
            throw new Error(`${file.name} has ${plural(Math.round(file.size / 1e6), "megabyte")}; allowed: `
              + `${LARGEST_FILE / 1e6}, which the memory of a page has room for`);
          }
          await this.open(file.name, await file.arrayBuffer());
          opened = true;
        } catch (problem) {
          failed.push(file);
          problems.push(problem.message);
        }
      }
      opened = opened && failed.length < left.length;
      left = failed;
    }
    if (left.length) { this.say([...new Set(problems)].join("\n"), "error"); }
  }

  /** Opens a file, as by dropping it. former: name, unit and kind of that which it is made of. Returns what it has. */
  async open(name, bytes, former = {}) {
    await this.ready;
    const start = performance.now();
    this.say(`Reading ${name} …`);
    const opened = await this.client.open(name, bytes);
    if (opened.isSame && this.mesh) {
      this.mesh.arrays = opened.arrays.map((array) => ({ ...array }));
    } else {
      this.mesh = { name: former.name || name, kind: former.kind || opened.kind, points: opened.coordinates, triangles: opened.triangles,
        cells: opened.cellOfTriangle, h: opened.meanEdgeLength || 1, arrays: opened.arrays.map((array) => ({ ...array })) };
      this.result = null;
      this.file = null;
      this.comparison.view.setPaths([]);
      this.picks.choose(this.model.name);
      Object.assign(this.mesh, measure(this.mesh, this.mesh.kind)); // extent, size, own, view
      this.comparison.view.camera.usual = this.mesh.view;
      this.series = null;
      $("times").hidden = true;
      $("units").value = opened.unit || former.unit || "";
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
    this.picks.choose(name);
    if (this.mesh) {
      this.offerArrays(null);
      this.attempt(this.showBefore());
    } else {
      this.showControls();
    }
  }

  /** A click: for some models an input. */
  pick(place) {
    if (place && this.comparison.sides[place.side].on.triangles === this.mesh.triangles) {
      this.attempt((async () => this.picks.add(place.point))());
    }
  }

  showControls() {
    const { model } = this, start = this.mesh && STARTS[model.name] ? STARTS[model.name](this.mesh) : {};
    const array = this.mesh && arrayNamed(this.mesh.arrays, $("array").value);
    this.controls.association = array ? array.association : "point";
    this.controls.hasData = Boolean($("array").value);
    this.controls.show(model, this.mesh ? this.mesh.arrays : [], start);
    $("memory").textContent = this.mesh ? refusal(this.mesh, model.name, {}) : "";
  }

  // ---- runs -------------------------------------------------------------------------------------

  /** The options of the form, with what a first run needs and does not have yet; notes say what. */
  options() {
    const notes = [], options = { ...this.controls.read() }, { model, mesh } = this;
    const name = $("array").value;
    if (model.data && name) {
      options.array = name;
      options.association = (arrayNamed(mesh.arrays, name) || { association: "point" }).association;
    }
    if (this.picks.list.length) {
      Object.assign(options, this.picks.inputs(options));
    }
    if (model.name === "distance" && !name && !options.sources) {
      const point = highest(mesh);
      options.sources = [point];
      notes.push(`The distance is that from the point ${point}, the highest one. Clicks choose others.`);
    } else if (model.name === "interpolate" && !options.values) {
      const array = arrayNamed(mesh.arrays, name);
      if (array && array.values && array.association === "point" && !array.values.some(Number.isNaN)) {
        options.values = sampled(array);
        notes.push("The data have no gaps: the values at 200 points are given, and those between them are found.");
      }
    }
    if (model.name === "heat" && options.fwhm === STARTS.heat(mesh).fwhm) {
      notes.push(`The width, FWHM, is ${options.fwhm} ${$("units").value}, four mean edge lengths.`.replace(" ,", ","));
    }
    if (options[model.data]) { // chosen points are in place of an array
      delete options.array;
      delete options.association;
    }
    return { options, notes };
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
    const tooLarge = refusal(this.mesh, model, options);
    if (tooLarge) { throw new Error(tooLarge); }
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
    this.result = { ...found, model, options, input: options.array || "", points: found.coordinates || mesh.points,
      triangles: found.resultTriangles || mesh.triangles, cells: found.resultCellOfTriangle || mesh.cells };
    this.comparison.view.setPaths(found.paths.map((path) => path.points));
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
      paths: found.paths, warnings: found.warnings };
  }

  /** The file of the former result is made before the run, in the worker that ends here: it gets 0.8 s. */
  async cancel() {
    const bytes = this.file ? this.file.bytes.catch(() => {}) : null;
    await Promise.race([bytes, new Promise((done) => { setTimeout(done, 800); })]);
    if (this.running) { this.client.cancel(); }
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
    const write = (call, written) => {
      const file = { name: written, bytes: this.client.call(call, written) };
      file.bytes.catch(() => {}); // the download says it
      return file;
    };
    this.file = write("write", target);
    if (this.result.paths.length) { this.file.paths = write("writePaths", `${stem}_paths.vtp`); }
  }

  async download({ name, bytes }) {
    save(name, new Blob([await bytes], { type: "application/octet-stream" }));
  }

  /** The result as the next input: its arrays are data, and its points those of the surface. */
  async goOn() {
    const bytes = await this.client.call("write", "result.vtp");
    const { name, kind } = this.mesh, shown = $("shown").value;
    await this.open(name.replace(/(\.[^.]*)?$/, ".vtp"), bytes.buffer, { name, kind, unit: $("units").value });
    if (arrayNamed(this.mesh.arrays, shown)) {
      this.offerArrays(shown);
      await this.showBefore();
    }
  }

  showNumbers() {
    const { numbers, history, paths, options } = this.result, unit = $("units").value;
    $("download-paths").hidden = !paths.length;
    const lengths = paths.map(({ length, start }) => [makeElement("dt", { textContent: Array.isArray(options.path_points)
      ? `Path from point ${options.path_points[start]}` : `Path ${start + 1}` }),
    makeElement("dd", { textContent: `${shortNumber(length)}${unit && ` ${unit}`}` })]);
    $("numbers").replaceChildren(...lengths.flat(), ...Object.entries(numbers).flatMap(([name, value]) => {
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
    const { mesh, result } = this, isSame = Boolean(result) && result.model !== "derivatives"
      && $("shown").value.startsWith(result.input || "\n");
    if (mesh) { this.comparison.show(this.shownArrays(), mesh.name, isSame, frame); }
  }
}

/** The result that is shown first: that of the data, or the one that the model is named for. */
function mainResult(names, input) {
  const ofData = input && names.find((name) => name.startsWith(input) && name !== input);
  const wanted = [/^texture$/i, /^(distance|arrivaltime)$/i, /meancurvature/i, /^mean$/i, /direction/i];
  const found = wanted.map((pattern) => names.find((name) => pattern.test(name))).find(Boolean);
  return names.find((name) => name === "RegionId") || ofData || found || names[0] || "";
}

const page = new Page();
/** For scripts: what the page does, with the numbers that it shows. */
window.surfaceDiffusion = {
  ready: page.ready,
  open: (name, buffer) => page.attemptScript(() => page.open(name, buffer)),
  run: (model, options) => page.attemptScript(() => page.run(model, options)),
};
