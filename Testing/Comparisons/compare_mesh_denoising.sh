#!/bin/sh
# Installs this package and its peers in mesh denoising, measures them side by side, and writes the
# page MESH_DENOISING.md. Arguments are passed on to compare_mesh_denoising.py, see its --help. Debian
# 12 or later; the folder build/mesh-peers holds everything that is installed from PyPI. Open3D needs
# libusb-1.0-0; a peer that cannot be used is named on the page.
set -eu
cd "$(dirname "$0")/../.."

folder=$PWD/build/mesh-peers
PYTHON=${PYTHON:-python3}
[ -x "$folder/bin/pip" ] || "$PYTHON" -m venv --clear "$folder"
"$folder/bin/pip" install --quiet . vtk==9.7.2
for peer in pymeshlab==2025.7.post1 meshlib==3.1.4.297 open3d==0.20.0; do
  "$folder/bin/pip" install --quiet "$peer" || echo "$peer cannot be installed" >&2
done
exec "$folder/bin/python" Testing/Comparisons/compare_mesh_denoising.py "$@"
