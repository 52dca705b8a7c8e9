#!/usr/bin/env bash
# SPDX-License-Identifier: Apache-2.0
# The study of seed 003 prints its tables, says what was not run, and its report plays an episode.
source "$(dirname "$0")/lib.sh"
"$headland" study config/studies/acfr.yaml --max-episodes 1 --out "$scratch/out" \
  --set "accuracies_m=[2]" iterations_count=100 >"$scratch/stdout"
grep -qE '1 min +mcts +not run \(0\.0\) +[0-9.]+ \[[0-9.]+, [0-9.]+\] \(0\.4\)' "$scratch/stdout" \
  || fail "no Table I: $(cat "$scratch/stdout")"
grep -qE '5 min +pf +not run \(0\.0\)' "$scratch/stdout" || fail "pf's row is missing"
html="$scratch/out/report.html"
[ "$(wc -c <"$html")" -lt 3000000 ] || fail "the report is too large"
grep -q '"episodes":\[{"name":"mcts/' "$html" || fail "no episode in the report"

browser=$(command -v chromium || true)
[ -n "$browser" ] || { echo "no chromium: the page was not opened"; exit 0; }
# text SCRIPT: what the player says some seconds after the script ran in the page
text() {
  sed "s#</body>#<script>$1</script></body>#" "$html" >"$scratch/page.html"
  "$browser" --headless --no-sandbox --disable-gpu --virtual-time-budget=15000 --dump-dom \
    "file://$scratch/page.html" 2>/dev/null | grep -oE '<output class="player-text">[^<]*' | sed 's/.*>//'
}
standing=$(text "")
[[ "$standing" == 0:00.1\ /*clearance*to\ waypoint\ 1* ]] || fail "the player says '$standing'"
playing=$(text 'document.querySelector(".player-play").click()')
[ -n "$playing" ] && [ "${playing%% *}" != "${standing%% *}" ] || fail "it does not play: '$playing'"
