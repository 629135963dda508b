#!/usr/bin/env bash
# Format: rewrites C++ files as .clang-format says; --check only names those that differ.
#   tools/format.sh [--check] [FILE]...      without files: all of the tree
set -euo pipefail
cd "$(dirname "$(readlink -f "$0")")/.."

rewrite() { clang-format-14 -i "$1"; }
compare() { clang-format-14 "$1" | cmp -s - "$1" || { echo "$1: tools/format.sh would change it"; return 1; }; }
export -f rewrite compare

what=rewrite
if [[ ${1:-} == --check ]]; then
    what=compare
    shift
fi
files=("$@")
if ((${#files[@]} == 0)); then
    mapfile -t files < <(git ls-files --cached --others --exclude-standard '*.cpp' '*.hpp')
fi
for file in "${files[@]}"; do
    # A file that was removed is still listed until that is committed.
    [[ ! -e $file ]] || printf '%s\0' "$file"
done | xargs -0r -n 1 -P "$(nproc)" bash -c "$what"' "$0"'
