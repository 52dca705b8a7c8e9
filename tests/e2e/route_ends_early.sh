#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# A time limit and Ctrl-C both end the search with an answer; the same seed and rounds give the same answer.
source "$(dirname "$0")/lib.sh"
awk 'BEGIN { srand(1); n = 120; print "Name: random\nTYPE: EVRP\nDIMENSION: " n "\nSTATIONS: 3\nCAPACITY: 100\nENERGY_CAPACITY: 700"
  print "ENERGY_CONSUMPTION: 1\nNODE_COORD_SECTION"; for (i = 1; i <= n + 3; ++i) print i, int(200 * rand()), int(200 * rand())
  print "DEMAND_SECTION"; for (i = 1; i <= n; ++i) print i, (i == 1 ? 0 : 1 + int(20 * rand()))
  print "STATIONS_COORD_SECTION"; for (i = 1; i <= 3; ++i) print n + i; print "DEPOT_SECTION\n1\n-1\nEOF" }' >"$scratch/random.evrp"
"$headland" route "$scratch/random.evrp" --json --time-limit-s 1 >"$scratch/limited"
holds "$(number "$scratch/limited" seconds) < 4" "time limit"
holds "$(number "$scratch/limited" lower_bound) <= $(number "$scratch/limited" cost)" "bound"

"$headland" route "$scratch/random.evrp" --json --time-limit-s 100 >"$scratch/interrupted" &
search=$!
sleep 2
kill -INT $search
wait $search || fail "Ctrl-C: exit code $?"
holds "$(number "$scratch/interrupted" seconds) < 6" "Ctrl-C"
holds "$(number "$scratch/interrupted" vehicles) > 5" "vehicles"

for k in 1 2; do "$headland" route "$scratch/random.evrp" --json --iterations 300 --seed 5 | grep -v '"seconds"' >"$scratch/again$k"; done
cmp "$scratch/again1" "$scratch/again2" || fail "the same seed and rounds give two answers"
