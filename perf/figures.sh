#!/usr/bin/env bash
# Figures: every benchmark, one after another, on stdout.
#   perf/figures.sh             the programs of this folder
#   perf/figures.sh --scenes    and then `throng bench`, all scenes and sizes; that takes hours
# Times are worth something on a machine that does nothing else: its load is printed first.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")")
cd "$root"
source tools/build.sh
need_packages "${build_packages[@]}" libbenchmark-dev
build_preset perf

heading() { printf '\n## %s\n\n' "$*"; }

heading "load"
uptime
heading "limits"
build/perf/perf/limits
for program in build/perf/perf/*_perf; do
    heading "$(basename "$program")"
    "$program" 2>&1
done
if [[ ${1:-} == --scenes ]]; then
    heading "throng bench"
    ./throng bench --repeat 3 --json build/bench.json
    printf '\nThe time of every step is in build/bench.json.\n'
fi
