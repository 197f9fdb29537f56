#!/usr/bin/env bash
# Feeds the readers of outside input what no person would write: libFuzzer with address and undefined-behaviour
# sanitizers, two targets at a time, each from the corpus that is kept in tests/fuzz/corpus (docs/developers/robustness.md).
#
#   tools/fuzz.sh [-k] [-j JOBS] [SECONDS [TARGET...]]
#       SECONDS  for each target, default 600
#       TARGET   default all: scene compile exercise recording motion display ...
#       -k       keep what was learnt: pack the corpora, minimised, into tests/fuzz/corpus
#       -j       targets at a time, default 2
#
# Builds into build/fuzz (TROCAR_FUZZ_DIR). An input that is a fault is left in build/fuzz/faults/TARGET, with the
# sanitizer's story in build/fuzz/TARGET.log.
# Exit 0: no fault. 1: at least one. 77: clang or its fuzzer library is missing (ctest: skipped).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
keep=false
jobs=2
while getopts kj: option; do
  case $option in
    k) keep=true ;;
    j) jobs=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
seconds=${1:-600}
[ $# -gt 0 ] && shift
build=${TROCAR_FUZZ_DIR:-$root/build/fuzz}
cd "$root"

command -v clang++ >/dev/null || { echo "fuzz: clang++ is missing (tools/setup.sh soak)" >&2; exit 77; }
echo 'extern "C" int LLVMFuzzerTestOneInput(const unsigned char*, unsigned long) { return 0; }' |
  clang++ -fsanitize=fuzzer,address -x c++ - -o /dev/null 2>/dev/null ||
  { echo "fuzz: clang's fuzzer library is missing (tools/setup.sh soak)" >&2; exit 77; }

echo "fuzz: building" >&2
mkdir -p "$build"
{ cmake --preset fuzz -B "$build" && cmake --build "$build" --target fuzz_all; } >"$build/build.log" 2>&1 ||
  { tail -n 40 "$build/build.log" >&2; echo "fuzz: does not build" >&2; exit 1; }
bin=$build/tests/fuzz

mapfile -t lengths < <("$bin/fuzz_seeds" "$build/seeds")  # "TARGET LONGEST"
targets=("$@")
[ ${#targets[@]} -gt 0 ] || targets=("${lengths[@]%% *}")

# Memory and time bounds of one input: a file of some kilobytes must not cost more. The sanitizers multiply both, and
# the time is the wall's: a busy machine needs room.
limits=(-timeout=60 -rss_limit_mb=2048 -malloc_limit_mb=1024)

one() {  # one TARGET LONGEST: fuzzes, then minimises its corpus into corpus.TARGET.least
  local target=$1 longest=$2 corpus=$build/corpora/$1 status=0 dictionary=()
  [ ! -s "$build/seeds/$target.dict" ] || dictionary=(-dict="$build/seeds/$target.dict")
  mkdir -p "$corpus" "$build/faults/$target"
  [ ! -f "tests/fuzz/corpus/$target.tar.xz" ] || tar -xJf "tests/fuzz/corpus/$target.tar.xz" -C "$corpus"
  cp "$build/seeds/$target/"* "$corpus/"
  "$bin/fuzz_$target" -max_total_time="$seconds" -max_len="$longest" "${limits[@]}" -print_final_stats=1 \
    "${dictionary[@]}" -artifact_prefix="$build/faults/$target/" "$corpus" \
    >"$build/$target.log" 2>&1 || status=$?
  echo $status >"$build/$target.status"
  [ $status = 0 ] || return 0
  rm -rf "$build/least/$target"
  mkdir -p "$build/least/$target"
  "$bin/fuzz_$target" -merge=1 "${limits[@]}" "$build/least/$target" "$corpus" >"$build/$target.merge.log" 2>&1 &&
    { rm -rf "$corpus"; cp -r "$build/least/$target" "$corpus"; }
}

pack() {  # pack TARGET: the same bytes for the same files
  mkdir -p tests/fuzz/corpus
  tar -cJf "tests/fuzz/corpus/$1.tar.xz" --sort=name --mtime=@0 --owner=0 --group=0 --numeric-owner --mode=644 \
    -C "$build/least/$1" .
}

for target in "${targets[@]}"; do
  longest=$(printf '%s\n' "${lengths[@]}" | sed -n "s/^$target //p")
  [ -n "$longest" ] || { echo "fuzz: there is no target $target" >&2; exit 2; }
  while [ "$(jobs -rp | wc -l)" -ge "$jobs" ]; do wait -n || true; done
  echo "fuzz: $target for $seconds s" >&2
  one "$target" "$longest" &
done
wait

stat() { sed -n "s/^stat::$2: *//p" "$build/$1.log"; }
failures=0
printf '%-10s %12s %9s %9s %8s %8s  %s\n' target executions coverage features corpus "peak MB" result
for target in "${targets[@]}"; do
  last=$(grep -E '^#[0-9]+.* cov: ' "$build/$target.log" | tail -n 1 || true)
  field() { sed -n "s/.* $1: \([0-9]*\).*/\1/p" <<<"$last"; }
  result=clean
  if [ "$(cat "$build/$target.status")" != 0 ]; then
    result="FAULT: $(grep -m1 -E '^SUMMARY|^[a-z]+: .*' "$build/$target.log" || true)"
    failures=$((failures + 1))
  elif $keep; then
    pack "$target"
  fi
  printf '%-10s %12s %9s %9s %8s %8s  %s\n' "$target" "$(stat "$target" number_of_executed_units)" "$(field cov)" \
    "$(field ft)" "$(ls "$build/corpora/$target" | wc -l)" "$(stat "$target" peak_rss_mb)" "$result"
done
[ $failures = 0 ] || { echo "fuzz: $failures targets with faults: inputs in $build/faults, logs in $build" >&2; exit 1; }
