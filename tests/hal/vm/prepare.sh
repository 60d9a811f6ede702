#!/usr/bin/env bash
# prepare.sh FOLDER: makes FOLDER/vmlinuz and FOLDER/initrd.gz out of Debian's stock kernel package, which is only unpacked.
# The initramfs holds busybox and the modules of the camera tests; everything else the guest finds on the host (init.sh).
# Status 3: the package cannot be had.
set -euo pipefail
here=$(dirname "$(readlink -f "${BASH_SOURCE[0]}")")
mkdir -p "${1:?folder}"
cd "$1"
PATH=$PATH:/usr/sbin:/sbin

# The real package behind Debian's "the newest kernel"; its name moves with every security update.
package=$(apt-cache depends linux-image-amd64 2>/dev/null | awk '/Depends:/ { print $2; exit }')
[ -n "$package" ] || { echo "apt knows no package linux-image-amd64 (apt-get update?)" && exit 3; }
version=${package#linux-image-}

if [ ! -e "unpacked/lib/modules/$version/modules.dep" ]; then
  rm -rf unpacked ./*.deb
  apt-get -q download "$package" || exit 3
  mkdir unpacked
  # Not the drivers of graphics, sound and network cards, which are most of the 391 MB.
  dpkg-deb --fsys-tarfile "$package"_*.deb | tar -x -C unpacked --wildcards './boot/vmlinuz-*' \
    './lib/modules/*/modules.*' './lib/modules/*/kernel/drivers/media/*' './lib/modules/*/kernel/drivers/usb/*' \
    './lib/modules/*/kernel/drivers/virtio/*' './lib/modules/*/kernel/drivers/input/*' \
    './lib/modules/*/kernel/net/9p/*' './lib/modules/*/kernel/fs/9p/*' './lib/modules/*/kernel/fs/netfs/*' \
    './lib/modules/*/kernel/fs/fscache/*' './lib/modules/*/kernel/lib/*' './lib/modules/*/kernel/crypto/*'
  rm ./*.deb
  depmod -b unpacked "$version"
fi

# modules/NAME lists a group's modules in the order in which they must be inserted.
rm -rf root
mkdir -p root/{bin,dev,proc,sys,host,modules}
cp "$(command -v busybox)" root/bin/busybox
while read -r name modules; do
  for module in $modules; do modprobe -d unpacked -S "$version" --show-depends "$module"; done |
    awk '$1 == "insmod" && !seen[$2]++ { print $2 }' | while read -r file; do
      basename "$file" .xz >>"root/modules/$name"
      cp "$file" root/modules/
    done
done <<'GROUPS'
share virtio_pci 9pnet_virtio 9p
vivid vivid
uvc vhci_hcd uvcvideo
GROUPS
for file in root/modules/*.xz; do [ ! -e "$file" ] || xz -d "$file"; done # from Debian 13 on
strip --strip-debug root/modules/*.ko
install -m 755 "$here/init.sh" root/init
(cd root && find . | cpio -o -H newc -R 0:0 --quiet | gzip -1) >initrd.gz
cp "unpacked/boot/vmlinuz-$version" vmlinuz
