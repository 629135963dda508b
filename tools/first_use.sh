#!/usr/bin/env bash
# First use: the launcher on a Debian that has nothing but its base, timed.
#   tools/first_use.sh      needs root; takes three minutes and 2 GB in TMPDIR
#
# What is committed is looked at. Exits 1 where a first run ends in anything but a simulation, or
# takes more than 300 s of processor time, packages included.
set -euo pipefail
root=$(dirname "$(dirname "$(readlink -f "$0")")")
source "$root/tools/build.sh"
limit=300  # of processor time, seconds
((EUID == 0)) || { say "needs root, to install packages beside this system"; exit 2; }
need_packages debootstrap git

bare=$(mktemp -d)
leave() {
    local folder
    for folder in dev proc; do
        if mountpoint -q "$bare/$folder"; then umount "$bare/$folder"; fi
    done
    rm -rf --one-file-system "$bare"
}
trap leave EXIT
say "a bare Debian"
mkdir -p "$root/build"
debootstrap --variant=minbase bookworm "$bare" >"$root/build/first_use.log"
mount -t proc proc "$bare/proc"
mount --bind /dev "$bare/dev"
cp /etc/resolv.conf "$bare/etc/"
git clone --quiet "$root" "$bare/root/throng"

TIMEFORMAT="%R %U %S"
{ time chroot "$bare" /root/throng/throng run pile:100 --steps 10 >&3 2>&3; } 3>&2 2>"$bare/times"
read -r clock user system <"$bare/times"
spent=$(awk -v u="$user" -v s="$system" 'BEGIN { printf "%.0f", u + s }')
say "first use: $clock s by the clock, $spent s of processor time (at most $limit)"
((spent <= limit))
