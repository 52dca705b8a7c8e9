# SPDX-License-Identifier: Apache-2.0
# Shared by the end-to-end scripts: a scratch directory, and assertions. Source it with the command as $1.
set -euo pipefail
headland=$1
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT

fail() { echo "FAILED: $*" >&2; exit 1; }
# number FILE KEY: the first number behind "KEY": in a JSON file
number() { grep -oE "\"$2\": *-?[0-9.eE+-]+" "$1" | head -n 1 | sed 's/.*: *//'; }
# holds EXPRESSION: an awk comparison, such as "0.02 <= 0.03"
holds() { awk "BEGIN { exit !($1) }" || fail "$2: $1"; }
