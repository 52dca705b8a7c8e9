#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
source "$(dirname "$0")/lib.sh"
"$headland" run config/missions/girona_orchard.yaml --out "$scratch/out" >"$scratch/stdout"
grep -q "report.html" "$scratch/stdout" || fail "the report's path is not printed"
for file in metrics.json trace.csv report.html run.mcap; do
  [ -s "$scratch/out/$file" ] || fail "no $file"
done
grep -q '"completed": true' "$scratch/out/metrics.json" || fail "$(cat "$scratch/out/metrics.json")"
holds "$(number "$scratch/out/metrics.json" rows_done) == 68" "rows done"
holds "$(number "$scratch/out/metrics.json" overall_rms_m) <= 0.05" "tracking"
