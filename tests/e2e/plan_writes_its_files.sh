#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
source "$(dirname "$0")/lib.sh"
"$headland" plan config/missions/girona_orchard.yaml --out "$scratch/out" --json >"$scratch/stdout" 2>"$scratch/stderr"
for file in summary.json plan.geojson report.html; do
  [ -s "$scratch/out/$file" ] || fail "no $file"
done
cmp "$scratch/stdout" "$scratch/out/summary.json" || fail "--json differs from summary.json"
[ ! -s "$scratch/stderr" ] || fail "stderr is not empty where it is no terminal: $(cat "$scratch/stderr")"
holds "$(number "$scratch/stdout" gap_ratio) <= 0.03" "gap"
holds "$(grep -c '"kind": "row"' "$scratch/stdout") == 68" "rows"
grep -q 'config_hash' "$scratch/out/plan.geojson" || fail "plan.geojson carries no configuration hash"
# Names of XML namespaces and the drawing library's licence are no loads; anything that is would be an attribute.
! grep -qE '(src|href)="?(https?:)?//' "$scratch/out/report.html" || fail "report.html loads from outside itself"
# A directory that cannot be written is the user's error, said in one line.
touch "$scratch/file"
code=0
"$headland" plan config/missions/girona_orchard.yaml --out "$scratch/file/x" 2>"$scratch/stderr" >/dev/null || code=$?
[ "$code" -eq 2 ] || fail "unwritable directory: exit code $code"
grep -q E109 "$scratch/stderr" || fail "unwritable directory: $(cat "$scratch/stderr")"
