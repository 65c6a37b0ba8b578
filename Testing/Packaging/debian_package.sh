#!/bin/sh
# Usage: debian_package.sh SOURCE FOLDER
# Builds the Debian package in FOLDER with the preset, installs it into a temporary copy of this
# system, and uses it there from a login shell. The copy needs root and overlay mounts; without them
# the exit code is 77 (skipped).
set -eu
source=$1
folder=$2
unset PYTHONPATH LD_LIBRARY_PATH PV_PLUGIN_PATH

(cd "$source" && cmake --preset package -B "$folder/build" && cmake --build "$folder/build")
rm -f "$folder"/build/*.deb
(cd "$folder/build" && cpack)
deb=$(ls "$folder"/build/*.deb)

contents=$(dpkg-deb --contents "$deb")
for file in usr/share/doc/surfacediffusion/copyright usr/share/doc/surfacediffusion/changelog.gz \
  usr/lib/python3/dist-packages/surfacediffusion/__init__.py etc/profile.d/surfacediffusion.sh \
  SurfaceDiffusionConfig.cmake plugins/SurfaceDiffusion/SurfaceDiffusion.so; do
  echo "$contents" | grep -q "$file" || { echo "the package has no $file"; exit 1; }
done
if echo "$contents" | grep -v " \./\(etc\|usr\)\?/\|\./$"; then
  echo "the package has files outside /etc and /usr"
  exit 1
fi
dpkg-deb --field "$deb" Depends | grep paraview

if [ "$(id -u)" -ne 0 ] || ! unshare --mount true 2>/dev/null; then
  echo "no root: not installed"
  exit 77
fi
copy="$folder/copy"
rm -rf "$copy" && mkdir -p "$copy/upper" "$copy/work" "$copy/root"
cp "$deb" "$copy/package.deb"
cat > "$copy/use.sh" <<'SCRIPT'
set -eu
cd /tmp
cat > use.py <<'PYTHON'
from paraview.simple import Elevation, FVMHeatFilter, Sphere
heat = FVMHeatFilter(Elevation(Sphere()))
heat.UpdatePipeline()
print("ParaView loads the plugin", heat.PointData["ElevationDiffused"].GetRange())
PYTHON
pvpython use.py
/usr/bin/python3 -c "import surfacediffusion as s; print('Python imports', s.__version__, 'from', s.__file__)"
SCRIPT
unshare --mount sh -eu -c '
  copy=$1
  if ! mount -t overlay overlay \
    -o "lowerdir=/,upperdir=$copy/upper,workdir=$copy/work" "$copy/root" 2>/dev/null; then
    # An overlay cannot be the upper layer of another one, so the changes are kept in memory.
    mount -t tmpfs tmpfs "$copy/upper" || exit 77
    mkdir "$copy/upper/upper" "$copy/upper/work"
    mount -t overlay overlay -o \
      "lowerdir=/,upperdir=$copy/upper/upper,workdir=$copy/upper/work" "$copy/root" || exit 77
  fi
  mount --bind /dev "$copy/root/dev"
  mount -t proc proc "$copy/root/proc"
  cp "$copy/package.deb" "$copy/use.sh" "$copy/root/tmp"
  chroot "$copy/root" dpkg --install /tmp/package.deb
  chroot "$copy/root" env -i HOME=/root PATH=/usr/bin:/bin OMPI_ALLOW_RUN_AS_ROOT=1 \
    OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 bash --login /tmp/use.sh
  chroot "$copy/root" dpkg --purge surfacediffusion
  ! chroot "$copy/root" bash --login -c "/usr/bin/python3 -c \"import surfacediffusion\"" 2>/dev/null
' sh "$copy"
rm -rf "$copy"
