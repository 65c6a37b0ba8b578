#!/bin/sh
# Usage: python_versions.sh FOLDER PYTHON...
# Makes a source distribution, from it a wheel with each interpreter, and runs the tests that need no
# VTK with each wheel in a new virtual environment. It is run by hand, as it takes minutes per
# interpreter and gets what it needs from PyPI:
#   Testing/Packaging/python_versions.sh build-versions python3.9 python3.10 python3.12 python3.13
# SURFACEDIFFUSION_BRAIN_DIR: the folder of the wheels for Testing/Command/TestBrains.py (optional).
set -eu
tests=$(cd "$(dirname "$0")/.." && pwd)
mkdir -p "$1"
folder=$(cd "$1" && pwd)
shift
unset PYTHONPATH LD_LIBRARY_PATH
export PIP_DISABLE_PIP_VERSION_CHECK=1
export CCACHE_BASEDIR="$folder" # see Testing/run-tests.sh
export CC="${CC:-cc}" CXX="${CXX:-c++}" # the compilers of CMake, not those of Python
export CMAKE_ARGS="-DSURFACEDIFFUSION_WARNINGS_AS_ERRORS=ON ${CMAKE_ARGS:-}"

rm -rf "$folder/sdist" "$folder/source"
mkdir "$folder/source"
"$1" -m venv --clear "$folder/tools"
"$folder/tools/bin/pip" install --quiet build
"$folder/tools/bin/python" -m build --sdist --outdir "$folder/sdist" "$tests/.."
tar -xzf "$folder"/sdist/*.tar.gz -C "$folder/source" --strip-components 1

results=
for python in "$@"; do
  version=$("$python" -c "import platform; print(platform.python_version())")
  place="$folder/$version"
  rm -rf "$place"
  "$python" -m venv "$place"
  "$place/bin/pip" wheel --quiet --no-deps --wheel-dir "$place/dist" \
    --config-settings=build-dir="$place/build" "$folder/source"
  "$place/bin/pip" install --quiet "$(echo "$place"/dist/*.whl)[io,cli]" mypy
  passed=0
  failed=
  for script in "$tests"/Numpy/Test*.py "$tests"/Command/Test*.py; do
    name=$(basename "$(dirname "$script")")/$(basename "$script")
    code=0
    (cd "$place" && bin/python "$script") > "$place/log" 2>&1 || code=$?
    case $code in
      0) passed=$((passed + 1)) ;;
      77) ;; # skipped
      *)
        cat "$place/log"
        failed="$failed $name"
        ;;
    esac
  done
  line="$version: $(cd "$place/dist" && echo *.whl), $passed scripts passed${failed:+, failed:$failed}"
  echo "$line"
  results="$results$line
"
done
echo
printf %s "$results"
case $results in
  *failed*) exit 1 ;;
esac
