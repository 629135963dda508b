#!/usr/bin/env bash
# Check: what a change goes through before it is pushed.
#   tools/check.sh         format, include direction, dev build, fast tests, clang-tidy on what changed
#   tools/check.sh tidy    clang-tidy alone, on what the last 20 commits and since have changed: some
#                          20 s of a processor for each file
#   tools/check.sh all     clang-tidy on everything, the other presets too, and the pages of the public
#                          headers; a first use on a bare Debian (as root); looks at the page of
#                          throng cost in a browser, of few and of many settings; fuzzes a little;
#                          then every case whole, whose time it tells, and the fixed random scenes
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "$0")")")
cd "$root"
source tools/build.sh
need_packages "${build_packages[@]}" "${test_packages[@]}" "${check_packages[@]}"

# clang-tidy on the files that differ from a commit, and those that git does not track yet.
tidy_since() {  # COMMIT
    say "clang-tidy"
    mkdir -p build
    cmake --preset tidy >build/tidy.log || { cat build/tidy.log; exit 1; }
    { git diff --name-only --diff-filter=d "$1"; git ls-files --others --exclude-standard; } \
        | sed -n '/_threads\.cpp$/d; /^tests\/fuzz\//d; /\.cpp$/p' \
        | xargs -r -d '\n' -n 1 -P "$(job_count)" clang-tidy-14 --quiet -p build/tidy
}

if [[ ${1:-} == tidy ]]; then
    tidy_since "$(git rev-list -n 21 HEAD | tail -n 1)"
    say "all is well"
    exit
fi

say "format"
tools/format.sh --check
say "include direction"
tools/include_direction.py
build_preset dev
test_preset dev -LE slow

# What differs from where this branch left the one it is to go to, or everything.
base=$(git merge-base HEAD '@{upstream}' 2>/dev/null || git rev-parse HEAD)
[[ ${1:-} != all ]] || base=$(git hash-object -t tree /dev/null)
tidy_since "$base"

if [[ ${1:-} == all ]]; then
    build_preset asan
    test_sanitized asan
    for races in tsan tsan-tbb; do
        build_preset "$races"
        test_sanitized "$races"
    done
    tools/docs.sh
    tools/first_use.sh
    build_preset release
    say "the page of throng cost, in a browser"
    need_packages chromium-headless-shell
    command -v npm >/dev/null || need_packages nodejs npm
    ./throng cost stacks:10 --minutes 0.5 --out build/page --quiet
    npm pack --silent --pack-destination build/page axe-core >/dev/null
    tar -xzf build/page/axe-core-*.tgz -C build/page package/axe.min.js
    tools/check_page.py build/page/cost.html build/page/package/axe.min.js
    say "the same with five hundred settings"
    for dt in 1/{30,60,90,120,240,300,480,600,960,1920}; do
        for substeps in {1..10}; do
            for integrator in semi_implicit euler midpoint splitting rk4; do
                echo "dt=$dt substeps=$substeps integrator=$integrator"
            done
        done
    done >build/page/settings.txt
    ./throng cost spring:1 --settings build/page/settings.txt --out build/page/many --quiet
    tools/check_page.py build/page/many/cost.html build/page/package/axe.min.js
    build_preset perf
    build_preset fuzz
    for fuzzer in build/fuzz/tests/fuzz/*_fuzz; do
        name=$(basename "$fuzzer" _fuzz)
        say "fuzzing $name for 30 s"
        mkdir -p "build/fuzz/found/$name"
        "$fuzzer" -max_total_time=30 -entropic=0 -artifact_prefix="build/fuzz/found/$name-" \
            "build/fuzz/found/$name" "tests/fuzz/corpus/$name"
    done

    start=$SECONDS verdict=0
    ./throng cases || verdict=1
    say "every case, whole: $((SECONDS - start)) s"
    tools/random_scenes --fixed || verdict=1
    ((verdict == 0)) || exit 1
fi
say "all is well"
