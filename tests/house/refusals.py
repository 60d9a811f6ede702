#!/usr/bin/env python3
"""refusals.py SOURCE COMPILER CLANG: what does not fit is refused while configuring, with a sentence; what is optional and
absent costs one line and one feature."""
import json
import os
import re
import shutil
import sys
import tempfile

import shell

# Packages that the hardware layer can do without; libcamera is found through PkgConfig.
OPTIONAL = ["PNG", "libjpeg-turbo", "yaml-cpp", "PkgConfig"]
FOUND_OLD_EIGEN = "set(Eigen3_VERSION 3.3.9)\nset(Eigen3_FOUND TRUE)\n"


class Tree:
    """Configures SOURCE in a folder of its own, again and again: what a compiler can do is asked once."""

    def __init__(self, source, folder, compiler):
        self.folder = folder
        self.command = ["cmake", "-S", source, "-B", folder, "-DCMAKE_CXX_COMPILER=" + compiler, "-DCMAKE_BUILD_TYPE=Release",
                        "-DACCRETE_TESTS=OFF"]

    def says(self, pattern, *options, fails):
        said = shell.run(*self.command, *options, fails=fails)
        plain = " ".join(said.split())  # CMake breaks lines
        found = re.findall(pattern, plain)
        if len(found) != 1:
            sys.exit("%s\n%s\nexpected '%s' once, it is there %d times" % (" ".join(self.command + list(options)), said, pattern,
                                                                        len(found)))
        return plain


def old_cmake(source, folder):
    """The first command refuses an older CMake; here, this one by a version that is newer still."""
    with open(source + "/CMakeLists.txt", encoding="utf-8") as f:
        first = f.readline()
    with open(source + "/CMakePresets.json", encoding="utf-8") as f:
        presets = json.load(f)["cmakeMinimumRequired"]
    needed = re.fullmatch(r"cmake_minimum_required\(VERSION (\d+\.\d+)\)\n", first)
    if not needed or needed.group(1) != "%(major)d.%(minor)d" % presets:
        sys.exit("CMakeLists.txt begins with '%s', the presets need %s" % (first.strip(), presets))
    script = folder + "/first.cmake"
    with open(script, "w", encoding="utf-8") as f:
        f.write(first.replace(needed.group(1), "99.0"))
    if "99.0 or higher is required" not in shell.run("cmake", "-P", script, fails=True):
        sys.exit("an old CMake is not told what is required")


def old_compiler(source, folder, compiler, flags, sentence):
    """The compiler itself, which takes itself for an older one."""
    fake = folder + "/old-" + os.path.basename(compiler)
    with open(fake, "w", encoding="utf-8") as f:
        f.write('#!/bin/sh\nexec "%s" %s "$@"\n' % (compiler, flags))
    os.chmod(fake, 0o755)
    Tree(source, fake + "-build", fake).says(sentence, fails=True)


def static_packages(tree, folder):
    """Packages whose targets have the names of a static build, or of a newer version."""
    options = ["-DACCRETE_HAL=ON", "-DACCRETE_TOOLS=OFF", "-DACCRETE_WITH_JPEG=ON", "-DACCRETE_WITH_YAML=ON"]
    for package, target in (("libjpeg-turbo", "libjpeg-turbo::turbojpeg-static"), ("yaml-cpp", "yaml-cpp::yaml-cpp")):
        os.makedirs(folder + "/" + package)
        with open("%s/%s/%sConfig.cmake" % (folder, package, package), "w", encoding="utf-8") as f:
            f.write("add_library(%s INTERFACE IMPORTED GLOBAL)\n" % target)
        options.append("-D%s_DIR=%s/%s" % (package, folder, package))
    tree.says("Configuring done", *options, fails=False)
    with open(tree.folder + "/accreteConfig.cmake", encoding="utf-8") as f:
        if not {"find_dependency(libjpeg-turbo)", "find_dependency(yaml-cpp)"} <= set(f.read().split()):
            sys.exit("what the hardware layer was linked with is not looked for")


