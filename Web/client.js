// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

/** The error of a run that the user, or a newer file, has ended. */
class Cancelled extends Error {}

/**
 * The engine in its worker. A run cannot be interrupted from outside: cancel() ends the worker and starts
 * another one, which opens the same files again.
 */
class EngineClient {
  constructor(onProgress) {
    this.onProgress = onProgress;
    const text = `"use strict";var _scriptDir;(${surfaceDiffusionWorker})(${SurfaceDiffusionEngine});`;
    this.script = URL.createObjectURL(new Blob([text], { type: "text/javascript" }));
    this.files = []; // [{name, bytes}]: the surface, then files of values
    this.code = unpack(ENGINE_WASM).then((code) => WebAssembly.compile(code));
    this.start();
  }

  start() {
    this.waiting = new Map();
    this.last = this.last || 0;
    const worker = this.worker = new Worker(this.script);
    this.code.then((code) => worker.postMessage({ code }), (problem) => this.refuse(problem));
    this.worker.onmessage = ({ data }) => {
      const call = this.waiting.get(data.id);
      if (!call) { return; }
      if (data.progress !== undefined) {
        this.onProgress(data.progress);
        return;
      }
      this.waiting.delete(data.id);
      if (data.error === undefined) {
        call.resolve(data.value);
      } else {
        call.reject(new Error(data.broken ? EngineClient.explain(data.error) : data.error));
        if (data.broken) { this.restart(new Error(EngineClient.explain(data.error))); }
      }
    };
    this.worker.onerror = (event) => {
      event.preventDefault();
      this.restart(new Error(EngineClient.explain(event.message)));
    };
  }

  /** All calls end with an error, since there is no engine. */
  refuse(problem) {
    this.waiting.forEach(({ reject }) => reject(new Error(`The engine cannot start: ${problem.message}`)));
  }

  /** One line for what the engine's virtual machine says. */
  static explain(text) {
    return /memory|alloc|abort|OOM/i.test(text)
      ? "The page's memory, 2 GB, does not suffice for this; a surface with fewer triangles may fit."
      : `The engine has stopped: ${text}`;
  }

  call(call, ...args) {
    return new Promise((resolve, reject) => {
      const id = ++this.last;
      this.waiting.set(id, { resolve, reject });
      this.worker.postMessage({ id, call, args });
    });
  }

  async open(name, bytes) {
    const opened = await this.call("open", name, bytes);
    const same = this.surface && name !== this.files[0].name
      && this.surface.length === opened.coordinates.length
      && this.surface.every((x, i) => x === opened.coordinates[i] || Number.isNaN(x));
    this.files = same ? this.files.filter((file) => file.name !== name) : [];
    this.files.push({ name, bytes });
    this.surface = opened.coordinates;
    return { ...opened, isSame: Boolean(same) };
  }

  /** Ends what runs at once; the files are opened again in the background. */
  restart(reason) {
    const { waiting } = this;
    this.worker.terminate();
    this.start();
    this.files.forEach(({ name, bytes }) => this.call("open", name, bytes).catch(() => {}));
    waiting.forEach(({ reject }) => reject(reason));
  }

  cancel() {
    this.restart(new Cancelled("The run was cancelled."));
  }
}
