#!/bin/sh
# Usage: debian_package.sh SOURCE FOLDER
# Builds the Debian package in FOLDER with the preset, installs it, uses it from a login shell, and
# purges it. It is installed into a temporary copy of this system (an overlay, which needs root), or,
# if there can be no overlay, into an empty root that has this system's list of packages. The test
# fails if the package cannot be installed either way.
set -eu
source=$1
folder=$2
unset PYTHONPATH LD_LIBRARY_PATH PV_PLUGIN_PATH
export CCACHE_BASEDIR="$folder/build" # see Testing/run-tests.sh
export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1

(cd "$source" && cmake --preset package -B "$folder/build" -D SURFACEDIFFUSION_UNITY_BUILD="${UNITY_BUILD:-OFF}" && cmake --build "$folder/build")
rm -f "$folder"/build/*.deb
(cd "$folder/build" && cpack)
deb=$(ls "$folder"/build/*.deb)

contents=$(dpkg-deb --contents "$deb")
for file in usr/share/doc/surfacediffusion/copyright usr/share/doc/surfacediffusion/changelog.gz \
  usr/lib/python3/dist-packages/vtkSurfaceDiffusion/__init__.py etc/profile.d/surfacediffusion.sh \
  SurfaceDiffusionConfig.cmake plugins/SurfaceDiffusion/SurfaceDiffusion.so; do
  echo "$contents" | grep -q "$file" || { echo "the package has no $file"; exit 1; }
done
if echo "$contents" | grep -v " \./\(etc\|usr\)\?/\|\./$"; then
  echo "the package has files outside /etc and /usr"
  exit 1
fi
dpkg-deb --field "$deb" Depends | grep paraview

copy="$folder/copy"
rm -rf "$copy" && mkdir -p "$copy/upper" "$copy/work" "$copy/root"
cp "$deb" "$copy/package.deb"
cat > "$copy/use.sh" <<'SCRIPT'
set -eu
cd "$(mktemp -d)"
cat > use.py <<'PYTHON'
from paraview.simple import Elevation, FVMHeatFilter, Sphere
heat = FVMHeatFilter(Elevation(Sphere()))
heat.UpdatePipeline()
print("ParaView loads the plugin", heat.PointData["ElevationDiffused"].GetRange())
PYTHON
pvpython use.py
/usr/bin/python3 -c "import vtkSurfaceDiffusion as s; print('Python imports', s.__version__, 'from', s.__file__)"
SCRIPT

# Mounts the overlay $copy/root of this system, in a mount namespace.
cat > "$copy/mount.sh" <<'SCRIPT'
set -eu
copy=$1
if ! mount -t overlay overlay \
  -o "lowerdir=/,upperdir=$copy/upper,workdir=$copy/work" "$copy/root" 2>/dev/null; then
  # An overlay cannot be the upper layer of another one, so the changes are kept in memory.
  mount -t tmpfs tmpfs "$copy/upper"
  mkdir "$copy/upper/upper" "$copy/upper/work"
  mount -t overlay overlay -o \
    "lowerdir=/,upperdir=$copy/upper/upper,workdir=$copy/upper/work" "$copy/root"
fi
mount --bind /dev "$copy/root/dev"
mount -t proc proc "$copy/root/proc"
SCRIPT

install_into_overlay()
{
  # shellcheck disable=SC2016 # expanded by the inner shell
  unshare --mount sh -eu -c '
    copy=$1
    . "$copy/mount.sh"
    cp "$copy/package.deb" "$copy/use.sh" "$copy/root/tmp"
    chroot "$copy/root" dpkg --install /tmp/package.deb
    chroot "$copy/root" env -i HOME=/root PATH=/usr/bin:/bin OMPI_ALLOW_RUN_AS_ROOT=1 \
      OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 bash --login /tmp/use.sh
    chroot "$copy/root" dpkg --purge surfacediffusion
    ! chroot "$copy/root" bash --login -c "/usr/bin/python3 -c \"import vtkSurfaceDiffusion\"" 2>/dev/null
  ' sh "$copy"
}

install_into_root()
{
  root="$copy/root"
  mkdir -p "$root/var/lib/dpkg/info" "$root/var/lib/dpkg/updates"
  cp /var/lib/dpkg/status "$root/var/lib/dpkg" # dependencies are those of this system
  dpkg-query -W -f "$root/var/lib/dpkg/info/\${binary:Package}.list\n" | xargs touch
  as_root=
  if [ "$(id -u)" -ne 0 ]; then
    as_root=fakeroot
    # dpkg asks for programs of /usr/sbin, which is not on a user's path; ldconfig would write to /etc.
    mkdir "$copy/bin"
    printf '#!/bin/sh\n' > "$copy/bin/ldconfig"
    chmod +x "$copy/bin/ldconfig"
    PATH="$copy/bin:$PATH:/usr/sbin:/sbin"
  fi
  dpkg="$as_root dpkg --root=$root --force-script-chrootless --force-not-root --log=$copy/log"
  $dpkg --install "$copy/package.deb"
  # The login script names /usr; here it stands below the root.
  script="$root/etc/profile.d/surfacediffusion.sh"
  sed "s|/usr/lib|$root/usr/lib|g" "$script" > "$copy/profile.sh"
  # shellcheck disable=SC1091
  (. "$copy/profile.sh"
    LD_LIBRARY_PATH=$(dirname "$(find "$root/usr/lib" -name 'libvtkSurfaceDiffusion.so*' | head -n 1)")
    PYTHONPATH="$root/usr/lib/python3/dist-packages"
    export LD_LIBRARY_PATH PYTHONPATH
    sh "$copy/use.sh")
  $dpkg --purge surfacediffusion
  if find "$root" ! -type d ! -path "$root/var/*" | grep .; then
    echo "files are left after the purge"
    exit 1
  fi
}

# shellcheck disable=SC2016
if [ "${SURFACEDIFFUSION_NO_OVERLAY:-}" = "" ] && [ "$(id -u)" -eq 0 ] &&
  unshare --mount sh -eu -c '. "$1/mount.sh"' sh "$copy" 2>/dev/null; then
  rm -rf "$copy/upper" "$copy/work" && mkdir "$copy/upper" "$copy/work"
  install_into_overlay
  echo "installed into an overlay of this system"
else
  install_into_root
  echo "installed into an empty root"
fi
rm -rf "$copy"
