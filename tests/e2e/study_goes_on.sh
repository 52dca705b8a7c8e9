#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A study that is killed, or stopped with Ctrl-C, goes on where it was, and ends with the same bytes.
source "$(dirname "$0")/lib.sh"
command=("$headland" study config/studies/crowd.yaml --max-episodes 20)
study() { "${command[@]}" --out "$scratch/$1" "${@:2}"; }
episodes() { grep -vc '^#\|^cell' "$scratch/$1/episodes.csv" || true; }
# begin NAME SIGNAL: ends a study by a signal when it has at least two episodes; sets $code.
begin() {
  "${command[@]}" --out "$scratch/$1" >/dev/null 2>"$scratch/$1.stderr" &
  local pid=$!
  until [ -e "$scratch/$1/episodes.csv" ] && [ "$(episodes "$1")" -ge 2 ]; do sleep 0.02; done
  kill -"$2" "$pid"
  code=0
  wait "$pid" || code=$?
}

study whole --jobs 2 >/dev/null

begin killed KILL
[ "$code" -eq 137 ] || fail "not killed: $code"
before=$(episodes killed)
[ "$before" -lt "$(episodes whole)" ] || fail "killed too late"
study killed >/dev/null
cmp "$scratch/whole/episodes.csv" "$scratch/killed/episodes.csv" || fail "other bytes after kill -9"

begin stopped INT
[ "$code" -eq 3 ] || fail "exit code $code after Ctrl-C: $(cat "$scratch/stopped.stderr")"
grep -qE 'stopped with [0-9]+ of [0-9]+ episodes; the same command goes on from there \[E207\]' \
  "$scratch/stopped.stderr" || fail "$(cat "$scratch/stopped.stderr")"
study stopped >/dev/null
cmp "$scratch/whole/episodes.csv" "$scratch/stopped/episodes.csv" || fail "other bytes after Ctrl-C"
grep -q '"name": "mcts/invisible"' "$scratch/stopped/results.json" || fail "no results.json"

code=0
study whole --set seed=2 >/dev/null 2>"$scratch/other.stderr" || code=$?
[ "$code" -eq 2 ] || fail "another seed in the same folder: exit code $code"
grep -q 'choose another directory with --out' "$scratch/other.stderr" || fail "$(cat "$scratch/other.stderr")"
