#!/bin/bash
# Draws figures 4 to 8 of the paper, deblurring, colours, denoised meshes, edges, stripes and regions on
# scanned surfaces with photographs and on cortices, and a minimal surface: installs the required packages
# (Debian 12), fetches the data, builds the library, draws into build/figures, and prints errors and
# run times.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

python=${PYTHON:-/usr/bin/python3}  # must find the modules of ParaView or VTK
data=build/data

echo "== Packages"
.ci/install-packages demo

echo "== Data"
.ci/fetch-test-data "$data"  # the meshes of CGAL's demos
if [ ! -d "$data/photos" ]; then
  work=$(mktemp -d "$data/fetch.XXXXXX")
  trap 'rm -rf "$work"' EXIT
  "$python" -m pip download --quiet --no-deps --dest "$work" scikit-image==0.24.0 matplotlib==3.8.4
  "$python" -m zipfile -e "$work"/scikit_image-*.whl "$work/wheel"
  "$python" -m zipfile -e "$work"/matplotlib-*.whl "$work/wheel"
  mv "$work/wheel/matplotlib/mpl-data/sample_data/grace_hopper.jpg" "$work/wheel/skimage/data"
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
modules=$(dirname "$(find build/lib -type d -name vtkSurfaceDiffusion -path '*-packages/*' | head -1)")
export PYTHONPATH=$PWD/$modules${PYTHONPATH:+:$PYTHONPATH}
export SURFACEDIFFUSION_MESH_DIR=$PWD/$data/meshes
export SURFACEDIFFUSION_BRAIN_DIR=$PWD/$data/wheels/brains
examples=$PWD/Examples/Python
photos=$PWD/$data/photos
mkdir -p build/figures
cd build/figures
"${display[@]}" "$python" "$examples/paper_figures.py" --meshes "$SURFACEDIFFUSION_MESH_DIR" \
  --photos "$photos" --output .
"${display[@]}" "$python" "$examples/deblurring.py" --meshes "$SURFACEDIFFUSION_MESH_DIR" \
  --photos "$photos" --output .
"${display[@]}" "$python" "$examples/colour_denoising.py" --meshes "$SURFACEDIFFUSION_MESH_DIR" \
  --photos "$photos" --output .
"${display[@]}" "$python" "$examples/deblurring_cortex.py" || [ $? -eq 77 ] # without wb_command
"${display[@]}" "$python" "$examples/cell_data.py"
"${display[@]}" "$python" "$examples/curvature.py"
"${display[@]}" "$python" "$examples/distance.py"
"${display[@]}" "$python" "$examples/harmonic_map.py"
"${display[@]}" "$python" "$examples/interpolation.py"
"${display[@]}" "$python" "$examples/mesh_denoising.py"
"${display[@]}" "$python" "$examples/mumford_shah.py"
"${display[@]}" "$python" "$examples/minimal_surface.py"
"${display[@]}" "$python" "$examples/ramps.py"
"${display[@]}" "$python" "$examples/segmentation.py"
"${display[@]}" "$python" "$examples/tensor_diffusion.py"
"${display[@]}" "$python" "$examples/turing_texture.py"
