#!/bin/bash
# Builds the documentation as a site that works from the file system, build/site/html/index.html, with
# packages of Debian (doxygen, xvfb) and PyPI. The first time, it installs them.
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."
site=$PWD/build/site
environment=$site/environment
data=build/data

.ci/install-packages site
if [ ! -e "$environment/complete" ]; then
  "${PYTHON:-python3}" -m venv "$environment"
  "$environment/bin/pip" install --quiet --disable-pip-version-check ".[io,pyvista]" \
    -r Documentation/requirements.txt
  touch "$environment/complete"
fi
.ci/fetch-test-data "$data"
export SURFACEDIFFUSION_MESH_DIR=$PWD/$data/meshes
export SURFACEDIFFUSION_BRAIN_DIR=$PWD/$data/wheels/brains

"$environment/bin/codespell" --ignore-words-list "te,ue,fo,numer" Documentation Web \
  README.md CONTRIBUTING.md RELEASING.md CHANGELOG.md Filters/*.md Examples/FIGURES.md Packaging/README.md Examples/ParaView/GUIDE.md Plugin/README.md
"$environment/bin/python" Documentation/generate.py . "$site/source"
{ cat Documentation/Doxyfile; echo "OUTPUT_DIRECTORY = $site/doxygen"; } > "$site/Doxyfile"
mkdir -p "$site/doxygen"
doxygen "$site/Doxyfile"
cp -r "$site/doxygen/cpp" "$site/source/extra/cpp"
xvfb-run -a -s "-screen 0 1280x1024x24 -noreset" \
  "$environment/bin/sphinx-build" --quiet -W --keep-going -b html "$site/source" "$site/html"
# The page without a server, which the start page leads to
if command -v em++ > /dev/null; then
  cmake --preset page
  cmake --build --preset page
  mkdir -p "$site/html/page"
  cp build/page/*.html build/page/*.js build/page/*.css "$site/html/page"
fi
"$environment/bin/python" Documentation/check_links.py "$site/html"
echo "The site is $site/html/index.html"
