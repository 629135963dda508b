#!/usr/bin/env bash
# Update golden: takes what the golden scenes do now for what they should do.
#
# For a change that means to move them: say why in the same commit.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "$0")")")
cd "$root"
source tools/build.sh
need_packages "${build_packages[@]}" "${test_packages[@]}"
build_preset dev
THRONG_UPDATE_GOLDEN=1 build/dev/tests/pipeline_tests --gtest_filter='Scenes/Golden.*' >&2
git --no-pager diff --stat -- tests/golden >&2
