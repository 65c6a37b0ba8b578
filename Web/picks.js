// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

/** What clicks add, by model: the keyword, the words, whether each point has a value, and whether it may start a path. */
const PICKS = {
  distance: { keyword: "sources", words: "Click the points that distances start from. "
    + "From other clicks the shortest paths to the nearest of them are drawn.", valued: false, hasPaths: true },
  segment: { keyword: "seeds", words: "Clicks mark regions, which have the numbers 1, 2, … "
    + "Without any, the data alone decide.", valued: true },
  interpolate: { keyword: "values", words: "Clicks give measured values, in place of the data. "
    + "Of data without gaps, values at 200 points are taken.", valued: true },
};

/** The points that were clicked for a model, with their values, and the part of the form that lists them. */
class Picks {
  /** setMarks([{point, colour}]): shows them on the surface. */
  constructor(setMarks) {
    this.setMarks = setMarks;
    this.list = []; // [{point, value, role}]; role: the keyword
    $("clear-picks").addEventListener("click", () => this.set([]));
  }

  choose(model) {
    this.kind = PICKS[model];
    $("pick-role").value = "sources";
    this.set([]);
  }

  /** Throws an error if the value of the form is none. */
  add(point) {
    if (!this.kind) { return; }
    const text = $("pick-value").value, value = Number(text.replace("−", "-").replace(",", "."));
    const isLabel = this.kind.keyword === "seeds";
    if (this.kind.valued && !(isLabel ? Number.isInteger(value) && value > 0 : text.trim() && Number.isFinite(value))) {
      throw new Error(`The value of the next click is “${text}”; allowed: ${isLabel ? "1, 2, …" : "a number"}.`);
    }
    const role = this.kind.hasPaths ? $("pick-role").value : this.kind.keyword;
    this.set([...this.list.filter((pick) => pick.point !== point), { point, value, role }]);
  }

  set(list) {
    const { kind } = this;
    this.list = list;
    $("picks").hidden = !kind;
    $("clear-picks").hidden = !list.length;
    $("pick-value-row").hidden = !kind || !kind.valued;
    $("pick-role-row").hidden = !kind || !kind.hasPaths;
    $("picks-help").textContent = kind ? kind.words : "";
    $("pick-list").replaceChildren(...list.map((pick) => makeElement("li", {},
      `Point ${pick.point}${kind.valued ? `: ${shortNumber(pick.value)}` : pick.role === kind.keyword ? "" : ": start of a path"}`,
      makeElement("button", { type: "button", textContent: "Remove", ariaLabel: `Remove point ${pick.point}`,
        onclick: () => this.set(this.list.filter((other) => other !== pick)) }))));
    this.setMarks(list.map(({ point, value, role }) => ({ point, colour: role === "path_points" ? PATH_COLOUR
      : role === "seeds" ? LABELS[(value - 1) % LABELS.length].map((x) => x / 255) : [0.8, 0.1, 0.2] })));
  }

  /** As arguments of the model. options: its others. Seeds of a region that the form does not count add it. */
  inputs({ number_of_regions: regions = 2 }) {
    const pointsOf = (role) => this.list.filter((pick) => pick.role === role).map(({ point }) => point);
    const { keyword, valued, hasPaths } = this.kind, values = this.list.map(({ value }) => value);
    const points = pointsOf(keyword), starts = hasPaths ? pointsOf("path_points") : [];
    return { ...(points.length ? { [keyword]: valued ? { points, values } : points } : {}),
      ...(starts.length ? { path_points: starts } : {}),
      ...(keyword === "seeds" ? { number_of_regions: Math.max(regions, ...values) } : {}) };
  }
}
