#!/bin/sh
# Usage: environment.sh NUMPY FOLDER WHEELS
# Makes a virtual environment FOLDER/environment that also finds the packages of the environment NUMPY,
# and installs Selenium from WHEELS/web into it, without a network.
set -eu
numpy=$1
folder=$2
wheels=$3
unset PYTHONPATH LD_LIBRARY_PATH
rm -rf "$folder/environment"
"$numpy/bin/python" -m venv --without-pip "$folder/environment"
packages=$("$folder/environment/bin/python" -c "import site; print(site.getsitepackages()[0])")
"$numpy/bin/python" -c "import site; print(site.getsitepackages()[0])" > "$packages/numpy.pth"
if [ ! -d "$wheels/web" ]; then
  echo "no wheels in $wheels/web (.ci/fetch-test-data): tests of pages are skipped"
  exit 0
fi
PIP_CONFIG_FILE=/dev/null PIP_DISABLE_PIP_VERSION_CHECK=1 \
  "$numpy/bin/pip" --python "$folder/environment/bin/python" install --quiet --no-index --no-compile \
  --find-links "$wheels/web" --find-links "$wheels/numpy" selenium
