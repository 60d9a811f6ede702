#!/usr/bin/env bash
# control.sh PREPARED OUT [--short]: negative controls. A failure, a panic and a hang of the guest must be failures here, and
# the guest must not be able to write to the host.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
prepared=$1
out=$2
mkdir -p "$out"

expect() { # STATUS SECONDS NAME, and the guest's script on standard input
  local status=0 script=$out/$3.sh
  cat >"$script"
  "$here/boot.sh" "$prepared" "$out/$3" "$script" "$2" >/dev/null || status=$?
  if [ "$status" != "$1" ]; then
    echo "control '$3': status $status instead of $1; its console is $out/$3/console.log" >&2
    exit 1
  fi
}

# 7 also says that the output folder could be written, and nothing else.
expect 7 60 failure <<'GUEST'
set -e
touch "$OUT/written"
if touch /usr/written 2>/dev/null; then exit 1; fi
exit 7
GUEST
expect 125 60 panic <<'GUEST'
echo 1 >/proc/sys/kernel/sysrq
echo c >/proc/sysrq-trigger
GUEST
[ "${3:-}" = --short ] || expect 125 25 hang <<'GUEST'
sleep 1000
GUEST
