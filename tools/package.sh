#!/usr/bin/env bash
# Makes packages of the program with scenes, manual pages, completion, icon and documentation:
#
#   tools/package.sh deb        build/package/trocar_VERSION-1_ARCH.deb for Debian 12, checked by lintian
#   tools/package.sh tarball    build/package/trocar-VERSION-linux-ARCH.tar.xz with its libraries, for other distributions
#   tools/package.sh deb tarball
#
# TROCAR_MAINTAINER is the "Name <address>" that the package carries.
# The documentation's site is included where tools/docs.sh has built it. tools/try_package.sh tries the results.
# Exit: 0 made, 1 lintian found a fault, 2 bad arguments, 3 a package that this needs is missing.
set -euo pipefail
cd "$(dirname "$0")/.."
[ $# -gt 0 ] || { sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2; }
for kind in "$@"; do
  case "$kind" in deb | tarball) ;; *) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2 ;; esac
done
tools/setup.sh package

out=$PWD/build/package
version=$(sed -n 's/^project(trocar VERSION \([0-9.]*\).*/\1/p' CMakeLists.txt)
arch=$(dpkg --print-architecture)
date=$(git log -1 --format=%cD 2>/dev/null || date -R)
export SOURCE_DATE_EPOCH=${SOURCE_DATE_EPOCH:-$(date -d "$date" +%s)}

build() {  # into $out/root/usr
  mkdir -p "$out"
  cmake --preset release -B "$out/build" -DCMAKE_INSTALL_PREFIX=/usr -DTROCAR_PACKAGE=ON -DTROCAR_TESTS=OFF \
    -DTROCAR_BENCH=OFF >"$out/build.log" 2>&1 || { cat "$out/build.log" >&2; exit 3; }
  cmake --build "$out/build" --target trocar >"$out/build.log" 2>&1 || { cat "$out/build.log" >&2; exit 1; }
  rm -rf "$out/root"
  DESTDIR=$out/root cmake --install "$out/build" --strip --component Unspecified >"$out/install.log" ||
    { cat "$out/install.log" >&2; exit 1; }
  if [ -d build/docs/site ]; then
    mkdir -p "$out/root/usr/share/doc/trocar"
    cp -r build/docs/site "$out/root/usr/share/doc/trocar/html"
  fi
  find "$out/root" -type d -exec chmod 755 {} +
  find "$out/root" -type f -exec chmod go-w {} +
}

# Dependencies that the linker knows, and what the program loads or starts while it runs.
dependencies() {
  local work=$out/shlibs
  rm -rf "$work" && mkdir -p "$work/debian"
  printf 'Source: trocar\n\nPackage: trocar\nArchitecture: any\n' >"$work/debian/control"
  (cd "$work" && dpkg-shlibdeps -O -e"$out/root/usr/bin/trocar" 2>/dev/null) | sed -n 's/^shlibs:Depends=//p'
}

