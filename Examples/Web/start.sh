#!/bin/sh
# Starts the application in the browser. The first time, it installs this library and trame into a
# virtual environment, build/web, and on Debian the compiler that this needs. Arguments are those of
# app.py: see --help.
set -eu
cd "$(dirname "$0")/../.."
if [ ! -e build/web/complete ]; then
  if command -v dpkg-query >/dev/null; then
    .ci/install-packages pip
  fi
  "${PYTHON:-python3}" -m venv build/web
  build/web/bin/pip install --quiet --disable-pip-version-check ".[io]" -r Examples/Web/requirements.txt
  touch build/web/complete
fi
exec build/web/bin/python Examples/Web/app.py "$@"
