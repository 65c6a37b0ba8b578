# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""Writes WebAssembly as a script: embed.py ENGINE.wasm OUTPUT.js.

The page may not fetch anything, so that it loads the engine as a text in a script. It is compressed
here, and decompressed by the browser: plain hosts send files as they are.
"""
import base64
import gzip
import sys
from pathlib import Path

packed = gzip.compress(Path(sys.argv[1]).read_bytes(), 9, mtime=0)
Path(sys.argv[2]).write_text('"use strict";\n// Made by embed.py.\nconst ENGINE_WASM = "'
                             + base64.b64encode(packed).decode() + '";\n')
