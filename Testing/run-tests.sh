#!/bin/sh
# Installs what is needed, builds, and runs every test. The last lines are ctest's summary.
set -eu
cd "$(dirname "$0")/.."

.ci/install-packages
data="$PWD/build/data"
.ci/fetch-test-data "$data" || echo "no test data: tests that need it are skipped or left out" >&2
meshes="$data/meshes"
[ -d "$meshes" ] || meshes=
vtk91="$data/vtk91"
[ -d "$vtk91" ] || vtk91=
wheels="$data/wheels"
[ -d "$wheels" ] || wheels=

# Some tests build the project once more: what does not differ is not compiled again.
export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache

cmake --preset build \
  -D SURFACEDIFFUSION_MESH_DIR="$meshes" \
  -D SURFACEDIFFUSION_VTK91_PREFIX="$vtk91" \
  -D SURFACEDIFFUSION_WHEEL_DIR="$wheels"
cmake --build --preset build

# One display for all tests; -noreset: it outlives its first client.
exec xvfb-run -a -s "-screen 0 1024x768x24 -noreset" ctest --preset test -j2
