# SPDX-FileCopyrightText: Copyright (c) SurfaceDiffusion contributors
# SPDX-License-Identifier: BSD-3-Clause
"""`python -m surfacediffusion.command`."""
import sys

from . import main

sys.exit(main())
