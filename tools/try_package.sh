#!/usr/bin/env bash
# Tries the packages that tools/package.sh made, as a user's machine would meet them: in a bare system of its own.
#
#   tools/try_package.sh deb [ROOT]             Debian 12: install, start screen, demonstration, modeller, purge
#   tools/try_package.sh tarball [ROOT] [SUITE] another release of Debian (default trixie): the same without installing
#
# The system is made by debootstrap in ROOT.SUITE (default /var/tmp/try-package), and kept for the next time. Pictures of
# the windows go to build/package/pictures. Needs root and the network.
# Exit: 0 all went well, 1 something failed, 2 bad arguments, 3 no root, 77 the mirror has no such release.
set -euo pipefail
cd "$(dirname "$0")/.."
kind=${1:-}
case "$kind" in deb) suite=bookworm ;; tarball) suite=${3:-trixie} ;; *) sed -n '2,10s/^# \{0,1\}//p' "$0" >&2; exit 2 ;; esac
[ "$(id -u)" = 0 ] || { echo "try: this needs root" >&2; exit 3; }
tools/setup.sh try-package
base=${2:-/var/tmp/try-package}.$suite.base
root=${2:-/var/tmp/try-package}.$suite
out=$PWD/build/package
pictures=$out/pictures
mkdir -p "$pictures"

