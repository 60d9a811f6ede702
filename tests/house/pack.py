#!/usr/bin/env python3
"""pack.py SOURCE BUILD WORK: Debian's packages of what BUILD has compiled, and packages.py on them.

Debian's folders have to be configured (/usr/lib/TRIPLE), so WORK/build is a configuration of its own. It compiles nothing:
libraries, program and page are BUILD's."""
import glob
import os
import shutil
import sys

import packages
import shell

MADE = ["src/libaccrete.a", "hal/libaccrete_hal.a", "src/cli/accrete", "accrete.1"]


def configure(source, build, work):
    with open(build + "/CMakeCache.txt", encoding="utf-8") as f:
        cache = dict(line.rstrip("\n").split("=", 1) for line in f if "=" in line and line[0].isalpha())
    same = ["-D%s=%s" % (key, cache[key]) for key in cache
            if key.startswith(("CMAKE_BUILD_TYPE:", "CMAKE_CXX_COMPILER:", "CMAKE_MAKE_PROGRAM:", "ACCRETE_"))
            and not key.startswith(("ACCRETE_TESTS:", "ACCRETE_GXX:", "ACCRETE_CLANGXX:"))]
    shell.run("cmake", "-S", source, "-B", work, "-G", "Ninja", "-DCMAKE_INSTALL_PREFIX=/usr", "-DACCRETE_TESTS=OFF", *same)
    for name in MADE:
        os.makedirs(os.path.dirname(os.path.join(work, name)), exist_ok=True)
        shutil.copy2(os.path.join(build, name), os.path.join(work, name))


def pack(work, folder):
    """The date is 1 January 2026."""
    shutil.rmtree(folder, ignore_errors=True)
    shell.run("cpack", "--config", work + "/CPackConfig.cmake", "-B", folder, SOURCE_DATE_EPOCH="1767225600")
    shutil.rmtree(folder + "/_CPack_Packages")


def installed(work, prefix):
    """What `cmake --install` brings, as packages.py names it."""
    shutil.rmtree(prefix, ignore_errors=True)
    shell.run("cmake", "--install", work, "--prefix", prefix)
    there = {os.path.relpath(os.path.join(base, name), prefix) for base, _, names in os.walk(prefix) for name in names}
    return {path + ".gz" if "/man/" in path else path for path in there if not path.startswith("share/doc/")}


def main(source, build, work):
    for program in ("cpack", "dpkg-deb", "dpkg-shlibdeps", "ninja"):
        if not shutil.which(program):
            print("skipped: there is no %s here" % program)
            return shell.SKIPPED
    folder, architecture = work + "/packages", shell.run("dpkg", "--print-architecture").strip()
    configure(source, build, work + "/build")
    pack(work + "/build", folder)
    packed = {path for deb in glob.glob(folder + "/*.deb") for _, _, path in packages.contents(deb)}
    problems = ["%s is installed, but is in no package" % p for p in sorted(installed(work + "/build", work + "/prefix") - packed)]
    problems += packages.check(folder, source, architecture)
    # Of a package that is broken on purpose the check must not say that it is sound.
    deb = glob.glob(folder + "/libaccrete-dev_*.deb")[0]
    broken = work + "/broken"
    shutil.rmtree(broken, ignore_errors=True)
    shell.run("dpkg-deb", "-R", deb, broken)
    os.chmod(broken + "/usr/include/accrete/version.h", 0o600)
    os.remove(broken + "/usr/share/doc/libaccrete-dev/changelog.gz")
    shell.run("dpkg-deb", "--root-owner-group", "-b", broken, work + "/broken.deb")
    name, (_, _, patterns) = "libaccrete-dev", packages.PACKAGES["libaccrete-dev"]
    if len(packages.check_contents(work + "/broken.deb", name, patterns, packages.TRIPLES[architecture])) != 2:
        problems.append("a broken package was found sound")
    print("\n".join(problems) if problems else "the packages are sound, a broken one was found")
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
