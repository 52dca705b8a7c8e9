#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Same seed, same bytes; another seed, other bytes.
source "$(dirname "$0")/lib.sh"
drive() { "$headland" run config/missions/kiato_vineyard.yaml --set simulation.sensors.position_accuracy_m=0.02 \
  --seed "$1" --out "$scratch/$2" >/dev/null; }
drive 1 a
drive 1 b
drive 2 c
cmp "$scratch/a/trace.csv" "$scratch/b/trace.csv" || fail "two runs of one seed differ"
! cmp -s "$scratch/a/trace.csv" "$scratch/c/trace.csv" || fail "the seed has no effect"
grep -q '"completed": true' "$scratch/a/metrics.json" || fail "$(cat "$scratch/a/metrics.json")"
