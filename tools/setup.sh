#!/usr/bin/env bash
# Installs the Debian 12 packages that a job needs and that are not there, as root or through sudo.
#
#   tools/setup.sh build            what ./run.sh needs: compiler, libraries of the program
#   tools/setup.sh modeller         the same and what reads STEP and IGES
#   tools/setup.sh test             the same and what ./test.sh needs
#   tools/setup.sh soak             the same and a second compiler
#   tools/setup.sh docs             what tools/docs.sh needs: the site and the API
#   tools/setup.sh dev              the same and formatter, linter, LLVM's standard library
#   tools/setup.sh package          the same as build and what tools/package.sh needs
#   tools/setup.sh try-package      what tools/try_package.sh needs
#   tools/setup.sh --list JOB       only names the packages
#
# Does nothing, quickly, when everything is there. Exit 3: something is missing and cannot be installed from here.
set -euo pipefail

build=(
  g++                  # the compiler (12)
  cmake ninja-build    # the build
  ccache               # makes the second build quick
  pkg-config           # finds Dear ImGui
  libfmt-dev libspdlog-dev  # text and log
  libxxhash-dev        # hashes of states and recordings
  nlohmann-json3-dev   # scene files
  libcli11-dev         # the command line
  libegl-dev libepoxy-dev    # OpenGL, without a window too
  libgl1-mesa-dri      # and its driver, for machines without graphics card as well
  libglfw3-dev libimgui-dev  # the window and its panels
  libstb-dev           # PNG
  zlib1g-dev           # volumes of voxels packed with gzip (NRRD, NIfTI, MetaImage)
  libgdcm-dev          # JPEG in DICOM scans; without it these are refused, all else works
  libsqlite3-dev       # the session store: attempts and results
  libsodium-dev        # seals what the programs of a team say to each other
  libopenal-dev        # sounds of the window
  fonts-dejavu-core    # its text
  ffmpeg               # films: a program of its own, called for --video and by the player
)
modeller=(
  libocct-data-exchange-dev  # STEP and IGES in the modeller; 188 MB with what it needs, so on demand
)
test=(
  libgtest-dev         # tests
  libbenchmark-dev     # benchmarks
  libbullet-dev        # what the spring kernel is measured beside
  python3              # the checks in tools/
  python3-numpy python3-scipy  # metrics and frames for research, computed a second time, independently
  python3-pil          # pictures in these
  binutils             # objdump, nm: the step's machine code
  git                  # the release script is tried in a repository
  xvfb xdotool         # drives the real window without a display
)
soak=(
  clang                # the same bits from a second compiler
  libclang-rt-14-dev   # its fuzzer and sanitizers
  libopenmpi-dev openmpi-bin  # tolerance studies on many machines; 53 MB, so not with the quick tests
)
dev=(
  clang-format clang-tidy libc++-dev libc++abi-dev
  libfcl-dev           # what the surface search is measured beside, with Bullet
  libsuitesparse-dev libopenblas-dev  # what condensing an organ is measured beside: CHOLMOD, LAPACK
)
docs=(
  python3              # the checks of links and commands
  mkdocs mkdocs-material  # the documentation as a site, and its theme (works offline)
  doxygen              # the API below reference/api
)

package=(
  dpkg-dev             # the package, and what it depends on (dpkg-shlibdeps)
  lintian              # checks it
  desktop-file-utils appstream  # check the desktop's files
  patchelf             # the tarball's program finds its libraries beside it
  binutils xz-utils    # the oldest glibc; the tarball
)
try_package=(
  debootstrap          # bare systems in which packages are tried
  xvfb ffmpeg python3  # a screen for them, and pictures of it
)

list_only=false
[ "${1:-}" = --list ] && { list_only=true; shift; }
case "${1:-build}" in
  build) wanted=("${build[@]}") ;;
  modeller) wanted=("${build[@]}" "${modeller[@]}") ;;
  test) wanted=("${build[@]}" "${test[@]}") ;;
  soak) wanted=("${build[@]}" "${test[@]}" "${soak[@]}") ;;
  docs) wanted=("${docs[@]}") ;;
  dev) wanted=("${build[@]}" "${test[@]}" "${soak[@]}" "${dev[@]}") ;;
  package) wanted=("${build[@]}" "${package[@]}") ;;
  try-package) wanted=("${try_package[@]}") ;;
  *) sed -n '2,14s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
if $list_only; then
  printf '%s\n' "${wanted[@]}"
  exit
fi

if ! command -v dpkg-query >/dev/null; then
  echo "setup: this is not a Debian system; make sure that these (or their like) are there: ${wanted[*]}" >&2
  exit 0
fi
# An installed package that Provides a wanted name counts too.
installed=$(dpkg-query -W -f='${db:Status-Abbrev} ${Package} ${Provides}\n' | sed -n 's/^ii  *//p' \
            | sed 's/([^)]*)//g; s/[, ][, ]*/\n/g')
missing=()
for package in "${wanted[@]}"; do
  grep -qxF -- "$package" <<<"$installed" || missing+=("$package")
done
[ ${#missing[@]} -eq 0 ] && exit 0

as_root=()
if [ "$(id -u)" != 0 ]; then
  if command -v sudo >/dev/null; then
    as_root=(sudo)
  else
    echo "setup: missing packages, and this is neither root nor is there sudo. As root, run:" >&2
    echo "  apt-get update && apt-get install --no-install-recommends ${missing[*]}" >&2
    exit 3
  fi
fi
echo "setup: installing with ${as_root[*]:+${as_root[*]} }apt-get (for: ${1:-build}; reasons in tools/setup.sh):" >&2
echo "  ${missing[*]}" >&2
log=$(mktemp)
trap 'rm -f "$log"' EXIT
quietly() {  # shows what apt said only when it failed
  "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive "$@" >"$log" 2>&1 || {
    tail -n 15 "$log" >&2
    echo "setup: '$*' failed" >&2
    exit 3
  }
}
quietly apt-get update -q
quietly apt-get install -q -y --no-install-recommends "${missing[@]}"
echo "setup: done" >&2
