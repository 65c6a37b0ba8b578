#!/bin/sh
# Usage: pip_install.sh SOURCE FOLDER Runs "pip install SOURCE" in a new virtual environment in
# FOLDER, without a network, and checks the installed package. Build dependencies come from
# SURFACEDIFFUSION_WHEEL_DIR; without it the exit code is 77 (skipped).
set -eu
source=$1
folder=$2
if [ -z "${SURFACEDIFFUSION_WHEEL_DIR:-}" ]; then
  echo "SURFACEDIFFUSION_WHEEL_DIR is not set"
  exit 77
fi
unset PYTHONPATH LD_LIBRARY_PATH

rm -rf "$folder"
"${PYTHON:-/usr/bin/python3}" -m venv --system-site-packages "$folder"
PIP_CONFIG_FILE=/dev/null "$folder/bin/pip" install \
  --no-index --find-links "$SURFACEDIFFUSION_WHEEL_DIR" "$source"
cd "$folder"
bin/python - <<'SCRIPT'
import importlib.metadata
import pathlib
import sys

import surfacediffusion
from vtkmodules.vtkFiltersCore import vtkElevationFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

package = pathlib.Path(surfacediffusion.__file__).parent
assert pathlib.Path(sys.prefix) in package.parents, package
assert importlib.metadata.version("surfacediffusion") == surfacediffusion.__version__
assert (package / "vtkSurfaceDiffusion.pyi").exists() and (package / "py.typed").exists()

sphere = vtkSphereSource()
elevation = vtkElevationFilter()
elevation.SetInputConnection(sphere.GetOutputPort())
heat = surfacediffusion.vtkFVMHeatFilter()
heat.SetInputConnection(elevation.GetOutputPort())
heat.Update()
data = heat.GetOutput().GetPointData()
assert data.GetArray("ElevationDiffused").GetRange() != data.GetArray("Elevation").GetRange()
print("surfacediffusion", surfacediffusion.__version__, "in", package)
SCRIPT
bin/pip uninstall -q -y surfacediffusion
if bin/python -c "import surfacediffusion" 2>/dev/null; then
  echo "still there after pip uninstall"
  exit 1
fi