mirror=$(awk '/^URIs:/{print $2; exit} /^deb /{for(i=2;i<=NF;i++) if($i ~ /^https?:/){print $i; exit}}' \
  /etc/apt/sources.list.d/*.sources /etc/apt/sources.list 2>/dev/null | head -1)
if [ ! -e "$base/.done" ]; then
  rm -rf --one-file-system "$base"
  script=()
  [ -e "/usr/share/debootstrap/scripts/$suite" ] || script=(/usr/share/debootstrap/scripts/sid)
  debootstrap --variant=minbase "$suite" "$base" "$mirror" "${script[@]}" >"$out/debootstrap.log" 2>&1 ||
    { tail -3 "$out/debootstrap.log" >&2; exit 77; }
  touch "$base/.done"
fi

server=
finish() {
  [ -n "$server" ] && kill "$server" 2>/dev/null
  for m in tmp/.X11-unix proc sys dev/pts dev; do mountpoint -q "$root/$m" && umount -l "$root/$m"; done
  return 0
}
trap finish EXIT
finish
rm -rf --one-file-system "$root"
cp -a "$base" "$root"
printf 'deb %s %s main\n' "$mirror" "$suite" >"$root/etc/apt/sources.list"
[ -d /etc/apt/apt.conf.d ] && cp -a /etc/apt/apt.conf.d/. "$root/etc/apt/apt.conf.d/"
cp -L /etc/resolv.conf /etc/hosts "$root/etc/" 2>/dev/null || true
mkdir -p "$root/etc/ssl" && cp -aL /etc/ssl/certs "$root/etc/ssl/" 2>/dev/null || true
mount --bind /dev "$root/dev"
mount -t devpts devpts "$root/dev/pts" 2>/dev/null || true
mount -t proc proc "$root/proc"
mount -t sysfs sys "$root/sys" 2>/dev/null || true

inside() {  # inside COMMAND...: in the bare system, as root
  env -i HOME=/root PATH=/usr/local/sbin:/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin LANG=C.UTF-8 DISPLAY="${shown:-}" \
    DEBIAN_FRONTEND=noninteractive $(env | grep -iE '^(https?|no)_proxy=' || true) chroot "$root" /bin/bash -c "$*"
}
fail() { echo "try: FAILED: $*" >&2; exit 1; }
files() { (cd "$root" && find . -xdev \( -path ./proc -o -path ./sys -o -path ./dev -o -path ./tmp -o -path ./var/lib/apt \
  -o -path ./var/cache -o -path ./var/log -o -path ./run \) -prune -o -print | LC_ALL=C sort); }

colours_of() {
  ffmpeg -loglevel quiet -i "$1" -f rawvideo -pix_fmt rgb24 - |
    python3 -c 'import sys; d = sys.stdin.buffer.read(); print(len({d[i:i + 3] for i in range(0, len(d), 3)}))' || echo 0
}

# A window on a virtual screen outside, so that the bare system stays bare.
screen() {  # screen NAME SECONDS COMMAND...: starts it, waits until the window shows something, keeps a picture
  local name=$1 most=$2 begun=$SECONDS colours=0 child
  shift 2
  if [ -z "$server" ]; then
    local number=95
    while [ -e "/tmp/.X11-unix/X$number" ]; do number=$((number + 1)); done
    shown=:$number
    Xvfb $shown -screen 0 1280x720x24 -nolisten tcp >/dev/null 2>&1 &
    server=$!
    sleep 2
    mkdir -p "$root/tmp/.X11-unix" && mount --bind /tmp/.X11-unix "$root/tmp/.X11-unix"
  fi
  inside "$*" >"$out/$name.out" 2>&1 &
  child=$!
  while [ $((SECONDS - begun)) -lt "$most" ] && [ "$colours" -lt 30 ] && kill -0 $child 2>/dev/null; do
    sleep 2
    ffmpeg -loglevel quiet -f x11grab -video_size 1280x720 -i "$shown" -frames:v 1 -y "$pictures/$name.png" || true
    colours=$(colours_of "$pictures/$name.png")
  done
  echo "try: $name: $colours colours after $((SECONDS - begun)) s"
  pkill -P $child 2>/dev/null
  kill $child 2>/dev/null
  wait $child 2>/dev/null || true
  [ "$colours" -ge 30 ] || { cat "$out/$name.out" >&2; fail "$name shows nothing after $most s"; }
}

use() {  # use PROGRAM: what one does first
  inside "$1 --version" || fail "the program does not start"
  inside "$1 list exercises --names" >"$out/list.txt" || fail "no list of exercises"
  grep -q gynaecology/sterilisation "$out/list.txt" || fail "the shipped exercises were not found"
  inside "$1 train basics/camera-0 --input demo --headless --record /tmp/a.rec --shots /tmp/shots --trainee Try" ||
    fail "the demonstration"
  inside "$1 replay /tmp/a.rec --verify" || fail "the recording does not verify"
  screen start-screen-$suite 60 "$1 train"
  screen modeller-$suite 60 "$1 model"
}

if [ "$kind" = deb ]; then
  package=$(ls -t "$out"/trocar_*.deb | head -1)
  cp "$package" "$root/root/"
  inside "apt-get update -qq" || fail "apt-get update"
  inside "apt-get install -qq -y --no-install-recommends libglib2.0-0 >/dev/null" || fail "a package outside"
  files >"$out/before.txt"
  begun=$SECONDS
  inside "apt-get install -qq -y --no-install-recommends /root/$(basename "$package") >/dev/null" || fail "apt-get install"
  echo "try: installed in $((SECONDS - begun)) s"
  use trocar
  inside "apt-get purge -qq -y trocar >/dev/null && apt-get autoremove -qq -y --purge >/dev/null" || fail "purge"
  files | grep -i trocar | grep -vE '^\./root/(trocar_.*\.deb|\.local|\.cache)' >"$out/left.txt" && { cat "$out/left.txt" >&2; fail "purge left files"; }
  echo "try: purge left nothing"
else
  archive=$(ls -t "$out"/trocar-*.tar.xz | head -1)
  inside "apt-get update -qq && apt-get install -qq -y --no-install-recommends libgl1 libegl1 libx11-6 libxcursor1 libxi6 \
    libxinerama1 libxrandr2 libgl1-mesa-dri libstdc++6 >/dev/null" || fail "what a desktop has"
  mkdir -p "$root/opt/any where" && tar -xJf "$archive" -C "$root/opt/any where"
  program="'/opt/any where/$(basename "$archive" .tar.xz)/bin/trocar'"
  inside "ldd $program" | grep 'not found' && fail "libraries are missing"
  use "$program"
fi
echo "try: $kind on $suite: all went well"
