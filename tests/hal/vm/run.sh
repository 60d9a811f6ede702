#!/usr/bin/env bash
# run.sh BUILD PREPARED [--short]: the hardware layer's tests in the virtual machine that prepare.sh made. BUILD is a CMake
# build folder with the target vm_programs. Prints the parts and a last line "N passed, N failed, N skipped".
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
build=$(readlink -f "$1")
prepared=$(readlink -f "$2")
short=${3:-}
out=$build/vm
programs=$build/tests/hal/vm
rm -rf "$out"
mkdir -p "$out/guest" "$out/recordings"

"$here/control.sh" "$prepared" "$out/control" "$short"
echo "negative controls: ok"

frames=24
"$programs/vm_make_recording" "$out/recordings/grey" $frames grey
[ -n "$short" ] || "$programs/vm_make_recording" "$out/recordings/colour" $frames colour

cat >"$out/guest.sh" <<GUEST
PROGRAMS=$programs RECORDINGS=$out/recordings SHORT=$short
source $here/guest.sh
GUEST
status=0
"$here/boot.sh" "$prepared" "$out/guest" "$out/guest.sh" 1500 | grep -v '^\[ *[0-9.]*\] ' || status=1
count() { cat "$out"/guest/*.log | grep -c "^\[ *$1 *\] .*ms)$" || true; }
failed=$(count FAILED)
[ "$status" = 0 ] || [ "$failed" != 0 ] || failed=1 # what is no test: no status, or edges that differ
echo "$(count OK) passed, $failed failed, $(count SKIPPED) skipped"
[ "$failed" = 0 ]
