#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The real vineyard with 92 rows in 10 blocks: jojos_vineyard.sh HEADLAND MISSION
source "$(dirname "$0")/lib.sh"
data=${HEADLAND_DATA:-../shared/data}
[ -e "$data/farms/jojos_vineyard/jojos_vineyard.geojson" ] || { echo "skipped: no $data"; exit 77; }
"$headland" run "config/missions/$2.yaml" --out "$scratch/out" >"$scratch/stdout"
cat "$scratch/stdout"
summary=$scratch/out/summary.json
holds "$(grep -c '"kind": "row"' "$summary") == 92" "rows"
holds "$(number "$summary" charge_stops) >= 2" "charge stops"
holds "$(number "$summary" gap_ratio) <= 0.03" "gap"
grep -q '"completed": true' "$scratch/out/metrics.json" || fail "$(cat "$scratch/out/metrics.json")"
