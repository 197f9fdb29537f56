#!/usr/bin/env bash
# Builds the documentation as a site: build/docs/site/index.html, with the API below reference/api.
#
#   tools/docs.sh              checks links, builds the pages (MkDocs, strict) and the API (Doxygen)
#   tools/docs.sh --no-api     without the API (seconds)
#
# Where build/release/trocar is there, every command block of the user pages is checked against its --help, too.
# Exit: 0 built without a warning, 1 a fault (each printed), 3 a package is missing and cannot be installed.
set -euo pipefail
cd "$(dirname "$0")/.."
api=true
case "${1:-}" in
  '') ;;
  --no-api) api=false ;;
  *) sed -n '2,9s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac
tools/setup.sh docs
out=build/docs
mkdir -p "$out"
python3 tools/check_links.py
program=build/release/trocar
if [ -x "$program" ]; then python3 tools/check_commands.py "$program"; fi
python3 tools/docs_pages.py "$out"
rm -rf "$out/site"
export PYTHONWARNINGS=ignore  # of the library of MkDocs, not of ours
if ! mkdocs build --strict -f "$out/mkdocs.yml" >"$out/mkdocs.log" 2>&1; then
  grep -v INFO "$out/mkdocs.log" >&2
  exit 1
fi
if $api; then
  doxygen tools/Doxyfile >"$out/doxygen.out" 2>"$out/doxygen.log" || true
  if [ -s "$out/doxygen.log" ]; then
    head -n 30 "$out/doxygen.log" >&2
    echo "docs: Doxygen found $(wc -l <"$out/doxygen.log") faults: $out/doxygen.log" >&2
    exit 1
  fi
fi
echo "$out/site/index.html"
