#!/bin/bash
# Figures 4, 5 and 6 of the paper with photographs on scans: installs what it needs (Debian 12),
# fetches the data, builds, draws, and prints what it took. Arguments go on to
# Examples/Python/paper_figures.py, see its --help.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

python=${PYTHON:-/usr/bin/python3}  # one that finds ParaView's or VTK's modules
data=build/data

echo "== Packages"
.ci/install-packages demo

echo "== Data"
.ci/fetch-test-data "$data"  # the meshes of CGAL's demos
if [ ! -d "$data/photos" ]; then
  work=$(mktemp -d "$data/fetch.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  "$python" -m pip download --quiet --no-deps --dest "$work" scikit-image==0.24.0
  "$python" -m zipfile -e "$work"/scikit_image-*.whl "$work/wheel"
  mv "$work/wheel/skimage/data" "$data/photos"
fi

echo "== Build"
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DPython3_EXECUTABLE="$python"
cmake --build build

echo "== Figures"
display=()
if [ -z "${DISPLAY:-}" ]; then
  display=(xvfb-run -a -s "-screen 0 1024x768x24 -noreset")
fi
modules=$(dirname "$(find build/lib -type d -name surfacediffusion -path '*-packages/*' | head -1)")
PYTHONPATH=$PWD/$modules${PYTHONPATH:+:$PYTHONPATH} "${display[@]}" "$python" \
  Examples/Python/paper_figures.py --meshes "$data/meshes" --photos "$data/photos" \
  --output build/figures "$@"
