# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m surfacediffusion`: the command."""
import sys

from .command import main

sys.exit(main())
