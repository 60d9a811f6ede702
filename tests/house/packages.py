#!/usr/bin/env python3
"""packages.py FOLDER SOURCE ARCHITECTURE [NATIVE]: Debian's packages of ARCHITECTURE in FOLDER: names, fields, what is in them,
what they depend on, and lintian's opinion. NATIVE is the folder with those of this machine, when ARCHITECTURE is another:
what accrete-tools depends on was taken from there, which is right as long as both programs need the same."""
import filecmp
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import shell

TRIPLES = {"amd64": "x86_64-linux-gnu", "arm64": "aarch64-linux-gnu", "armhf": "arm-linux-gnueabihf",
           "riscv64": "riscv64-linux-gnu"}
PACKAGES = {
    "libaccrete-dev": ("libdevel", "same", [r"include/accrete/\w+\.h", r"include/accrete/interop/(eigen|opencv)\.h", r"lib/@/libaccrete\.a", r"lib/@/pkgconfig/accrete\.pc",
                                            r"lib/@/cmake/accrete/accrete(Config|ConfigVersion|Targets(-\w+)?)\.cmake"]),
    "libaccrete-hal-dev": ("libdevel", "same", [r"include/accrete/hal/\w+\.h", r"lib/@/libaccrete_hal\.a",
                                                r"lib/@/pkgconfig/accrete-hal\.pc",
                                                r"lib/@/cmake/accrete/accreteHalTargets(-\w+)?\.cmake"]),
    "accrete-tools": ("science", "foreign", [r"bin/accrete", r"share/man/man1/accrete\.1\.gz",
                                             r"share/bash-completion/completions/accrete"])}
DOC = ["copyright", r"changelog\.gz", r"changelog\.Debian\.gz"]
# lintian's tags that do not hold here, and why.
NOT_HERE = {"bogus-mail-host": "accrete@localhost: the project has no address; who gives packages away sets ACCRETE_MAINTAINER",
            "bogus-mail-host-in-debian-changelog": "the same address"}


def field(deb, name):
    return shell.run("dpkg-deb", "-f", deb, name).strip()


def contents(deb):
    """(mode, owner, path without ./usr/) of all that is no folder; a folder of another mode is listed, too."""
    found = []
    for line in shell.run("dpkg-deb", "-c", deb).splitlines():
        mode, owner, *_, path = line.split(None, 5)
        if not mode.startswith("drwxr-xr-x") or owner != "root/root":
            found.append((mode, owner, re.sub(r"^\./(usr/)?", "", path)))
    return found


def check_contents(deb, name, patterns, triple):
    problems, there = [], contents(deb)
    patterns = [p.replace("@", triple) for p in patterns] + ["share/doc/%s/%s" % (name, p) for p in DOC]
    for mode, owner, path in there:
        if mode != ("-rwxr-xr-x" if path.startswith("bin/") else "-rw-r--r--") or owner != "root/root":
            problems.append("%s: %s is %s of %s" % (name, path, mode, owner))
        if not any(re.fullmatch(p, path) for p in patterns):
            problems.append("%s: nobody asked for %s" % (name, path))
    for p in patterns:
        if not any(re.fullmatch(p, path) for _, _, path in there):
            problems.append("%s lacks %s" % (name, p))
    return problems


def depends(deb):
    """{package: conditions}"""
    found = {}
    for part in filter(None, field(deb, "Depends").split(", ")):
        package, *condition = part.split(" ", 1)
        found.setdefault(package, []).extend(condition)
    return found


def owner_of(path):
    """The package of a file; /lib is a link to /usr/lib, and packages know one of both names."""
    path = os.path.realpath(path)
    for name in (path, path.removeprefix("/usr")):
        said = subprocess.run(["dpkg", "-S", name], capture_output=True, text=True)
        if said.returncode == 0:
            return said.stdout.split(":")[0]
    return "nobody's " + path


def check_hal(deb, unpacked, version):
    """Every module that accrete-hal.pc asks for comes out of a package that is named."""
    found, problems = depends(deb), []
    if found.pop("libaccrete-dev", []) != ["(= %s)" % version]:
        problems.append("libaccrete-hal-dev does not depend on its own libaccrete-dev")
    pc = glob.glob(unpacked + "/usr/lib/*/pkgconfig/accrete-hal.pc")[0]
    with open(pc, encoding="utf-8") as f:
        modules = re.search(r"^Requires.private: (.*)", f.read(), re.M).group(1).split()
    for module in modules:
        file = shell.run("pkg-config", "--variable=pcfiledir", module).strip() + "/" + module + ".pc"
        if owner_of(file) not in found:
            problems.append("accrete-hal.pc asks for %s, and libaccrete-hal-dev does not depend on %s" % (module, owner_of(file)))
    return problems


