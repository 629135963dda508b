# Build: what the launcher, the checks and CI share: packages, how many jobs, one preset built.
#
# Sourced, with $root set. All it has to say goes to stderr: stdout belongs to the command.

build_packages=(g++ cmake ninja-build ccache libtbb-dev libeigen3-dev libembree-dev libhdf5-dev
    libopenvdb-dev libboost-dev libxxhash-dev python3)
test_packages=(libgtest-dev)
peer_packages=(libbullet-dev libode-dev)  # used where they are, never installed
check_packages=(clang-14 clang-format-14 clang-tidy-14 libbenchmark-dev valgrind)
docs_packages=(doxygen python3)  # tools/docs.sh alone

say() { printf 'throng: %s\n' "$*" >&2; }

# One build at a time, however many ask for one.
hold_lock() {
    mkdir -p "$root/build"
    exec 9>"$root/build/lock"
    flock -n 9 || { say "another build is under way; waiting for it"; flock 9; }
}
drop_lock() { exec 9>&-; }

# As many jobs as there are processors, and memory for: a file that includes Eigen takes about a
# gigabyte, and a machine that swaps is slower than one job.
job_count() {
    local jobs free_mb limit
    [[ -z ${JOBS:-} ]] || { echo "$JOBS"; return; }
    jobs=$(nproc)
    free_mb=$(sed -n 's/^MemAvailable: *\([0-9]*\)[0-9]\{3\} kB/\1/p' /proc/meminfo 2>/dev/null) || true
    free_mb=${free_mb:-2000}
    limit=$(cat /sys/fs/cgroup/memory.max 2>/dev/null || echo max)
    [[ $limit == max ]] || ((limit / 1000000 >= free_mb)) || free_mb=$((limit / 1000000))
    ((free_mb / 1000 >= jobs)) || jobs=$((free_mb / 1000))
    echo $((jobs > 0 ? jobs : 1))
}

# Of a log: the first command that failed and what it said, or else the end.
what_failed() {
    if grep -q '^FAILED: ' "$1"; then
        sed -n '/^FAILED: /,$p' "$1" | head -n 40
    else
        tail -n 40 "$1"
    fi
}

