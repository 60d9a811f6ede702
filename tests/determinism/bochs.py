#!/usr/bin/env python3
"""An x86-64 processor with AVX-512 for machines that have none: Debian's Bochs, which interprets it. About 40 million
instructions a second; the guest is up after 20 s.

bochs.py FOLDER PROGRAM [ARGUMENT ...] [-- PROGRAM [ARGUMENT ...]] ...
    runs programs in it, prints what they print and ends with the greatest of their statuses; with 77, and does nothing,
    where this processor has AVX-512 or Bochs cannot be had. FOLDER: for the kernel (27 MB, fetched once) and the
    guest's disk.

The guest is Debian's kernel for cloud machines (the others take a minute longer to unpack themselves) with an initramfs of
busybox, the programs and the libraries that they need. It has no disk to write on and no network."""
import glob
import os
import pty
import re
import shutil
import subprocess
import sys
import time
import tty

ISOLINUX = ("/usr/lib/ISOLINUX/isolinux.bin", "/usr/lib/syslinux/modules/bios/ldlinux.c32")
BIOS, VGA = "/usr/share/bochs/BIOS-bochs-latest", "/usr/share/bochs/VGABIOS-lgpl-latest"
WITHOUT = "this guest has no AVX-512"  # what asks the processor would leave it out, and pass
TOOLS = ("bochs", "genisoimage", "busybox", "cpio", "gzip", "ldd", "apt-get", "dpkg-deb")

# clearcpuid: Bochs 2.7 gives another size of the compact save area than the kernel computes, which then does without any
# and so without AVX. The rest saves time: 100 s of messages over the serial line, among others.
KERNEL_OPTIONS = ("clearcpuid=xsavec,xsaves console=ttyS0,115200 loglevel=0 nokaslr panic=-1 mitigations=off "
                  "no_timer_check random.trust_cpu=on cryptomgr.notests=1 lpj=1000000 acpi=off")
CONFIGURATION = """\
plugin_ctrl: unmapped=0, biosdev=0, speaker=0, extfpuirq=0, parallel=0, gameport=0, iodebug=0
config_interface: textconfig
display_library: term
cpu: model=corei7_skylake_x, count=1, ips=100000000, reset_on_triple_fault=0
megs: 512
romimage: file=%s
vgaromimage: file=%s
ata0-master: type=cdrom, path=disk.iso, status=inserted
boot: cdrom
com1: enabled=1, mode=file, dev=serial.txt
clock: sync=none
log: bochs.log
""" % (BIOS, VGA)


class Unavailable(Exception):
    pass


def host_has_avx512():
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as f:
            flags = set(re.findall(r"avx512\w+", f.read()))
    except OSError:
        return False
    return {"avx512f", "avx512vl", "avx512bw", "avx512dq"} <= flags


def called(command, **options):
    result = subprocess.run(command, capture_output=True, **options)
    if result.returncode != 0:
        raise Unavailable("%s: %s" % (command[0], result.stderr.decode(errors="replace").strip().split("\n")[-1]))
    return result.stdout


def kernel(folder):
    depends = called(["apt-cache", "depends", "linux-image-cloud-amd64"]).decode()
    package = re.search(r"Depends: (\S+)", depends)
    if not package:
        raise Unavailable("apt knows no linux-image-cloud-amd64 (apt-get update?)")
    package = package.group(1)
    file = os.path.join(folder, package.replace("linux-image", "vmlinuz"))
    if not os.path.exists(file):
        called(["apt-get", "-q", "download", package], cwd=folder)
        archive = glob.glob(os.path.join(folder, package + "_*.deb"))[0]
        tar = called(["dpkg-deb", "--fsys-tarfile", archive])
        called(["tar", "-x", "-C", folder, "--strip-components=2", "./boot/" + os.path.basename(file)], input=tar)
        os.remove(archive)
    return file


def copy_in(root, path, to=None):
    target = root + (to or path)
    os.makedirs(os.path.dirname(target), exist_ok=True)
    shutil.copy(path, target)


def initramfs(folder, commands):
    root = os.path.join(folder, "root")
    shutil.rmtree(root, ignore_errors=True)
    for name in ("dev", "proc", "tmp"):
        os.makedirs(os.path.join(root, name))
    copy_in(root, shutil.which("busybox"), "/bin/busybox")
    script = ["#!/bin/busybox sh", "/bin/busybox mount -t proc proc /proc", "cd /tmp",
              "/bin/busybox grep -qw avx512bw /proc/cpuinfo || echo '%s'" % WITHOUT]
    for number, (program, *arguments) in enumerate(commands):
        copy_in(root, program, "/program%d" % number)
        needed = subprocess.run(["ldd", program], capture_output=True, text=True).stdout  # nothing of a static one
        for library in re.findall(r"(?:=> |^\s*)(/\S+)", needed, re.M):
            copy_in(root, library)
        quoted = " ".join("'%s'" % a.replace("'", "'\\''") for a in arguments)
        script += ["echo '<%d>'" % number, "/program%d %s 2>&1" % (number, quoted), 'echo "</%d $?>"' % number]
    with open(os.path.join(root, "init"), "w", encoding="utf-8") as f:
        f.write("\n".join(script) + "\nexec /bin/busybox sleep 100000\n")
    os.chmod(os.path.join(root, "init"), 0o755)
    names = "\n".join(os.path.relpath(os.path.join(base, n), root)
                      for base, folders, files in os.walk(root) for n in folders + files)
    archive = called(["cpio", "-o", "-H", "newc", "-R", "0:0", "--quiet"], cwd=root, input=names.encode())
    return called(["gzip", "-1"], input=archive)


