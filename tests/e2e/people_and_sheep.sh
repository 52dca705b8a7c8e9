#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A mission among people and animals is finished, nobody is driven into, and the same seed gives the same bytes.
source "$(dirname "$0")/lib.sh"
mission=config/missions/hilly_parcels_people_and_sheep.yaml
for run in a b; do "$headland" run $mission --out "$scratch/$run" --set simulation.seed=4 >"$scratch/stdout"; done
cmp "$scratch/a/trace.csv" "$scratch/b/trace.csv" || fail "two runs of one seed differ"
grep -q '"completed": true' "$scratch/a/metrics.json" || fail "$(cat "$scratch/a/metrics.json")"
grep -q '"robot_collisions": 0' "$scratch/a/metrics.json" || fail "somebody was driven into"
holds "$(number "$scratch/a/metrics.json" takeovers) >= 1" "the path is left"
holds "$(number "$scratch/a/metrics.json" protective_stops) >= 1" "the fail-safe stops"
grep -q ",local$" "$scratch/a/trace.csv" || fail "the trace does not say who drove"
code=0; "$headland" run $mission --out "$scratch/c" --set 'simulation.agents.groups=[{parcel: moon}]' 2>"$scratch/stderr" >/dev/null || code=$?
[ $code -eq 2 ] || fail "exit code $code for an unknown parcel"
grep -q "no parcel 'moon'.*E108" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
