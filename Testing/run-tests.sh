#!/bin/sh
# Usage: run-tests.sh [versions | checks]
# Installs what is needed, builds, and runs every test. The last lines are ctest's summary, with the
# seconds per label, times the processors that a test asks for. In CI (CI is set) it is an error if test
# data are missing, if a test is skipped that may_be_skipped.txt does not list, and if one of
# must_run.txt is missing.
# With "versions" it fetches other versions of VTK, and runs the tests that build the project with
# each of them, and with pip, instead: these take as long as all others. With "checks" it runs these,
# all sanitizers, the fuzzer and the long tests: see run-checks.sh.
set -eu
cd "$(dirname "$0")/.."
preset=${1:-test}
[ "$preset" != checks ] || exec Testing/run-checks.sh

.ci/install-packages
data="$PWD/build/data"
if ! .ci/fetch-test-data "$data" "$@"; then
  [ -z "${CI:-}" ] || exit 1
  echo "no test data: tests that need it are skipped or left out" >&2
fi
folder()
{
  [ ! -d "$data/$1" ] || echo "$data/$1"
}

# Some tests build the project once more: what does not differ is not compiled again. Paths below the
# build folder are relative in the cache, so that they do not differ either.
export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
export CCACHE_BASEDIR="$PWD/build" CCACHE_DEPEND=1
unity=OFF
[ -z "${CI:-}" ] || unity=ON # everything is compiled, and once

cmake --preset build -D SURFACEDIFFUSION_UNITY_BUILD="$unity" \
  -D SURFACEDIFFUSION_REQUIRE_TEST_DATA="${CI:+ON}" \
  -D SURFACEDIFFUSION_MESH_DIR="$(folder meshes)" \
  -D SURFACEDIFFUSION_VTK91_PREFIX="$(folder vtk91)" \
  -D SURFACEDIFFUSION_CURRENT_VTK_DIR="$(folder vtk-current)" \
  -D SURFACEDIFFUSION_WHEEL_DIR="$(folder wheels)"
cmake --build --preset build

# One display for all tests; -noreset: it outlives its first client.
results="$PWD/build/tests.xml"
status=0
xvfb-run -a -s "-screen 0 1024x768x24 -noreset" ctest --preset "$preset" -j2 \
  --output-junit "$results" --test-output-size-passed 1000000 || status=$?
if [ -n "${CI:-}" ]; then
  ctest --preset "$preset" --show-only=json-v1 > "$PWD/build/tests.json"
  /usr/bin/python3 Testing/check_skips.py "$results" "$PWD/build/tests.json" \
    Testing/may_be_skipped.txt Testing/must_run.txt || status=1
fi
exit "$status"
