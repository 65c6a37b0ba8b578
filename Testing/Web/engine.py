# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""The engine of the page, which node runs, for tests in Python."""
import base64
import json
import subprocess
from pathlib import Path

import numpy as np

_TYPES = {"Float64Array": "<f8", "Uint32Array": "<u4", "Uint8Array": "u1"}


class EngineError(Exception):
    """An Error that the engine has thrown."""


class Engine:
    """The functions of the engine as methods: open, points, run, ..."""

    def __init__(self, script):
        self._node = subprocess.Popen(["node", str(Path(__file__).with_name("engine.js")), str(script)],
                                      stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.calls = 0  # of onProgress

    def close(self):
        self._node.stdin.close()
        self._node.stdout.close()
        self._node.wait(60)

    def call(self, name, *arguments):
        encoded = [{"base64": base64.b64encode(argument).decode()} if isinstance(argument, bytes) else argument
                   for argument in arguments]
        self._node.stdin.write(json.dumps({"call": name, "arguments": encoded}) + "\n")
        self._node.stdin.flush()
        answer = json.loads(self._node.stdout.readline() or '{"error": "node has ended"}')
        self.calls = answer.get("calls", 0)
        if "error" in answer:
            raise EngineError(answer["error"])
        value = answer.get("value")
        if isinstance(value, dict):
            return np.frombuffer(base64.b64decode(value["base64"]), _TYPES[value["type"]])
        return value

    def describe(self):
        return {model["name"]: model for model in json.loads(self.call("describe"))["models"]}

    def open(self, name, data):
        return json.loads(self.call("open", name, data))

    def run(self, model, **given):
        return json.loads(self.call("run", model, json.dumps(given)))

    def points(self):
        return self.call("points").reshape(-1, 3)

    def triangles(self):
        return self.call("triangles").reshape(-1, 3)

    def array(self, name, association, components=1):
        return self.call("array", name, association).reshape(-1, components)

    def result(self, entry):
        """The numbers of an entry of arrays of a run."""
        return self.call("resultArray", entry["name"]).reshape(-1, entry["components"])

    def write(self, name):
        return self.call("write", name).tobytes()
