// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

// Elements of the page, and the settings of a model as a form, made from their declarations and from the
// plugin's panels.

const $ = (id) => document.getElementById(id);

/** "NumberOfTimeSteps" as "Number of time steps", "FWHM" as it is. */
function wordsOf(name) {
  const words = name.replace(/([a-z0-9])([A-Z])/g, "$1 $2").replace(/([A-Z])([A-Z][a-z])/g, "$1 $2").split(" ");
  return words.map((word, i) => (i === 0 || /^[A-Z]{2,}$|^Delaunay$/.test(word) ? word : word.toLowerCase())).join(" ");
}

/**
 * Whether a condition of SettingInfo::OnlyIf holds: "Exact=0 and (MaskArray or Method=Heat)". valueOf(name):
 * a setting's value as a number or word, or whether an array is given; undefined: the model has no such
 * setting, and the part holds.
 */
function holds(condition, valueOf) {
  return condition.split(";").every((part) => {
    const tokens = part.match(/[()]|[^\s()]+/g) || [];
    const term = () => {
      if (tokens[0] === "(") {
        tokens.shift();
        const inner = expression();
        tokens.shift();
        return inner;
      }
      const [, absent, name, sign, wanted] = tokens.shift().match(/^(!?)(\w+)(?:(!?=)(.*))?$/);
      const value = valueOf(name);
      return value === undefined || (sign ? (String(value) === wanted) === (sign === "=") : Boolean(value) === !absent);
    };
    const expression = () => {
      let result = term();
      while (tokens[0] === "and" || tokens[0] === "or") {
        const isAnd = tokens.shift() === "and", next = term();
        result = isAnd ? result && next : result || next;
      }
      return result;
    };
    return expression();
  });
}

function makeElement(tag, properties = {}, ...children) {
  const element = Object.assign(document.createElement(tag), properties);
  element.append(...children);
  return element;
}

/** Inputs that are chosen among the arrays, by the name of the panels. */
const ARRAY_INPUTS = { MaskArray: "mask", DirectionArray: "directions", FixedArray: "fixed",
  FidelityArray: "fidelity", DiffusionRateArray: "rates", SpeedArray: "speed", SourceTimes: "start",
  SeedArray: "seeds", CreaseArray: "creases", DataTermArray: "terms", SlopeErrorArray: "error" };

class Controls {
  /** unit(): that of the coordinates, or "". */
  constructor(first, more, unit) {
    Object.assign(this, { first, more, unit });
    this.fields = [];
    [first, more].forEach((place) => place.addEventListener("input", () => this.update()));
  }

  /** Shows the settings of a model. start: values for some of them. arrays: those of the surface. */
  show(model, arrays, start) {
    const panel = PANELS[model.name] || { entries: {} };
    const order = Object.keys(panel.entries);
    const place = (name) => (order.includes(name) ? order.indexOf(name) : order.length);
    this.fields = [];
    model.settings.forEach((setting) => {
      const entry = panel.entries[setting.property] || { advanced: true };
      this.fields.push({ setting, entry, name: setting.name, property: setting.property, onlyIf: setting.onlyIf,
        advanced: entry.advanced, ...this.inputOf(setting, start[setting.name]) });
    });
    model.inputs.forEach(({ name }) => {
      const property = name === "hints" ? "DirectionArray"
        : Object.keys(ARRAY_INPUTS).find((key) => ARRAY_INPUTS[key] === name);
      const entry = panel.entries[property];
      if (entry && arrays.length) {
        const input = makeElement("select", {}, makeElement("option", { value: "", textContent: "none" }),
          ...arrays.map((array) => makeElement("option", { value: array.name, textContent: array.name })));
        this.fields.push({ name, property, entry, onlyIf: entry.onlyIf, advanced: true, input,
          read: () => input.value || undefined, present: () => input.value !== "" });
      }
    });
    this.fields.sort((a, b) => place(a.property) - place(b.property));
    this.first.replaceChildren();
    this.more.replaceChildren();
    this.fields.forEach((field) => (field.advanced ? this.more : this.first).append(this.rowOf(field)));
    this.update();
  }

  /** The input of a setting: read() is its value, undefined for the default; present() that of conditions. */
  inputOf(setting, start) {
    const given = start === undefined ? setting.default : start;
    if (setting.kind === "switch") {
      const input = makeElement("input", { type: "checkbox", checked: Boolean(given) });
      return { input, read: () => (input.checked === setting.default ? undefined : input.checked),
        present: () => Number(input.checked) };
    }
    if (setting.kind === "choice") {
      const input = makeElement("select", {}, ...setting.choices.map((word) =>
        makeElement("option", { value: word, textContent: wordsOf(word) })));
      input.value = given;
      return { input, read: () => (input.value === setting.default ? undefined : input.value),
        present: () => input.value };
    }
    const isList = Array.isArray(setting.default);
    const text = (value) => (isList ? value.join(" ") : String(value));
    const input = makeElement("input", { type: "text", inputMode: "decimal", autocomplete: "off",
      placeholder: given === null ? "" : text(setting.default ?? "") });
    input.value = given === null || given === undefined ? "" : text(given);
    const value = () => {
      const entries = input.value.replace(/−/g, "-").split(/[\s;]+/).filter(Boolean)
        .map((part) => (/^[-+.\d]/.test(part) ? Number(part.replace(",", ".")) : NaN));
      return entries.some(Number.isNaN) ? NaN : isList ? entries : entries.length === 1 ? entries[0]
        : entries.length ? NaN : setting.default;
    };
    return { input,
      read: () => {
        const found = value();
        if (Number.isNaN(found)) {
          throw new Error(`${setting.name} is ${JSON.stringify(input.value)}; allowed: ${isList ? "numbers" : "a number"}`);
        }
        return String(found) === String(setting.default) ? undefined : found;
      },
      present: value };
  }

  rowOf(field) {
    const { setting, entry, input } = field;
    input.id = `set-${field.name}`;
    input.name = field.name;
    const help = makeElement("p", { className: "help", id: `help-${field.name}`,
      textContent: setting ? setting.help : entry.help });
    input.setAttribute("aria-describedby", help.id);
    let unit = setting ? setting.unit : "";
    unit = unit === "coordinates" ? this.unit() : unit.replace("^2", "²");
    const label = makeElement("label", { htmlFor: input.id },
      entry.label || wordsOf(field.property).replace(/ array$/, ""),
      ...(unit && unit !== "1" && unit !== "time" ? [makeElement("small", { textContent: ` ${unit}` })] : []));
    field.row = makeElement("div", { className: input.type === "checkbox" ? "row switch" : "row" },
      label, input, help);
    return field.row;
  }

  /** Hides what has no effect with the values of the others. */
  update() {
    const valueOf = (name) => {
      if (name === "CellData") { return this.association === "cell"; }
      const field = this.fields.find((other) => other.property === name);
      if (field) { return field.present(); }
      if (name === "InputArray") { return this.hasData; }
      // The page has times, but no pipeline to play them.
      return name in ARRAY_INPUTS ? false : name === "GenerateTimeSteps" ? 0 : undefined;
    };
    this.fields.forEach((field) => {
      field.row.hidden = Boolean(field.onlyIf) && !holds(field.onlyIf, valueOf);
    });
  }

  /** The values that differ from the defaults, of what is shown. */
  read() {
    const values = {};
    this.fields.forEach((field) => {
      const value = field.row.hidden ? undefined : field.read();
      if (value !== undefined) { values[field.name] = value; }
    });
    return values;
  }
}
