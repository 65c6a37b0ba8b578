#!/bin/sh
# Usage: wheel.sh SOURCE FOLDER WHEELS
# Makes a source distribution and a wheel of SOURCE, and installs the wheel into a new virtual
# environment without VTK in FOLDER/environment, all without a network. WHEELS has what is needed
# (.ci/fetch-test-data). FOLDER/system gets the wheel, too, with numpy and VTK of the system.
# The wheel is built from SOURCE itself, so that the compiler cache has most of it; the source
# distribution must have the same files. Testing/Packaging/python_versions.sh builds wheels from it.
set -eu
source=$1
folder=$2
wheels=$3
unset PYTHONPATH LD_LIBRARY_PATH
export PIP_CONFIG_FILE=/dev/null PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_NO_INDEX=1
export PIP_FIND_LINKS="$wheels"
export CCACHE_BASEDIR="$folder/build" # see Testing/run-tests.sh
export CC="${CC:-/usr/bin/cc}" CXX="${CXX:-/usr/bin/c++}" # the compilers of CMake, not those of Python
# Of a sanitizer, for Python alone: compilers would be slow with it, and shells do not start.
preload=${PYTHON_PRELOAD:-}
export CMAKE_ARGS="-DSURFACEDIFFUSION_WARNINGS_AS_ERRORS=ON ${CMAKE_ARGS:-} ${preload:+-DSURFACEDIFFUSION_PYTHON_ENVIRONMENT=LD_PRELOAD=$preload}"

rm -rf "$folder/environment" "$folder/dist" "$folder/source"
mkdir -p "$folder/source"
"${PYTHON:-/usr/bin/python3}" -m venv "$folder/environment"
cd "$source"
"$folder/environment/bin/pip" install --quiet scikit-build-core
"$folder/environment/bin/python" -c "
from scikit_build_core.build import build_sdist
print('made', build_sdist('$folder/dist'))"
"$folder/environment/bin/pip" uninstall --quiet --yes scikit-build-core
cd "$folder"
size=$(cat dist/*.tar.gz | wc -c)
if [ "$size" -gt 2000000 ]; then
  echo "the source distribution has $size bytes: it contains more than the package needs"
  exit 1
fi
tar -xzf dist/*.tar.gz -C source --strip-components 1
for path in CMake Filters/Core Filters/Run Python/Extension Python/surfacediffusion \
  Python/CMakeLists.txt Python/make_stubs.py CMakeLists.txt pyproject.toml README.md LICENSE NOTICE; do
  diff -r --exclude=__pycache__ "$source/$path" "source/$path"
done
environment/bin/pip wheel --quiet --no-deps --wheel-dir dist \
  --config-settings=build-dir="$folder/build" "$source"
environment/bin/pip install --quiet dist/*.whl
if environment/bin/python -c "import vtkmodules" 2>/dev/null; then
  echo "there is a VTK in the environment"
  exit 1
fi
LD_PRELOAD="$preload" environment/bin/python -c "
import surfacediffusion as s
print('installed', s.__version__)"
environment/bin/pip install --quiet --no-compile tqdm argcomplete mypy
# For the tests of files and of PyVista, whose VTK is that of PyPI
environment/bin/pip install --quiet --no-compile "surfacediffusion[io,pyvista]" --find-links dist

# The same with other packages for surfaces, which that environment must do without
if [ -d "$wheels/../peers" ]; then
  rm -rf peers
  "${PYTHON:-/usr/bin/python3}" -m venv --without-pip peers
  for site in environment/lib/python*/site-packages; do
    echo "$folder/$site" > "peers/${site#environment/}/environment.pth"
  done
  environment/bin/pip --python peers/bin/python install --quiet --no-compile --no-deps "$wheels"/../peers/*.whl "$wheels"/../brains/nilearn-*.whl
fi

rm -rf system
"${PYTHON:-/usr/bin/python3}" -m venv --without-pip --system-site-packages system
environment/bin/pip --python system/bin/python install --quiet --no-deps --no-compile \
  --find-links "$wheels/.." dist/*.whl pyvista==0.44.2 pooch scooby platformdirs typing_extensions
