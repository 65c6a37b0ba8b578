#!/bin/bash
# Demonstrates the library on real surfaces: installs the required packages (Debian 12), fetches the
# data, builds the library and draws one picture from each filter and four applications of linear
# diffusion. Arguments are passed on to Examples/Python/demo.py, see its --help.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

python=${PYTHON:-/usr/bin/python3}  # must find the modules of ParaView or VTK
data=build/demo-data

download()
{
  if ! apt-get -q download "$@"; then # the package lists may be missing
    sudo=
    [ "$(id -u)" -eq 0 ] || sudo=sudo
    $sudo apt-get -q update
    apt-get -q download "$@"
  fi
}

echo "== Packages"
.ci/install-packages demo

echo "== Data"
mkdir -p "$data"
work=$(mktemp -d "$data/fetch.XXXXXX")
trap 'rm -rf "$work"' EXIT

# fsaverage5, an average human cortex (Fischl et al. 1999), from the nilearn package.
if [ ! -d "$data/fsaverage5" ]; then
  "$python" -m pip download --quiet --no-deps --dest "$work" nilearn==0.14.1
  "$python" -m zipfile -e "$work"/nilearn-*.whl "$work/nilearn"
  mv "$work/nilearn/nilearn/datasets/data/fsaverage5" "$data"
fi

# A scanned bunny (Stanford) and a bear, from Debian's package of CGAL demos.
if [ ! -f "$data/bear.off" ]; then
  (cd "$work" && download libcgal-demo)
  dpkg-deb --extract "$work"/libcgal-demo_*.deb "$work/cgal"
  tar -xzf "$work/cgal/usr/share/doc/libcgal-dev/data.tar.gz" -C "$work" \
    data/meshes/bunny00.off data/meshes/bear.off
  mv "$work/data/meshes/bunny00.off" "$work/data/meshes/bear.off" "$data"
fi

echo "== Build"
cmake -S . -B build -G Ninja -DCMAKE_BUILD_TYPE=Release -DPython3_EXECUTABLE="$python"
cmake --build build

echo "== Demo"
display=()
if [ -z "${DISPLAY:-}" ]; then
  display=(xvfb-run -a -s "-screen 0 1024x768x24 -noreset")
fi
modules=$(dirname "$(find build/lib -type d -name vtkSurfaceDiffusion -path '*-packages/*' | head -1)")
export PYTHONPATH=$PWD/$modules${PYTHONPATH:+:$PYTHONPATH}
mkdir -p build/demo
(cd build/demo && "${display[@]}" "$python" ../../Examples/Python/overview.py \
  "../../$data/bear.off")
echo "Picture: build/demo/overview.png"
"${display[@]}" "$python" Examples/Python/demo.py --cortex "$data/fsaverage5" --mesh "$data/bunny00.off" \
  --output build/demo "$@"
