// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
"use strict";

/**
 * What the worker does: it calls the engine, and answers. The page makes a worker of the text of this
 * function and of the engine (client.js), so that a new one, after a cancelled run, asks for no file.
 * It sees no variable of the page.
 */
function surfaceDiffusionWorker(makeEngine) {
  "use strict";
  let reported = 0, current = 0;
  const options = {
    print: () => {},
    printErr: () => {},
    onProgress: (fraction) => {
      const now = Date.now();
      if (now - reported > 100) {
        reported = now;
        self.postMessage({ id: current, progress: fraction });
      }
      return false; // a run is cancelled by the end of its worker
    },
  };
  // The first message is the compiled engine; no worker compiles it again.
  let started = null;
  const ready = new Promise((resolve) => { started = resolve; }).then((code) => makeEngine({ ...options,
    instantiateWasm: (imports, done) => {
      WebAssembly.instantiate(code, imports).then((instance) => done(instance));
      return {};
    } }));

  /** A copy, if these numbers lie in the engine's memory, which they must not leave. */
  const own = (numbers, engine) =>
    numbers && (!engine.HEAPU8 || numbers.buffer === engine.HEAPU8.buffer) ? numbers.slice() : numbers;

  const calls = {
    describe: (engine) => JSON.parse(engine.describe()),
    open: (engine, name, bytes) => ({ ...JSON.parse(engine.open(name, new Uint8Array(bytes))),
      coordinates: own(engine.points(), engine), triangles: own(engine.triangles(), engine),
      cellOfTriangle: own(engine.cellOfTriangle(), engine) }),
    array: (engine, name, association) => own(engine.array(name, association), engine),
    run: (engine, model, text) => {
      const result = JSON.parse(engine.run(model, text));
      result.arrays.forEach((array) => { array.values = own(engine.resultArray(array.name), engine); });
      result.coordinates = result.points ? own(engine.resultPoints(), engine) : null;
      for (const name of ["resultTriangles", "resultCellOfTriangle"]) { // of surfaces that a run refines
        result[name] = result.refined ? own(engine[name](), engine) : null;
      }
      return result;
    },
    write: (engine, name) => own(engine.write(name), engine),
    writePaths: (engine, name) => own(engine.writePaths(name), engine),
  };

  const buffersOf = (value) => {
    if (ArrayBuffer.isView(value)) { return [value.buffer]; }
    return value && typeof value === "object" ? Object.values(value).flatMap(buffersOf) : [];
  };

  self.onmessage = async ({ data: { id, call, args, code } }) => {
    if (code) {
      started(code);
      return;
    }
    try {
      const engine = await ready;
      current = id;
      const value = calls[call](engine, ...args);
      self.postMessage({ id, value }, [...new Set(buffersOf(value))]);
    } catch (problem) {
      // The engine's own errors are sentences; others mean that it cannot go on.
      const sentence = problem && problem.constructor === Error;
      const text = problem && problem.message ? problem.message : String(problem);
      self.postMessage({ id, error: text, broken: !sentence });
    }
  };
}