def needs(program):
    """(libraries, {library: newest version of symbols}) of an ELF file of any architecture."""
    said = shell.run("readelf", "-dVW", program)
    libraries = set(re.findall(r"\(NEEDED\).*\[(.*)\]", said))
    versions = {}
    for kind, number in re.findall(r"Name: (GLIBC|GLIBCXX|CXXABI|GCC)_([\d.]+)", said):
        versions[kind] = max(versions.get(kind, ()), tuple(int(n) for n in number.split(".")))
    return {name for name in libraries if not name.startswith("ld-linux")}, versions


def check_tools(deb, program, native):
    problems, found = [], depends(deb)
    libraries, versions = needs(program)
    if native is None:  # what the libraries belong to on this machine
        places = dict(re.findall(r"(\S+) => (\S+)", shell.run("ldd", program)))
        wanted = {owner_of(places[name]) for name in libraries}
        if set(found) != wanted:
            problems.append("accrete-tools depends on %s, its libraries belong to %s" % (sorted(found), sorted(wanted)))
        return problems
    with tempfile.TemporaryDirectory() as folder:
        other = glob.glob(native + "/accrete-tools_*_%s.deb" % shell.run("dpkg", "--print-architecture").strip())[0]
        shell.run("dpkg-deb", "-x", other, folder)
        native_libraries, native_versions = needs(folder + "/usr/bin/accrete")
    if found != depends(other):
        problems.append("accrete-tools depends on something else than the native one")
    if libraries != native_libraries:
        problems.append("not the native libraries: " + ", ".join(sorted(libraries ^ native_libraries)))
    for kind in versions:
        if versions[kind] > native_versions.get(kind, ()):
            problems.append("%s is newer than natively: %s, %s" % (kind, versions[kind], native_versions.get(kind)))
    return problems


def check_shared_files(deb, unpacked, native):
    """Multi-Arch: same promises that two architectures have the same bytes where they have the same path."""
    problems = []
    with tempfile.TemporaryDirectory() as folder:
        shell.run("dpkg-deb", "-x", re.sub(r"_\w+\.deb$", "_%s.deb" % shell.run("dpkg", "--print-architecture").strip(),
                                           native + "/" + os.path.basename(deb)), folder)
        for base, _, names in os.walk(unpacked):
            for path in (os.path.join(base, name) for name in names):
                other = folder + path.removeprefix(unpacked)
                if os.path.exists(other) and not filecmp.cmp(path, other, shallow=False):
                    problems.append("%s is another file natively" % path.removeprefix(unpacked))
    return problems


def check_lintian(debs):
    if not shutil.which("lintian"):
        print("lintian is not here: its part is left out")
        return []
    said = subprocess.run(["lintian", "--allow-root", "--no-cfg", "--fail-on", "error,warning", "--suppress-tags",
                           ",".join(NOT_HERE), *debs], capture_output=True, text=True)
    return (said.stdout + said.stderr).splitlines() if said.returncode != 0 else []


def check(folder, source, architecture, native=None):
    with open(source + "/include/accrete/version.h", encoding="utf-8") as f:
        version = re.search(r'kVersion\[\] = "(.*)"', f.read()).group(1) + "-0accrete1"
    problems, debs = [], []
    for name, (section, multi_arch, patterns) in PACKAGES.items():
        deb = "%s/%s_%s_%s.deb" % (folder, name, version, architecture)
        if not os.path.exists(deb):
            return ["%s was not made; there are: %s" % (deb, " ".join(os.listdir(folder)))]
        debs.append(deb)
        for key, wanted in (("Package", name), ("Version", version), ("Architecture", architecture), ("Source", "accrete"),
                            ("Section", section), ("Multi-Arch", multi_arch), ("Priority", "optional")):
            if field(deb, key) != wanted:
                problems.append("%s: %s is '%s', not '%s'" % (name, key, field(deb, key), wanted))
        problems += check_contents(deb, name, patterns, TRIPLES[architecture])
        with tempfile.TemporaryDirectory() as unpacked:
            shell.run("dpkg-deb", "-x", deb, unpacked)
            with open("%s/usr/share/doc/%s/copyright" % (unpacked, name), encoding="utf-8") as f, \
                    open(source + "/LICENSE", encoding="utf-8") as licence:
                if f.read() != licence.read():
                    problems.append("%s: copyright is not LICENSE" % name)
            if native and multi_arch == "same":
                problems += check_shared_files(deb, unpacked, native)
            if name == "libaccrete-dev" and depends(deb):
                problems.append("the core needs nothing, but libaccrete-dev depends on " + field(deb, "Depends"))
            if name == "libaccrete-hal-dev":
                problems += check_hal(deb, unpacked, version)
            if name == "accrete-tools":
                problems += check_tools(deb, unpacked + "/usr/bin/accrete", native)
    return problems + check_lintian(debs)


if __name__ == "__main__":
    if len(sys.argv) not in (4, 5):
        sys.exit(__doc__)
    found_problems = check(*sys.argv[1:])
    print("\n".join(found_problems) if found_problems else "the packages for %s are sound" % sys.argv[3])
    sys.exit(1 if found_problems else 0)
