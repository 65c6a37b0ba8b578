#!/bin/sh
# Usage: run-checks.sh [CHECK...]
# The checks before a release, which take hours and are not part of run-tests.sh: all tests under the
# sanitizers, ten minutes of fuzzing, clang with libc++, bounds of round-off with other compilers, flags
# and instructions, all meshes, other versions of VTK, wheels for PyPI's vtk, and the site. Without
# arguments all run, also if one fails. Each that passes is entered into Testing/CHECKS.md with its day and its commit.
# Logs are in build/checks. The exit code is 1 if a check has failed.
set -eu
cd "$(dirname "$0")/.."

.ci/install-packages
.ci/install-packages checks
data="$PWD/build/data"
.ci/fetch-test-data "$data" versions
export CMAKE_C_COMPILER_LAUNCHER=ccache CMAKE_CXX_COMPILER_LAUNCHER=ccache
export CCACHE_BASEDIR="$PWD/build" CCACHE_DEPEND=1
mkdir -p build/checks

build()
{
  cmake --preset "$1" -D SURFACEDIFFUSION_REQUIRE_TEST_DATA=ON \
    -D SURFACEDIFFUSION_MESH_DIR="$data/meshes" \
    -D SURFACEDIFFUSION_VTK91_PREFIX="$data/vtk91" \
    -D SURFACEDIFFUSION_CURRENT_VTK_DIR="$data/vtk-current" \
    -D SURFACEDIFFUSION_WHEEL_DIR="$data/wheels"
  cmake --build --preset "$1"
}

# The tests of the core in builds that round otherwise. Each writes how much of every bound it uses.
bounds()
{
  mkdir -p build/checks/bounds
  rm -f build/checks/bounds/*
  for kind in baseline o1 native no-fma no-avx2 clang; do
    flags="-O3"
    compiler=c++
    case $kind in
      o1) flags="-O1" ;;
      native) flags="-O3 -march=native" ;;
      # Eigen refuses AVX512 without FMA.
      no-fma) flags="-O3 -march=native -mno-fma -mno-avx512f" ;;
      no-avx2) flags="-O3 -march=native -mno-avx2 -mno-avx512f" ;;
      clang) compiler=clang++ ;;
    esac
    cmake --preset core -B "build-bounds/$kind" -D CMAKE_CXX_COMPILER="$compiler" \
      -D SURFACEDIFFUSION_UNITY_BUILD=ON -D SURFACEDIFFUSION_WARNINGS_AS_ERRORS=OFF \
      -D CMAKE_CXX_FLAGS_RELEASE="$flags -DNDEBUG" -D SURFACEDIFFUSION_MESH_DIR="$data/meshes" &&
      cmake --build "build-bounds/$kind" --target TestSurfaceDiffusionCore &&
      SURFACEDIFFUSION_BOUND_SHARES="$PWD/build/checks/bounds/$kind" \
        "build-bounds/$kind/bin/TestSurfaceDiffusionCore" --gtest_brief=1 \
        '--gtest_filter=-*AllocationContract*' || return 1 # -O1 leaves temporary objects
  done
  /usr/bin/python3 Testing/bound_shares.py "$PWD" build/checks/bounds/* || return 1
  # Those that numpy and scipy judge, which choose kernels by the processor.
  build build || return 1
  for kernel in Prescott Nehalem Haswell Zen; do
    OPENBLAS_CORETYPE=$kernel ctest --preset test -j2 -R \
      'Numpy.(Test(Coarse|DenoiseMesh|Faces|PartsWithHoles|Shape|Smoothness)|.*WithScipy)$' ||
      return 1
  done
}

run()
{
  case $1 in
    bounds)
      bounds
      return
      ;;
    fuzz)
      build fuzz && mkdir -p build/checks/corpus
      build-fuzz/bin/FuzzSurfaceDiffusionCore -max_total_time=600 -print_final_stats=1 \
        build/checks/corpus
      return
      ;;
    site)
      Documentation/build.sh
      return
      ;;
    libcxx | libcxx-numpy)
      # GoogleTest has texts of the standard library in its interface, so it is built with the same one.
      cmake -S /usr/src/googletest -B build-libcxx/googletest -D CMAKE_BUILD_TYPE=Release \
        -D CMAKE_C_COMPILER=clang -D CMAKE_CXX_COMPILER=clang++ -D CMAKE_CXX_FLAGS=-stdlib=libc++ \
        -D BUILD_GMOCK=OFF -D CMAKE_INSTALL_PREFIX="$PWD/build-libcxx/prefix"
      cmake --build build-libcxx/googletest --target install
      build libcxx
      ;;
    sanitize | sanitize-more) build sanitize ;;
    tsan | tsan-filters | tsan-numpy) build tsan ;;
    *) build build ;;
  esac
  xvfb-run -a -s "-screen 0 1024x768x24 -noreset" ctest --preset "$1" -j2
}

[ $# -gt 0 ] || set -- bounds fuzz libcxx libcxx-numpy sanitize sanitize-more tsan tsan-filters tsan-numpy long versions vtk-wheel site
status=0
for check in "$@"; do
  echo "== $check"
  if (run "$check") > "build/checks/$check.log" 2>&1; then
    /usr/bin/python3 Testing/record_check.py "$check" "build/checks/$check.log"
  else
    tail -n 40 "build/checks/$check.log"
    echo "$check has failed: build/checks/$check.log"
    status=1
  fi
done
exit "$status"
