#!/usr/bin/env bash
# Makes the files of a release: tarball, Debian package, sources and their checksums, in build/release-VERSION.
#
#   tools/release.sh VERSION             checks, builds, packs
#   tools/release.sh --check VERSION     only checks: nothing uncommitted, VERSION in CMakeLists.txt, CITATION.cff,
#                                        codemeta.json and the metainfo, a heading of VERSION in CHANGELOG.md
#
# Exit: 0 made, 1 a check failed (each printed), 2 bad arguments.
set -euo pipefail
cd "$(dirname "$0")/.."
only_check=false
[ "${1:-}" = --check ] && { only_check=true; shift; }
version=${1:-}
[[ $version =~ ^[0-9]+\.[0-9]+\.[0-9]+$ ]] || { sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2; }

faults=0
expect() {  # expect MESSAGE COMMAND...
  local message=$1
  shift
  "$@" >/dev/null 2>&1 || { echo "release: $message" >&2; faults=1; }
}
clean() { [ -z "$(git status --porcelain)" ]; }
expect "commit first: the working tree has changes" clean
expect "CMakeLists.txt has another version" grep -qF "project(trocar VERSION $version " CMakeLists.txt
expect "CITATION.cff has another version" grep -qx "version: $version" CITATION.cff
expect "codemeta.json has another version" grep -qF "\"version\": \"$version\"" codemeta.json
expect "packaging/org.trocar.Trocar.metainfo.xml has no release $version" \
  grep -qF "<release version=\"$version\"" packaging/org.trocar.Trocar.metainfo.xml
expect "CHANGELOG.md has no heading with $version" grep -qE "^## .*\b${version//./\\.}\b" CHANGELOG.md
expect "there is a tag v$version already" bash -c "! git rev-parse -q --verify refs/tags/v$version"
[ $faults = 0 ] || exit 1
$only_check && { echo "release: $version can be made"; exit; }

out=build/release-$version
rm -rf "$out"
mkdir -p "$out"
tools/docs.sh
tools/package.sh deb tarball
cp build/package/trocar_"$version"-1_*.deb build/package/trocar-"$version"-linux-*.tar.xz "$out/"
git archive --format=tar --prefix="trocar-$version/" HEAD | xz -9 >"$out/trocar-$version.tar.xz"
(cd "$out" && sha256sum -- * >SHA256SUMS)
echo "release: $out"
cat "$out/SHA256SUMS"
