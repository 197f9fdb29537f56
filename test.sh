#!/usr/bin/env bash
# Installs what is missing, builds the release preset with its tests, and runs them.
#
#   ./test.sh          the quick ones: unit, scene and window (on two cores some minutes, and a quarter of an hour for
#                      the first build)
#   ./test.sh unit     bodies, numbers and files by themselves: what one runs often; or scene, window: those alone
#   ./test.sh soak     the long ones: abuse, kills, fuzzing, the matrix of compilers, instruction sets and threads
#
# The last line is `N passed, N failed, N skipped`; above it stands what failed, and what was skipped and why.
# TROCAR_FUZZ_SECONDS (default 600) is how long each fuzz target runs in the soak, two at a time.
# No display and no network (apt aside) needed. Exit 0 only if every test that ran passed and at least one ran.
set -euo pipefail
cd "$(dirname "$0")"
which=${1:-quick}
case "$which" in
  quick) job=test; filter=(-LE '^soak$') ;;
  unit | scene | window) job=test; filter=(-L "^$which$") ;;
  soak) job=soak; filter=(-L '^soak$' -E '^house\.DeterminismMatrix$') ;;
  *) sed -n '2,12s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac

export TROCAR_CACHE=$PWD/build/release/cache  # a fresh one is as good: nothing outside the checkout is written
tools/setup.sh $job
echo "test: building (some minutes the first time)" >&2
begun=$SECONDS
tools/build.sh --tests
built=$((SECONDS - begun))

junit=$PWD/build/release/test-results/junit.xml
summary=build/release/test-results/summary.txt
tests() {  # the summary's exit code counts: it knows every case
  local status=0
  rm -rf build/release/test-results
  mkdir -p build/release/test-results
  ctest --test-dir build/release "${filter[@]}" --output-on-failure --no-tests=error -j "$(nproc)" \
    --output-junit "$junit" || status=$?
  echo
  tools/test_summary.py "$junit" build/release/test-results | tee "$summary" || status=$?
  return $status
}

if [ "$which" != soak ]; then
  tests && exit 0 || exit $?
fi

# The soak: each part to its end, whatever the others found; then a table.
parts=() results=() times=()
failed=0
part() {  # part NAME COMMAND...
  local name=$1 status=0 start=$SECONDS
  shift
  echo "soak: $name begins" >&2
  "$@" || status=$?
  parts+=("$name") times+=($((SECONDS - start)))
  case $status in
    0) results+=(passed) ;;
    77) results+=("skipped: something is missing, see above") ;;
    *) results+=("FAILED ($status)"); failed=1 ;;
  esac
  echo "soak: $name ends after ${times[-1]} s: ${results[-1]}" >&2
}
part "abuse, kills, exercises" tests
part "fuzzing" tools/fuzz.sh "${TROCAR_FUZZ_SECONDS:-600}"
part "determinism matrix" tools/determinism_matrix.sh
packages() {  # installed in bare systems; that needs root and the network
  [ "$(id -u)" = 0 ] || { echo "test: packages are tried as root only" >&2; return 77; }
  tools/package.sh deb tarball && tools/try_package.sh deb && tools/try_package.sh tarball
}
part "packages" packages

echo
printf '%-26s %6d s  %s\n' "build" "$built" ""
for i in "${!parts[@]}"; do printf '%-26s %6d s  %s\n' "${parts[$i]}" "${times[$i]}" "${results[$i]}"; done
printf '%-26s %6d s\n' "together" "$((SECONDS - begun))"
read -r passed _ broken _ skipped _ < <(tail -1 "$summary")
for result in "${results[@]:1}"; do
  case $result in
    passed) ((passed += 1)) ;;
    skipped*) ((skipped += 1)) ;;
    *) ((broken += 1)) ;;
  esac
done
echo "$passed passed, $broken failed, $skipped skipped"
exit $failed
