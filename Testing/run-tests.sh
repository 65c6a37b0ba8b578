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

cmake --preset build \
  -D SURFACEDIFFUSION_MESH_DIR="$meshes" \
  -D SURFACEDIFFUSION_VTK91_PREFIX="$vtk91"
cmake --build --preset build

# One display for all tests; -noreset: it outlives its first client.
exec xvfb-run -a -s "-screen 0 1024x768x24 -noreset" ctest --preset test -j2
