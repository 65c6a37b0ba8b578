// SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
// SPDX-License-Identifier: BSD-3-Clause
//
// The engine of the page in node, for tests: a command a line on standard input, {call, arguments},
// and its answer a line on standard output, {value} or {error}. Arrays of numbers and bytes are in
// base 64.
"use strict";

const readline = require("readline");
const makeEngine = require(process.argv[2]);

function decode(argument) {
  return argument && argument.base64 !== undefined
    ? new Uint8Array(Buffer.from(argument.base64, "base64"))
    : argument;
}

function encode(value) {
  return ArrayBuffer.isView(value)
    ? { type: value.constructor.name, base64: Buffer.from(value.buffer).toString("base64") }
    : value;
}

const { readFileSync } = require("fs");
makeEngine({ wasmBinary: readFileSync(process.argv[2].replace(/js$/, "wasm")) }).then((engine) => {
  let calls = 0;
  engine.onProgress = () => { calls += 1; return false; };
  readline.createInterface({ input: process.stdin }).on("line", (line) => {
    const command = JSON.parse(line);
    const answer = {};
    try {
      answer.value = command.call === "cancel"
        ? cancel(engine, ...command.arguments)
        : encode(engine[command.call](...command.arguments.map(decode)));
    } catch (error) {
      answer.error = error instanceof Error ? error.message : `no Error: ${error}`;
    }
    process.stdout.write(`${JSON.stringify({ ...answer, calls })}\n`);
  });
});

/** Runs a model and asks to stop at once. */
function cancel(engine, model, given) {
  const before = engine.onProgress;
  engine.onProgress = () => true;
  try {
    return engine.run(model, given);
  } finally {
    engine.onProgress = before;
  }
}