# Says every 20 s how far a build has come, by its log, until it is killed or nobody is left to
# kill it: what waits in a script or in CI sees that something goes on.
tell_progress() {  # LOG
    local start=$SECONDS at told=""
    while kill -0 $$ 2>/dev/null; do
        # A builtin that waits: a sleep of its own would outlive this.
        read -r -t 20 <> <(:) || true
        at=$(grep -o '^\[[0-9]*/[0-9]*\]' "$1" | tail -n 1) || true
        at=${at//[\[\]]/}
        [[ -z $at || $at == "$told" ]] \
            || say "${at%/*} of ${at#*/} built after $((SECONDS - start)) s"
        told=$at
    done
}

# Runs a command: shown on a terminal, else kept in a log, of which what failed is shown.
logged() {
    local log=$1 status=0
    shift
    if [[ -t 2 ]]; then
        "$@" >&2 </dev/null 9>&- || status=$?
    else
        "$@" >>"$log" 2>&1 </dev/null 9>&- || status=$?
        ((status == 0)) || { what_failed "$log" >&2; say "the whole log is $log"; }
    fi
    return $status
}

missing_packages() {
    local have package
    have=" $(dpkg-query -W -f='${db:Status-Status}=${Package} ' "$@" 2>/dev/null)" || true
    for package; do
        [[ $have == *" installed=$package "* ]] || echo "$package"
    done
}

# Installs those packages that are not there. Other systems than Debian's kin are left to CMake,
# which says what it does not find.
need_packages() {
    local missing as_root=() log=$root/build/packages.log
    command -v dpkg-query >/dev/null && command -v apt-get >/dev/null || return 0
    mapfile -t missing < <(missing_packages "$@")
    ((${#missing[@]})) || return 0
    if ((EUID != 0)); then
        if command -v sudo >/dev/null && { [[ -t 0 ]] || sudo -n true 2>/dev/null; }; then
            as_root=(sudo)
        else
            say "these packages are missing, and only root can install them:"
            say "  apt-get install --no-install-recommends ${missing[*]}"
            exit 2
        fi
    fi
    say "installing ${missing[*]}"
    mkdir -p "${log%/*}" && : >"$log"
    # A list that could not be renewed may still do.
    logged "$log" "${as_root[@]}" apt-get update || true
    logged "$log" "${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install --yes \
        --no-install-recommends -o DPkg::Lock::Timeout=300 "${missing[@]}" || {
        say "the packages could not be installed: ${missing[*]}"
        exit 2
    }
}

# Whether build/NAME was made in this place, and with this compiler where one is asked for.
made_here() {
    local made
    mapfile -t made 2>/dev/null <"$root/build/$1/made_for" || return 1
    [[ ${made[0]:-} == "$root" && ${CXX:-${made[1]:-}} == "${made[1]:-}" ]]
}

# Configures and builds a preset into build/NAME: NAME [TARGET]...
build_preset() {
    local name=$1 dir=$root/build/$1 log=$root/build/$1/build.log jobs
    shift
    made_here "$name" || {
        rm -rf "$dir"
        mkdir -p "$dir"
        printf '%s\n' "$root" "${CXX:-}" >"$dir/made_for"
    }
    : >"$log"
    jobs=$(job_count)
    say "building $name with $jobs jobs; a build from nothing takes minutes"
    local start=$SECONDS watcher="" failed=0
    [[ -t 2 ]] || { tell_progress "$log" 9>&- & watcher=$!; }
    (
        cd "$root"
        logged "$log" cmake --preset "$name" || exit 3
        logged "$log" cmake --build "$dir" -j "$jobs" ${1:+--target "$@"} || exit 3
    ) || failed=1
    [[ -z $watcher ]] || { kill "$watcher" && wait "$watcher"; } 2>/dev/null || true
    ((failed == 0)) || { say "$name does not build"; exit 3; }
    say "built $name in $((SECONDS - start)) s"
}

# Runs the tests of a preset that was built: NAME [CTEST ARGS]...
test_preset() {
    local dir=$root/build/$1
    shift
    (cd "$dir" && ctest --output-on-failure --no-tests=error --timeout 600 -j "$(job_count)" "$@")
}

# Runs what a sanitizer is there for: asan the fast tests, but for those that only compare runs with
# one another or that do the same many times over; tsan and tsan-tbb those with threads. With SECONDS
# none that took longer when preset test last ran them.
test_sanitized() {  # PRESET [SECONDS]
    local which=(-LE "slow|tree") steady=()
    # The module that makes level sets has copies of its own of what it needs of throng.
    export ASAN_OPTIONS=detect_stack_use_after_return=1:detect_odr_violation=1
    export UBSAN_OPTIONS=print_stacktrace=1
    export LSAN_OPTIONS=print_suppressions=0:suppressions=$root/tools/leaks.supp
    export TSAN_OPTIONS=halt_on_error=1:suppressions=$root/tools/races.supp
    if [[ $1 == tsan* ]]; then
        which+=(-R "$(sed -n 's/^THRONG_TESTS_NAMED:STRING=//p' "$root/build/$1/CMakeCache.txt")"
            -E "Lanes|SolveWidths|Catalogue/HardCases")
        # It needs addresses that are not shuffled; where that cannot be had, it may do without.
        if setarch -R true 2>/dev/null; then steady=(setarch -R); fi
    else
        local compares="SameBits|ComingEffects|FarScenes|SolidBits|SolveWidths|PlantedFault|OtherFaults|ChangesNoBit"
        compares+="|OnAnyNumberOfThreads|IslandsThatAreCut|Catalog.(SameSeed|OtherSeed)"
        local repeats="KeepsItsBounds/H(37|43|47|48|72)|Catalog[.]|PeerScene|SolidScenes|ATerrainOfTheCata"
        repeats+="|ProgressIs|Bench.ValuesOfADial|ConvexCover.T|ConvexParts.(ErrorIs|SizeChanges)"
        repeats+="|PartsCache.Damaged|Friction.OfEveryKind|Subdivide.WhatIsJammed|SplitImpulses.ThinSolids"
        # Methods held against one another, or against plain sums, on thousands of random shapes.
        local agree="MeshPairs.WhatIsApart|Friction.HoldsOnASlope|SurfaceSeparations.TheLeast|QueryGjk.RightOn"
        agree+="|QuerySat.FastAndPlain|ImpactOf(Spheres|Surfaces).IsNever|Containment.(Agrees|FacesThat)"
        agree+="|KDop(Tree)?.NeverParts|Finders.AgreeStep|Direct.(AgreesWith|Heaps)|ChungWang.(Agrees|Climb)"
        agree+="|ClipVolume.YesAndNo|WideHull.Tells|KnownApart.Pairs|BoxPairs.AgreeWith|HullHull.LargeHulls"
        agree+="|StepGraph.MatchesRunInOrder"
        # It compares two times, of which a checker slows one more than the other.
        local times="BuildHull.TipsOfManyFacesTakeNoLonger"
        which+=(-E "$compares|$repeats|$agree|$times")
    fi
    [[ -z ${2:-} ]] || which+=(--under "$2" --times "$root/build/test")
    "${steady[@]}" "$root/tools/test_groups.py" "$root/build/$1" -j "$(job_count)" "${which[@]}"
}
