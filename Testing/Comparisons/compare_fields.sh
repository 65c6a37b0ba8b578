#!/bin/sh
# Installs this package and its peers in surrogate maps, measures them side by side, and writes the page
# FIELDS.md. Arguments are passed on to compare_fields.py, see its --help. Debian 12 or later; the folder
# build-comparisons holds everything that is installed from PyPI.
set -eu
cd "$(dirname "$0")/../.."

folder=$PWD/build-comparisons
PYTHON=${PYTHON:-python3}
[ -x "$folder/bin/pip" ] || "$PYTHON" -m venv --clear "$folder"
"$folder/bin/pip" install --quiet ".[io,cli]" scipy nilearn==0.14.1 \
  brainsmash==0.11.0 brainspace==0.3.0 neuromodes==0.1.0 gcm-filters==0.5.1
exec "$folder/bin/python" Testing/Comparisons/compare_fields.py "$@"
