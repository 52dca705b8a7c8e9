#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A tractor with a lidar drives two rows by what it sees, in leaf and bare.
source "$(dirname "$0")/lib.sh"
mission=config/missions/girona_orchard_by_lidar.yaml
cheap=('tasks=[{rows: [orchard/r1, orchard/r2]}]' simulation.perception.{lidar.sub_rays_count=1,period_s=0.5})
for run in leaf bare; do
  "$headland" run $mission --out "$scratch/$run" --set "${cheap[@]}" simulation.perception.crop=orchard_$run >"$scratch/stdout"
  grep -q "^rows seen " "$scratch/stdout" || fail "$(cat "$scratch/stdout")"
  grep -q '"completed": true' "$scratch/$run/metrics.json" || fail "$(cat "$scratch/$run/metrics.json")"
  holds "$(number "$scratch/$run/metrics.json" valid_ratio) >= 0.95" "rows are seen"
  holds "$(number "$scratch/$run/metrics.json" mae_m) <= 0.03" "and well"
  holds "$(number "$scratch/$run/metrics.json" row_rms_m) <= 0.05" "and kept to"
done
code=0; "$headland" run $mission --out "$scratch/bad" --set simulation.perception.crop=hops 2>"$scratch/stderr" >/dev/null || code=$?
[ $code -eq 2 ] || fail "exit code $code for an unknown crop"
grep -q "crop: 'hops' is not known.*vineyard_leaf.*E108" "$scratch/stderr" || fail "$(cat "$scratch/stderr")"
