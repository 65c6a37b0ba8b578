#!/bin/sh
# Usage: pip_install.sh SOURCE FOLDER [WHEELS]
# Runs "pip install SOURCE" in a new virtual environment in FOLDER, without a network, and checks the
# installed module, also with another VTK than it was built for, and beside the package for numpy, whose
# wheel is in the folder WHEELS. Build dependencies come from
# SURFACEDIFFUSION_WHEEL_DIR; without it the exit code is 77 (skipped).
set -eu
source=$1
folder=$2
if [ -z "${SURFACEDIFFUSION_WHEEL_DIR:-}" ]; then
  echo "SURFACEDIFFUSION_WHEEL_DIR is not set"
  exit 77
fi
unset PYTHONPATH LD_LIBRARY_PATH
export CCACHE_BASEDIR="$folder/build" # see Testing/run-tests.sh
export CC="${CC:-cc}" CXX="${CXX:-c++}" # the compilers of CMake, not those of Python

rm -rf "$folder"
"${PYTHON:-/usr/bin/python3}" -m venv --system-site-packages "$folder"
PIP_CONFIG_FILE=/dev/null "$folder/bin/pip" install --config-settings=build-dir="$folder/build" \
  --config-settings=cmake.define.SURFACEDIFFUSION_WARNINGS_AS_ERRORS=ON \
  --config-settings=cmake.define.SURFACEDIFFUSION_UNITY_BUILD="${UNITY_BUILD:-OFF}" \
  --no-index --find-links "$SURFACEDIFFUSION_WHEEL_DIR" "$source"
cd "$folder"
bin/python - <<'SCRIPT'
import importlib.metadata
import pathlib
import sys

import vtkSurfaceDiffusion
from vtkmodules.vtkFiltersCore import vtkElevationFilter
from vtkmodules.vtkFiltersSources import vtkSphereSource

package = pathlib.Path(vtkSurfaceDiffusion.__file__).parent
assert pathlib.Path(sys.prefix) in package.parents, package
assert importlib.metadata.version("vtk-surfacediffusion") == vtkSurfaceDiffusion.__version__
assert (package / "vtkSurfaceDiffusion.pyi").exists() and (package / "py.typed").exists()

sphere = vtkSphereSource()
elevation = vtkElevationFilter()
elevation.SetInputConnection(sphere.GetOutputPort())
heat = vtkSurfaceDiffusion.vtkFVMHeatFilter()
heat.SetInputConnection(elevation.GetOutputPort())
heat.Update()
data = heat.GetOutput().GetPointData()
assert data.GetArray("ElevationDiffused").GetRange() != data.GetArray("Elevation").GetRange()
print("vtkSurfaceDiffusion", vtkSurfaceDiffusion.__version__, "in", package)
SCRIPT
# With another VTK the import is one sentence with both versions and the remedy.
bin/python - <<'SCRIPT'
import vtkmodules.vtkCommonCore as core

built_for = core.vtkVersion.GetVTKVersion()


class OtherVersion:
    @staticmethod
    def GetVTKVersion():
        return "9.99.1"


core.vtkVersion = OtherVersion
try:
    import vtkSurfaceDiffusion
except ImportError as error:
    for part in ("VTK " + built_for, "VTK 9.99.1", "pip install"):
        assert part in str(error), (part, str(error))
    print(error)
else:
    raise AssertionError("imported with a foreign VTK")
SCRIPT
if [ -n "${3:-}" ]; then
  PIP_CONFIG_FILE=/dev/null bin/pip install --quiet --no-deps --no-index "$3"/*.whl
  for order in "surfacediffusion, vtkSurfaceDiffusion" "vtkSurfaceDiffusion, surfacediffusion"; do
    bin/python -c "import $order
ball = surfacediffusion.sphere(3)
surfacediffusion.heat(ball, ball.points[:, 2], fwhm=0.5)
vtkSurfaceDiffusion.vtkFVMHeatFilter()"
  done
fi
bin/pip uninstall -q -y vtk-surfacediffusion
if bin/python -c "import vtkSurfaceDiffusion" 2>/dev/null; then
  echo "still there after pip uninstall"
  exit 1
fi
[ -z "${3:-}" ] || bin/python -c "import surfacediffusion" # another distribution
