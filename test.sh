#!/usr/bin/env bash
# Installs what is missing, builds the release preset with its tests, and runs them.
#
#   ./test.sh          the quick ones (with the first build under 15 minutes on two cores)
#   ./test.sh soak     the long ones: abuse, fuzzing, the matrix of compilers, instruction sets and threads
#
# No display and no network (apt aside) needed. Exit 0 only if every test that ran passed and at least one ran.
set -euo pipefail
cd "$(dirname "$0")"
which=${1:-quick}
case "$which" in
  quick) job=test; filter=(-LE '^soak$') ;;
  soak) job=soak; filter=(-L '^soak$') ;;
  *) sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2 ;;
esac

tools/setup.sh $job
echo "test: building (some minutes the first time)" >&2
tools/build.sh --tests

log=$(mktemp)
trap 'rm -f "$log"' EXIT
status=0
ctest --test-dir build/release "${filter[@]}" --output-on-failure --no-tests=error -j "$(nproc)" 2>&1 | tee "$log" || status=$?
skipped=$(grep -c '\*\*\*Skipped' "$log" || true)
ran=$(grep -cE '^ *[0-9]+/[0-9]+ Test ' "$log" || true)
echo
echo "test: $ran $which tests, of which $skipped skipped"
exit $status
