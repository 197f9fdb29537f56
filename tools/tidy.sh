#!/usr/bin/env bash
# clang-tidy (set in .clang-tidy) over our sources, and clang-format's opinion of them.
#
#   tools/tidy.sh [-b BUILD] [FILE...]     default: build/dev (configured when missing) and every file of ours
#
# Exit 0 clean, 1 with findings.
set -euo pipefail
cd "$(dirname "$0")/.."
build=build/dev
[ "${1:-}" = -b ] && { build=$2; shift 2; }
tools/setup.sh dev
[ -f "$build/compile_commands.json" ] || cmake --preset dev >/dev/null

if [ $# -gt 0 ]; then files=("$@"); else mapfile -t files < <(git ls-files 'src/*.cpp' 'app/*.cpp'); fi
mapfile -t laid_out < <(git ls-files '*.hpp' '*.cpp')
status=0
clang-format --dry-run -Werror "${laid_out[@]}" || status=1
printf '%s\n' "${files[@]}" | xargs -P "$(nproc)" -n 4 clang-tidy -p "$build" --quiet \
  --extra-arg-before=-Wno-unknown-warning-option || status=1
exit $status
