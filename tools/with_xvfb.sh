#!/usr/bin/env bash
# Runs a command with a display of its own that nobody sees: tools/with_xvfb.sh [WIDTHxHEIGHT] COMMAND...
# The display number is Xvfb's choice, so several may run at once. Exit: the command's; 77 when Xvfb is missing.
set -euo pipefail
size=1280x800
[[ ${1:-} =~ ^[0-9]+x[0-9]+$ ]] && { size=$1; shift; }
command -v Xvfb >/dev/null || { echo "Xvfb is missing: apt-get install xvfb" >&2; exit 77; }
number=$(mktemp)
Xvfb -displayfd 3 -screen 0 "${size}x24" -nolisten tcp -noreset 3>"$number" 2>/dev/null &
server=$!
trap 'kill $server 2>/dev/null; rm -f "$number"' EXIT
for _ in $(seq 100); do
  [ -s "$number" ] && break
  kill -0 $server 2>/dev/null || { echo "Xvfb does not start" >&2; exit 77; }
  sleep 0.1
done
unset WAYLAND_DISPLAY
DISPLAY=:$(cat "$number") "$@"