deb() {
  local root=$out/deb doc=$out/deb/usr/share/doc/trocar file=$out/trocar_$version-1_$arch.deb
  rm -rf "$root" && cp -a "$out/root" "$root"
  rm -f "$doc/LICENSE"  # it is in /usr/share/common-licenses
  install -m 644 packaging/copyright "$doc/copyright"
  install -D -m 644 packaging/lintian-overrides "$root/usr/share/lintian/overrides/trocar"
  gzip -9n <CHANGELOG.md >"$doc/changelog.gz"
  printf 'trocar (%s-1) stable; urgency=medium\n\n  * Version %s: see changelog.gz.\n\n -- %s  %s\n' "$version" "$version" \
    "$maintainer" "$date" | gzip -9n >"$doc/changelog.Debian.gz"
  gzip -9n "$root"/usr/share/man/man1/*.1
  mkdir -p "$root/DEBIAN"
  cat >"$root/DEBIAN/control" <<CONTROL
Package: trocar
Version: $version-1
Architecture: $arch
Maintainer: $maintainer
Installed-Size: $(du -k -s --exclude=DEBIAN "$root" | cut -f1)
Depends: $(dependencies), fonts-dejavu-core, libegl1, libgl1
Recommends: ffmpeg
Section: science
Priority: optional
Description: trainer for endoscopic surgery
 Trocar is a real-time trainer for endoscopic surgery.  Organs deform,
 bleed, tear and are cut; every exercise is scored.
 .
 It has basic skills, suturing and operations, demonstrations, recordings
 and reports, and a modeller for organs, also from CT and MR scans.  Mouse,
 keyboard, gamepad, instrument boxes, trackers and haptic devices control
 the instruments.  ffmpeg is used to make films.
CONTROL
  (cd "$root" && find usr -type f -printf '%P\n' | LC_ALL=C sort | sed 's|^|usr/|' | xargs -d '\n' md5sum >DEBIAN/md5sums)
  dpkg-deb --root-owner-group -Zxz --build "$root" "$file" >/dev/null
  lintian --allow-root --fail-on error,warning "$file" || { echo "package: lintian found faults" >&2; exit 1; }
  echo "$file"
}

# The libraries that go along: all but glibc, the compiler's, and those that belong to the machine's display.
bundled() {
  ldd "$1" | awk '$3 ~ /^\// {print $3}' |
    grep -vE '/(ld-linux.*|lib(c|m|dl|rt|pthread|resolv|stdc\+\+|gcc_s|GL|EGL|GLX|GLdispatch|OpenGL|X11|xcb|Xau|Xdmcp))\.so'
}

# The newest glibc that one of the files asks for: the oldest one on which they run.
oldest_glibc() { objdump -T "$@" 2>/dev/null | grep -oE 'GLIBC_[0-9.]+' | sort -uV | tail -1 | sed 's/GLIBC_//'; }

tarball() {
  local name=trocar-$version-linux-$(uname -m)
  local root=$out/$name library
  rm -rf "$root" && cp -a "$out/root/usr" "$root"
  mkdir -p "$root/lib" "$root/share/trocar/fonts"
  for library in $(bundled "$root/bin/trocar"); do cp -L "$library" "$root/lib/"; done
  cp /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf /usr/share/fonts/truetype/dejavu/DejaVuSans-Bold.ttf \
    "$root/share/trocar/fonts/"
  patchelf --force-rpath --set-rpath '$ORIGIN/../lib' "$root/bin/trocar"
  copyrights "$root"
  local glibc
  glibc=$(oldest_glibc "$root/bin/trocar" "$root"/lib/*)
  cat >"$root/README" <<README
Trocar $version: a trainer for endoscopic surgery

  bin/trocar          the start screen
  bin/trocar --help   all commands

This folder can lie anywhere. It needs glibc $glibc or newer, libstdc++ of gcc 12 or newer, and for windows and
pictures libGL, libEGL and libX11 with a driver (on Debian: libgl1 libegl1 libx11-6). ffmpeg is used to make films.
share/doc/trocar/libraries holds the licences of the libraries in lib/.
README
  tar --sort=name --owner=0 --group=0 --numeric-owner --mtime="@$SOURCE_DATE_EPOCH" -C "$out" -cJf "$out/$name.tar.xz" "$name"
  echo "$out/$name.tar.xz (glibc $glibc or newer)"
}

copyrights() {  # of the libraries that go along
  local library package
  mkdir -p "$1/share/doc/trocar/libraries"
  for library in $(bundled "$1/bin/trocar") /usr/share/fonts/truetype/dejavu/DejaVuSans.ttf; do
    package=$(dpkg -S "$(readlink -f "$library")" "$library" 2>/dev/null | head -1 | cut -d: -f1 || true)
    [ -z "$package" ] || cp -L "/usr/share/doc/$package/copyright" "$1/share/doc/trocar/libraries/$package.txt"
  done
}

maintainer=${TROCAR_MAINTAINER:-The Trocar authors <trocar@localhost.localdomain>}
build
for kind in "$@"; do $kind; done
