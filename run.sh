#!/usr/bin/env bash
# Installs what is missing, builds, and starts Trocar.
#
#   ./run.sh                   the start screen of the trainer; without a display a demonstration, which leaves
#                              pictures, a film, a recording and a report under out/demonstration
#   ./run.sh build             stops after the build; the program is build/release/trocar
#   ./run.sh modeller [FILE]   the modeller, with what it needs on demand: STEP and IGES files (188 MB the first time)
#   ./run.sh ARGUMENTS...      starts the program with these (./run.sh --help, ./run.sh list, ...)
set -euo pipefail
root=$(cd "$(dirname "$0")" && pwd)
program=$root/build/release/trocar

job=build
[ "${1:-}" = modeller ] && job=modeller
"$root/tools/setup.sh" $job
[ -x "$program" ] || echo "run: building (some minutes the first time)" >&2
"$root/tools/build.sh" trocar

if [ $job = modeller ]; then
  shift
  [ -x "$root/build/release/trocar_cad" ] || (cd "$root" && cmake --preset release >/dev/null)  # the target came with the packages
  "$root/tools/build.sh" trocar_cad
  exec "$program" model "$@"
fi

exercise=gynaecology/sterilisation
if [ $# -gt 0 ]; then
  [ "$1" = build ] && { echo "run: built build/release/trocar" >&2; exit; }
  exec "$program" "$@"
fi
if [ -n "${DISPLAY:-}${WAYLAND_DISPLAY:-}" ]; then
  exec "$program" train
fi

echo "run: no display: demonstration of $exercise" >&2
cd "$root"
out=out/demonstration
rm -rf "$out"
mkdir -p "$out"
status=0
"$program" train "$exercise" --input demo --headless --json --record "$out/sterilisation.rec" \
  --shots "$out/shots" --report "$out/report" >"$out/result.json" || status=$?
if [ $status -gt 1 ]; then  # 1: the goal was not reached, everything else is there
  cat "$out/result.json" >&2
  exit $status
fi
# The left tube is clipped and cut in this part; the whole would take minutes to draw without a graphics card.
"$program" replay "$out/sterilisation.rec" --video "$out/sterilisation.mp4" --from 14 --to 38 >/dev/null ||
  echo "run: no film" >&2
echo
cat "$out/result.json"
echo
echo "pictures:  $out/shots/ ($(find "$out/shots" -name '*.png' | wc -l))"
[ -e "$out/sterilisation.mp4" ] && echo "film:      $out/sterilisation.mp4"
echo "recording: $out/sterilisation.rec  (check it: build/release/trocar replay $out/sterilisation.rec --verify)"
echo "result:    $out/result.json"
echo "report:    $(find "$out/report" -name '*.html' | head -n 1)"
exit $status
