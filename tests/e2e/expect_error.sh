#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# expect_error.sh EXIT_CODE REGEX HEADLAND ARGS...
# The command must end with EXIT_CODE, say one line on stderr that matches REGEX, nothing on stdout,
# and leave no file behind.
set -u
want=$1 regex=$2
shift 2
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
"$@" --out "$out/files" >"$out/stdout" 2>"$out/stderr"
code=$?
fail() { echo "FAILED: $*"; echo "--- stderr:"; cat "$out/stderr"; echo "--- stdout:"; cat "$out/stdout"; exit 1; }
[ "$code" -eq "$want" ] || fail "exit code $code, wanted $want"
grep -qE -- "$regex" "$out/stderr" || fail "stderr does not match: $regex"
[ "$(wc -l <"$out/stderr")" -eq 1 ] || fail "stderr is not one line"
[ ! -s "$out/stdout" ] || fail "stdout is not empty"
[ ! -e "$out/files" ] || [ -z "$(ls -A "$out/files")" ] || fail "files were left: $(ls "$out/files")"
echo "passed: $(cat "$out/stderr")"
