#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# Small instances whose answers are plain, one in each format; published ones where they are at hand.
source "$(dirname "$0")/lib.sh"

# expect NAME KEY VALUE: the JSON of the instance NAME, solved to the proof
expect() {
  "$headland" route "$scratch/$1" --json --out "$scratch/out" >"$scratch/stdout" 2>"$scratch/stderr"
  holds "$(number "$scratch/stdout" "$2") == $3" "$1: $2"
  grep -q '"optimal": true' "$scratch/stdout" || fail "$1 is not proven: $(cat "$scratch/stdout")"
  cmp "$scratch/stdout" "$scratch/out/solution.json" || fail "$1: --json differs from solution.json"
  [ -s "$scratch/out/solution.sol" ] || fail "$1: no solution.sol"
  [ ! -s "$scratch/stderr" ] || fail "$1: stderr is not empty where it is no terminal"
}

cat >"$scratch/four.atsp" <<'END'
NAME: four
TYPE: ATSP
DIMENSION: 4
EDGE_WEIGHT_TYPE: EXPLICIT
EDGE_WEIGHT_FORMAT: FULL_MATRIX
EDGE_WEIGHT_SECTION
9999 9 1 9   9 9999 9 4   9 2 9999 9   3 9 9 9999
EOF
END
expect four.atsp cost 10
tr -d ' \n' <"$scratch/stdout" | grep -q '"routes":\[\[1,3,2,4,1\]\]' || fail "$(cat "$scratch/stdout")"

# Two customers on either side whose loads do not fit together; each is reached by way of a station.
printf '%s\r\n' "Name: two" "TYPE: EVRP " "DIMENSION: 3" "STATIONS: 2 " "CAPACITY: 10" "ENERGY_CAPACITY: 10" \
  "ENERGY_CONSUMPTION: 1.0" "EDGE_WEIGHT_FORMAT: EUC_2D" "NODE_COORD_SECTION" "1 0 0" "2 8 0" "3 -8 0" "4 4 0" "5 -4 0" \
  "DEMAND_SECTION" "1 0" "2 6" "3 6" "STATIONS_COORD_SECTION" "4" "5" "DEPOT_SECTION" "1" "-1" >"$scratch/two.evrp"
printf EOF >>"$scratch/two.evrp"
expect two.evrp cost 32
holds "$(number "$scratch/stdout" vehicles) == 2" "vehicles"

# Both customers and home are 30 units away and the battery holds 20: one vehicle charges at S1.
cat >"$scratch/one.txt" <<'END'
StringID Type x y demand ReadyTime DueDate ServiceTime
D0 d 0 0 0 0 60 0
S1 f 10 0 0 0 60 0
C1 c 12 0 1 12 30 1
C2 c 15 0 1 0 30 1

Q Vehicle fuel tank capacity /20/
C Vehicle load capacity /5/
r fuel consumption rate /1/
g inverse refueling rate /1/
v average Velocity /1/
END
expect one.txt cost 30
holds "$(number "$scratch/stdout" vehicles) == 1" "vehicles"
grep -q '"S1"' "$scratch/stdout" || fail "no charge: $(cat "$scratch/stdout")"

printf '12 1\n0 0 0\n6 0 0\n3 4 10\n3 0 4\n3 -40 50\n' >"$scratch/op.txt"
expect op.txt score 14
holds "$(number "$scratch/stdout" cost) == 50" "score lost"

# Nothing is written unless asked for, and the text names the proof.
here=$PWD
(cd "$scratch" && "$headland" route four.atsp >text)
grep -q "optimal, proven" "$scratch/text" || fail "$(cat "$scratch/text")"
[ ! -e "$scratch/solution.json" ] && [ ! -e "$scratch/out/report.html" ] || fail "files nobody asked for"

data=${HEADLAND_DATA:-$here/../shared/data}
[ -e "$data/atsp/ftv33.atsp" ] || { echo "skipped: no $data"; exit 77; }
cp "$data/atsp/ftv33.atsp" "$data/evrptw/5/c101C5.txt" "$scratch"
expect ftv33.atsp cost 1286
expect c101C5.txt vehicles 2
holds "$(number "$scratch/stdout" cost) < 257.75 && $(number "$scratch/stdout" cost) > 257.74" "c101C5"
