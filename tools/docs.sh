#!/usr/bin/env bash
# Docs: build/docs/api, pages of the public headers by Doxygen, warnings as errors.
#   tools/docs.sh          installs doxygen where it is missing, and says so
#   tools/docs.sh --check  makes them into a folder of its own and throws them away; leaves with 77,
#                          which test runners count as skipped, where there is no doxygen
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "$0")")")
cd "$root"
source tools/build.sh

if [[ ${1:-} == --check ]]; then
    command -v doxygen >/dev/null || { say "doxygen is not installed"; exit 77; }
    THRONG_DOCS=$(mktemp -d)
    trap 'rm -rf "$THRONG_DOCS"' EXIT
else
    mkdir -p build
    need_packages "${docs_packages[@]}"
    THRONG_DOCS=$root/build/docs
    rm -rf "$THRONG_DOCS/api"
    mkdir -p "$THRONG_DOCS"
fi
export THRONG_DOCS
doxygen docs/Doxyfile || { say "the public headers do not pass Doxygen without warnings"; exit 1; }
[[ ${1:-} == --check ]] || say "build/docs/api/index.html"
