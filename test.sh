#!/usr/bin/env bash
# Installs what is missing, builds the release preset with its tests, and runs them.
#
#   ./test.sh          the quick ones: unit, scene and window (on two cores some minutes, and a quarter of an hour for
#                      the first build)
#   ./test.sh unit     bodies, numbers and files by themselves: what one runs often; or scene, window: those alone
#   ./test.sh soak     lists the parts of the long ones: abuse, kills, seeds, fuzzing, compilers and instruction sets
#   ./test.sh soak PART...   runs parts of them, each at most 45 minutes on two cores; all: every part
#
# The last line of the quick ones is `N passed, N failed, N skipped`; above it stands what failed, and what was skipped
# and why. TROCAR_FUZZ_SECONDS (default 600) is how long each fuzz target runs in the soak, two at a time.
# SOAK_NOTE=1 writes each part's commit, date, minutes and result to docs/log/soak.md.
# No display and no network (apt aside) needed. Exit 0 only if every test that ran passed and at least one ran.
set -euo pipefail
cd "$(dirname "$0")"
which=${1:-quick}
case "$which" in
  quick) job=test; filter=(-LE '^soak$') ;;
  unit | scene | window) job=test; filter=(-L "^$which$") ;;
  soak) job=soak ;;
  *) sed -n '2,15s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac

if [ "$which" = soak ]; then
  shift
  command -v python3 >/dev/null || tools/setup.sh test
  [ $# -gt 0 ] || exec tools/soak.py list
  [ "$*" != all ] || set -- $(tools/soak.py list --names)
  tools/soak.py list "$@" >&2
fi
export TROCAR_CACHE=$PWD/build/release/cache  # a fresh one is as good: nothing outside the checkout is written
tools/setup.sh $job
echo "test: building (some minutes the first time)" >&2
if [ "$which" = soak ]; then tools/build.sh --tests all soak_programs; else tools/build.sh --tests; fi

if [ "$which" = soak ]; then
  exec tools/soak.py run ${SOAK_NOTE:+--note} "$@"
fi

junit=$PWD/build/release/test-results/junit.xml
summary=build/release/test-results/summary.txt
status=0
rm -rf build/release/test-results
mkdir -p build/release/test-results
ctest --test-dir build/release "${filter[@]}" --output-on-failure --no-tests=error -j "$(nproc)" \
  --output-junit "$junit" || status=$?
echo
tools/test_summary.py "$junit" build/release/test-results | tee "$summary" || status=$?  # it knows every case
exit $status