def is_clang(compiler):
    return "clang" in shell.run(compiler, "--version")


def main(source, compiler, clang):
    if shutil.which("ninja"):
        os.environ["CMAKE_GENERATOR"] = "Ninja"
    with tempfile.TemporaryDirectory() as folder:
        old_cmake(source, folder)
        if not is_clang(compiler):
            old_compiler(source, folder, compiler, "-w -U__GNUC__ -D__GNUC__=11", r"accrete needs g\+\+ 12 or newer, found 11")
        if os.path.exists(clang):
            old_compiler(source, folder, clang, "-w -U__clang_major__ -D__clang_major__=13",
                         r"accrete needs clang\+\+ 14 or newer, found 13")
        tree = Tree(source, folder + "/build", compiler)
        core = ("-DACCRETE_HAL=OFF",)
        eigen = folder + "/eigen"
        os.mkdir(eigen)
        with open(eigen + "/Eigen3Config.cmake", "w", encoding="utf-8") as f:
            f.write(FOUND_OLD_EIGEN)
        tree.says(r"accrete needs Eigen 3\.4 or newer, found 3\.3\.9 in " + re.escape(eigen), "-DEigen3_DIR=" + eigen, *core,
                  fails=True)
        tree.says(r"accrete needs Eigen 3\.4 or newer, found none", "-UEigen3_DIR", "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON",
                  *core, fails=True)
        tree.says("Configuring done", "-UCMAKE_DISABLE_FIND_PACKAGE_Eigen3", *core, "-DACCRETE_MARCH=native", fails=False)
        refused = " ".join(shell.run("cmake", "--install", folder + "/build", "--prefix", folder + "/x", fails=True).split())
        if "for native alone" not in refused:
            sys.exit("a build for one machine must say why it is not installed: " + refused)

        static_packages(Tree(source, folder + "/static", compiler), folder)
        without = ["-DACCRETE_HAL=ON", "-DACCRETE_TOOLS=OFF", "-UACCRETE_MARCH"]
        without += ["-DCMAKE_DISABLE_FIND_PACKAGE_%s=ON" % p for p in OPTIONAL]
        said = tree.says("Configuring done", *without, fails=False)
        with open(folder + "/build/CMakeCache.txt", encoding="utf-8") as f:
            names = re.findall(r"^ACCRETE_WITH_(\w+):STRING=AUTO$", f.read(), re.M)
        with open(folder + "/build/accrete-hal.pc", encoding="utf-8") as pc, open(folder + "/build/accreteConfig.cmake",
                                                                                 encoding="utf-8") as config:
            if not re.search(r"^Requires\.private: *$", pc.read(), re.M) or "PNG" in config.read():
                sys.exit("users would have to find packages that the hardware layer was not linked with")
        if len(names) < 3:
            sys.exit("what is optional? Found %s only" % names)
        for name in names:
            if len(re.findall(r"-- accrete: [^-]* OFF \(ACCRETE_WITH_%s=AUTO" % name, said)) != 1:
                sys.exit("without %s there must be one line about ACCRETE_WITH_%s:\n%s" % (", ".join(OPTIONAL), name, said))
            tree.says(r"ACCRETE_WITH_%s=ON, but [^:]* was not found: install " % name, "-DACCRETE_WITH_%s=ON" % name, fails=True)
            tree.says("Configuring done", "-DACCRETE_WITH_%s=AUTO" % name, fails=False)
        tree.says(r"-- accrete: the program's commands are OFF \(ACCRETE_TOOLS=AUTO;.* PNG not found; Debian:.* libpng-dev\)",
                  "-DACCRETE_TOOLS=AUTO", fails=False)
        tree.says(r"ACCRETE_TOOLS=ON, but.* PNG not found: install.* libpng-dev", "-DACCRETE_TOOLS=ON", fails=True)
    print("refused with a sentence, or left out with a line")
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
