#!/usr/bin/env bash
# The same bits from every build: the demonstration's exercise, recorded by programs made with gcc and clang for
# three instruction sets, with one and two threads, every SIMD width, drawn and not drawn; then every recording is
# verified by another build.
#
#   tools/determinism_matrix.sh [-k] [-b BUILDS] [-x EXERCISE] [-i INPUT] [WORKDIR]
#       WORKDIR  default build/matrix; about an hour on two cores without ccache
#       -b       which builds, of g++ and clang++ for x86-64, x86-64-v3 and native: "g++-x86-64 clang++-native";
#                default all six
#       -x       default gynaecology/sterilisation; suturing/double-throw ties thread
#       -i       whose hands: demo, or motion:FILE (default demo)
#       -k       keep the recordings
#
# Exit 0: one hash. 1: they differ, or a recording does not verify. 77: a compiler is missing (ctest: skipped).
set -euo pipefail
root=$(cd "$(dirname "$0")/.." && pwd)
keep=false
input=demo
exercise=gynaecology/sterilisation
wanted=
while getopts kb:x:i: option; do
  case $option in
    k) keep=true ;;
    b) wanted=" $OPTARG " ;;
    x) exercise=$OPTARG ;;
    i) input=$OPTARG ;;
    *) exit 2 ;;
  esac
done
shift $((OPTIND - 1))
work=${1:-$root/build/matrix}
mkdir -p "$work"
cd "$root"

command -v clang++ >/dev/null || { echo "matrix: clang++ is missing (tools/setup.sh soak)" >&2; exit 77; }

# x86-64-v3 means AVX2, FMA, BMI2, ... ; the loader knows what this processor has.
supports() {
  case $1 in
    x86-64-v3)
      local flag
      for flag in avx2 fma bmi1 bmi2 f16c movbe abm; do
        grep -qw "$flag" /proc/cpuinfo || return 1
      done ;;
  esac
}

builds=()
for compiler in g++ clang++; do
  for march in x86-64 x86-64-v3 native; do
    [[ -z $wanted || $wanted == *" $compiler-$march "* ]] || continue
    if ! supports $march; then
      echo "matrix: skipping $compiler $march, this processor lacks it" >&2
      continue
    fi
    name=$compiler-$march
    grouped=OFF  # of g++'s builds, as of the one that is shipped, files are compiled in groups: no bit changes
    [ $compiler = g++ ] && grouped=ON
    echo "matrix: building $name" >&2
    cmake -S . -B "$work/$name" -G Ninja -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_COMPILER=$compiler \
      -DTROCAR_MARCH=$march -DTROCAR_GROUPED=$grouped -DTROCAR_TESTS=OFF -DTROCAR_BENCH=OFF >"$work/$name.log" 2>&1 &&
      cmake --build "$work/$name" --target trocar >>"$work/$name.log" 2>&1 ||
      { tail -n 40 "$work/$name.log" >&2; echo "matrix: $name does not build" >&2; exit 1; }
    builds+=("$name")
  done
