#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
source "$(dirname "$0")/lib.sh"
"$headland" --help | grep -q "Exit codes" || fail "no exit codes in the help"
for command in plan run study route doctor; do
  "$headland" $command --help | grep -q "json" || fail "no help for $command"
done
"$headland" --version | grep -qE '^[0-9]+\.[0-9]+' || fail "no version"
"$headland" doctor >"$scratch/doctor" || fail "$(cat "$scratch/doctor")"
for usage in "" "plan" "fly" "plan a b" "run x --realtime -1" "route" "route x --time-limit-s 0" "route x --iterations -1"; do
  code=0
  "$headland" $usage >/dev/null 2>&1 || code=$?
  [ "$code" -eq 2 ] || fail "'headland $usage' ends with $code, not 2"
done
