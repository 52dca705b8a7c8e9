#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Three parcels on hills, two vehicles, two chargers: planned, driven, and what the plan promises.
source "$(dirname "$0")/lib.sh"
"$headland" run config/missions/hilly_parcels.yaml --out "$scratch/out" --set planner.iterations=500 \
  --set planner.cache="$scratch/cache" >"$scratch/stdout"
cat "$scratch/stdout"
summary=$scratch/out/summary.json
metrics=$scratch/out/metrics.json
holds "$(grep -c '"kind": "row"' "$summary") == 48" "rows"
holds "$(grep -c '"kind": "task"' "$summary") == 4" "visits"
holds "$(number "$summary" charge_stops) >= 2" "charge stops"
holds "$(number "$summary" min_margin_j) >= 0" "margin"
grep -q '"text": ".* charges .* kWh at ' "$summary" || fail "no reason for a charge"
grep -q '"completed": true' "$metrics" || fail "$(cat "$metrics")"
grep -q '"reserve_kept": true' "$metrics" || fail "$(cat "$metrics")"
holds "$(ls "$scratch/cache" | wc -l) == 1" "roadmap kept"
