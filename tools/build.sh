#!/usr/bin/env bash
# Configures the release preset where needed and builds: tools/build.sh [--tests] [TARGET...]
# Options once chosen in build/release stay; --tests switches the tests and benchmarks on.
set -euo pipefail
cd "$(dirname "$0")/.."
dir=build/release
configure() { cmake --preset release "$@" >"$dir.log" 2>&1 || { cat "$dir.log" >&2; exit 3; }; }
mkdir -p build
if [ "${1:-}" = --tests ]; then
  shift
  grep -qs '^TROCAR_TESTS:BOOL=ON' $dir/CMakeCache.txt && grep -qs '^TROCAR_BENCH:BOOL=ON' $dir/CMakeCache.txt ||
    configure -DTROCAR_TESTS=ON -DTROCAR_BENCH=ON
elif [ ! -f $dir/build.ninja ]; then
  configure -DTROCAR_TESTS=OFF -DTROCAR_BENCH=OFF
fi
if [ -t 2 ]; then
  cmake --build $dir ${1:+--target "$@"} >&2
else  # a log wants no 300 lines of progress: only what failed
  cmake --build $dir ${1:+--target "$@"} >"$dir.log" 2>&1 || { cat "$dir.log" >&2; exit 1; }
fi