done
[ ${#builds[@]} -gt 0 ] || { echo "matrix: none of the builds$wanted can be made here" >&2; exit 77; }

field() {  # field NAME FILE: a top-level value of a JSON object
  python3 -c 'import json,sys; print(json.load(open(sys.argv[2]))[sys.argv[1]])' "$1" "$2"
}

failures=0
hashes=()
record() {  # record NAME BUILD THREADS [ARGUMENT...]
  local name=$1 build=$2 threads=$3
  shift 3
  local status=0
  TROCAR_THREADS=$threads "$work/$build/trocar" train $exercise --input "$input" --headless --json \
    --record "$work/$name.rec" "$@" >"$work/$name.json" 2>"$work/$name.err" || status=$?
  if [ $status -gt 1 ]; then  # 1 is "goal not reached": still a run, and still comparable
    tail -n 5 "$work/$name.err" >&2
    echo "matrix: $name ended with $status" >&2
    exit 1
  fi
  hashes+=("$(field state_hash "$work/$name.json")")
  echo "matrix: ${hashes[-1]}  $name"
}

recordings=()
for build in "${builds[@]}"; do
  record "$build-t1" "$build" 1
  recordings+=("$build-t1")
done
record "${builds[0]}-t2" "${builds[0]}" 2
record "${builds[-1]}-t2" "${builds[-1]}" 2
for simd in generic sse2 avx2 avx512; do  # one this processor lacks falls back to the next below
  TROCAR_SIMD=$simd record "${builds[0]}-$simd" "${builds[0]}" 1
done
record "${builds[0]}-drawn" "${builds[0]}" 2 --shots "$work/shots"
recordings+=("${builds[0]}-t2")

different=$(printf '%s\n' "${hashes[@]}" | sort -u | wc -l)
if [ "$different" != 1 ]; then
  echo "matrix: $different different hashes" >&2
  failures=1
fi

# An organ that answers at once, whose compliance every build makes by itself, and that is cut and handed over.
at_once() {  # at_once NAME BUILD
  local name=$1 build=$2
  TROCAR_CACHE=$work/cache-$name "$work/$build/trocar" bench gallbladder --seconds 3 --json "$work/$name.json" \
    >/dev/null 2>"$work/$name.err" || { tail -n 5 "$work/$name.err" >&2; exit 1; }
  static_hashes+=("$(python3 -c 'import json,sys
print("\n".join({run["state_hash"] for run in json.load(open(sys.argv[1]))["benchmarks"][0]["runs"]}))' "$work/$name.json")")
  rm -rf "$work/cache-$name"
  echo "matrix: ${static_hashes[-1]}  $name"
}
static_hashes=()
for build in "${builds[@]}"; do at_once "$build-at-once" "$build"; done
TROCAR_SIMD=generic at_once "${builds[0]}-at-once-generic" "${builds[0]}"
if [ "$(printf '%s\n' "${static_hashes[@]}" | sort -u | wc -l)" != 1 ]; then
  echo "matrix: organs that answer at once differ" >&2
  failures=1
fi

# Thread, which the exercise above has none of: a needle through both lips, in every build.
sewn() {  # sewn NAME BUILD
  local name=$1 build=$2 status=0
  "$work/$build/trocar" train suturing/needle-through --input demo --headless --no-store --json \
    >"$work/$name.json" 2>"$work/$name.err" || status=$?
  [ $status -le 1 ] || { tail -n 5 "$work/$name.err" >&2; echo "matrix: $name ended with $status" >&2; exit 1; }
  sewn_hashes+=("$(field state_hash "$work/$name.json")")
  echo "matrix: ${sewn_hashes[-1]}  $name"
}
sewn_hashes=()
for build in "${builds[@]}"; do sewn "$build-sewn" "$build"; done
if [ "$(printf '%s\n' "${sewn_hashes[@]}" | sort -u | wc -l)" != 1 ]; then
  echo "matrix: thread differs" >&2
  failures=1
fi

# Each recording is verified by the build after its own, so that every build plays somebody else's.
for i in "${!recordings[@]}"; do
  build=${builds[$(((i + 1) % ${#builds[@]}))]}
  for threads in 1 2; do
    if TROCAR_THREADS=$threads "$work/$build/trocar" replay "$work/${recordings[$i]}.rec" --verify \
        >"$work/replay.json" 2>"$work/replay.err"; then
      echo "matrix: verified  ${recordings[$i]} by $build, $threads thread(s)"
    else
      tail -n 5 "$work/replay.err" >&2
      echo "matrix: ${recordings[$i]} does not verify with $build, $threads thread(s)" >&2
      failures=1
    fi
  done
done
$keep || rm -rf "$work"/*.rec "$work/shots"
[ $failures = 0 ] && echo "matrix: ${#hashes[@]} runs of ${#builds[@]} builds, one hash: ${hashes[0]}; at once: ${static_hashes[0]}; sewn: ${sewn_hashes[0]}"
exit $failures