def disk(folder, commands):
    where = os.path.join(folder, "disk")
    shutil.rmtree(where, ignore_errors=True)
    os.makedirs(where)
    for file in ISOLINUX:
        shutil.copy(file, where)
    shutil.copy(kernel(folder), os.path.join(where, "vmlinuz"))
    with open(os.path.join(where, "initrd.gz"), "wb") as f:
        f.write(initramfs(folder, commands))
    with open(os.path.join(where, "isolinux.cfg"), "w", encoding="utf-8") as f:
        f.write("default guest\nlabel guest\n kernel vmlinuz\n append initrd=initrd.gz %s\n" % KERNEL_OPTIONS)
    called(["genisoimage", "-quiet", "-o", os.path.join(folder, "disk.iso"), "-b", "isolinux.bin", "-c", "boot.cat",
            "-no-emul-boot", "-boot-load-size", "4", "-boot-info-table", where])


class Bochs:
    """Bochs with its display for terminals, the only one that asks neither for X nor for a port. It wants a terminal to read
    from, which hangs up when this program is killed, so that Bochs ends; and it draws on another, of which it says the name:
    when nobody reads there, it stands still after five minutes."""

    def __init__(self, folder):
        self.drawn, self.messages = None, os.path.join(folder, "messages.txt")
        self.keyboard, its = pty.openpty()
        with open(self.messages, "wb") as messages:
            self.process = subprocess.Popen(["setsid", "--ctty", "bochs", "-q", "-f", "bochsrc", "-rc", "go"], cwd=folder,
                                            stdin=its, stdout=subprocess.DEVNULL, stderr=messages,
                                            env=dict(os.environ, TERM="xterm"))
        os.close(its)

    def runs(self):
        """Is it still there? To be called every second or so: reads what was drawn."""
        if self.drawn is None:
            with open(self.messages, encoding="utf-8", errors="replace") as f:
                found = re.search(r'connected to screen "(/dev/pts/\d+)"', f.read())
            if found:
                self.drawn = os.open(found.group(1), os.O_RDWR | os.O_NOCTTY | os.O_NONBLOCK)
                tty.setraw(self.drawn)  # else only whole lines can be read
        try:
            while self.drawn is not None and os.read(self.drawn, 4096):
                pass
        except BlockingIOError:
            pass
        except OSError:  # it has ended
            os.close(self.drawn)
            self.drawn = None
        return self.process.poll() is None

    def end(self):
        self.process.kill()
        self.process.wait()
        os.close(self.keyboard)
        if self.drawn is not None:
            os.close(self.drawn)


def run(folder, commands, seconds):
    """[(status, output)] of the commands, one after the other in one guest. Raises Unavailable where it cannot be had."""
    missing = [t for t in TOOLS if not shutil.which(t)] + [f for f in ISOLINUX + (BIOS, VGA) if not os.path.exists(f)]
    if missing:
        raise Unavailable("there is no " + ", ".join(missing))
    folder = os.path.abspath(folder)
    os.makedirs(folder, exist_ok=True)
    disk(folder, commands)
    serial = os.path.join(folder, "serial.txt")
    if os.path.exists(serial):
        os.remove(serial)
    with open(os.path.join(folder, "bochsrc"), "w", encoding="utf-8") as f:
        f.write(CONFIGURATION)
    with open(os.path.join(folder, "go"), "w", encoding="utf-8") as f:
        f.write("c\n")  # Debian's Bochs starts in its debugger
    bochs, begin, text = Bochs(folder), time.time(), ""
    last = "</%d " % (len(commands) - 1)
    try:
        while last not in text or not text.endswith("\n"):
            time.sleep(0.5)
            if os.path.exists(serial):
                with open(serial, encoding="utf-8", errors="replace") as f:
                    text = f.read().replace("\r", "")
            if not bochs.runs() or "Kernel panic" in text or WITHOUT in text:
                raise RuntimeError("the guest in Bochs ended early: %s" % (text[-500:].strip() or "see %s/bochs.log" % folder))
            if time.time() - begin > seconds:
                raise RuntimeError("the guest in Bochs took more than %d s: %s" % (seconds, text[-500:].strip()))
    finally:
        bochs.end()
    found = [re.search(r"<%d>\n(.*?)</%d (\d+)>" % (i, i), text, re.S) for i in range(len(commands))]
    return [(int(f.group(2)), f.group(1)) for f in found]


def main(folder, words):
    commands = [[]]
    for word in words:
        if word == "--":
            commands.append([])
        else:
            commands[-1].append(word)
    if host_has_avx512():
        print("this processor has AVX-512: nothing to interpret")
        return 77
    try:
        results = run(folder, commands, 3600)
    except Unavailable as reason:
        print("no Bochs: %s" % reason)
        return 77
    for command, (status, output) in zip(commands, results):
        print("%s\n%s%s: status %d\n" % (" ".join(command), output, os.path.basename(command[0]), status))
    return max(status for status, _ in results)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        sys.exit(main(sys.argv[1], sys.argv[2:]))
    except RuntimeError as error:
        sys.exit("bochs.py: %s" % error)
