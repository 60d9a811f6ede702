#!/usr/bin/env bash
# boot.sh PREPARED OUT SCRIPT [SECONDS]: boots the guest, runs SCRIPT in it, prints the console, returns SCRIPT's status.
# 125: the guest gave none within SECONDS (kernel panic, hang, qemu failed). OUT is the folder that the guest may write.
set -uo pipefail
prepared=$(readlink -f "$1")
mkdir -p "$2"
out=$(readlink -f "$2")
script=$(readlink -f "$3")
limit=${4:-300}

# TCG, never KVM: the tests must mean the same on every machine, and a stock kernel hangs on some hosts' /dev/kvm.
# The clock is HPET's, which is the host's: on a busy host the kernel measures its faster one, the processor's, so badly that
# a second took anything from 0.15 s to 1.8 s.
# One processor is faster and steadier than two under TCG (measured: 17 s against 25 s).
timeout "$limit" qemu-system-x86_64 -accel tcg -machine q35 -cpu max -smp 1 -m 1024 \
  -nodefaults -no-user-config -display none -no-reboot -serial stdio \
  -kernel "$prepared/vmlinuz" -initrd "$prepared/initrd.gz" \
  -append "console=ttyS0 quiet panic=-1 mitigations=off no_timer_check clocksource=hpet random.trust_cpu=on accrete.script=$script accrete.out=$out" \
  -virtfs local,path=/,mount_tag=root,security_model=none,readonly=on,multidevs=remap \
  -virtfs "local,path=$out,mount_tag=out,security_model=none" \
  </dev/null 2>&1 | tr -d '\r' | tee "$out/console.log"
status=$(sed -n 's/^accrete guest: status \([0-9]*\) .*/\1/p' "$out/console.log" | tail -n 1)
if [ -z "$status" ]; then
  echo "boot.sh: the guest gave no status within $limit s"
  exit 125
fi
exit "$status"
