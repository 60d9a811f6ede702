#!/bin/busybox sh
# shellcheck shell=dash
# The first process of the guest. Its root is the host's, read-only; only the output folder can be written. The kernel's
# command line has accrete.script=SCRIPT and accrete.out=FOLDER, both as the host names them.
b=/bin/busybox
$b mount -t proc proc /proc
$b mount -t sysfs sysfs /sys
$b mount -t devtmpfs devtmpfs /dev

finish() { # the host reads the status from this line of the console
  $b sync
  $b echo "accrete guest: status $1 after $($b cut -d ' ' -f 1 /proc/uptime) s"
  $b poweroff -f
}
parameter() { $b sed -n "s/.*accrete\\.$1=\\([^ ]*\\).*/\\1/p" /proc/cmdline; }
share() { $b mount -t 9p -o "trans=virtio,version=9p2000.L,msize=512000,$2" "$1" "$3" || finish 120; }

for module in $($b cat /modules/share); do $b insmod "/modules/$module"; done
share root cache=loose,ro /host # loose: nobody changes these files during a run
for folder in proc sys dev; do $b mount --bind /$folder /host/$folder; done
$b mount -t tmpfs tmpfs /host/run
out=$(parameter out)
share out cache=none,rw "/host$out"
$b mkdir /host/run/modules /host/run/tmp
$b cp /modules/* /host/run/modules/
$b cp $b /host/run/busybox

$b chroot /host /usr/bin/env -i PATH=/usr/local/bin:/usr/sbin:/usr/bin:/sbin:/bin HOME=/run TMPDIR=/run/tmp \
  OUT="$out" /bin/bash "$(parameter script)" </dev/null
finish $?
