#!/usr/bin/env python3
"""consume.py WAY SOURCE PREFIX BUILD COMPILER WORK: a user's project, tests/install/WAY, built out of the tree in WORK and run.

find_package and pkg_config use what is installed in PREFIX, with other instruction sets than it was compiled for;
add_subdirectory and fetch_content use SOURCE, with the objects that BUILD has already (reuse_objects.py); cross compiles the
core for AArch64. None of them may find Eigen through us."""
import json
import os
import shutil
import sys

import shell

HERE = os.path.dirname(os.path.abspath(__file__))


def prepare(source, work, way):
    """A fresh folder with the project; what cross has compiled stays."""
    if way != "cross":
        shutil.rmtree(work, ignore_errors=True)
    os.makedirs(work, exist_ok=True)
    project = os.path.join(source, "tests/install")
    for folder in (os.path.join(project, way), project):
        for name in os.listdir(folder):
            if os.path.isfile(os.path.join(folder, name)):
                shutil.copy(os.path.join(folder, name), work)
    link = os.path.join(work, "accrete")
    if not os.path.islink(link):
        os.symlink(source, link)


def check_no_eigen(work):
    """The user's own files are compiled without a path to Eigen: a header that included it would not compile."""
    with open(work + "/build/compile_commands.json", encoding="utf-8") as f:
        commands = [entry["command"] for entry in json.load(f) if os.path.dirname(entry["file"]) == work]
    if not commands:
        sys.exit("no command of the user's project was found")
    for command in commands:
        if "eigen" in command.lower():
            sys.exit("we brought Eigen into a user's command: " + command)


def find_package(work, prefix, compiler, flags):
    shell.run("cmake", "-S", work, "-B", work + "/build", "-DCMAKE_PREFIX_PATH=" + prefix, "-DCMAKE_CXX_COMPILER=" + compiler,
              "-DCMAKE_BUILD_TYPE=Release", "-DCMAKE_CXX_FLAGS=" + flags, "-DCMAKE_DISABLE_FIND_PACKAGE_Eigen3=ON",
              "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
    shell.run("cmake", "--build", work + "/build")
    check_no_eigen(work)
    for wanted, sentence in (("0.1 COMPONENTS radar", "has no component radar"), ("99", "99")):
        os.makedirs(work + "/refused", exist_ok=True)
        with open(work + "/refused/CMakeLists.txt", "w", encoding="utf-8") as f:
            f.write("cmake_minimum_required(VERSION 3.25)\nproject(x CXX)\nfind_package(accrete %s REQUIRED)\n" % wanted)
        said = shell.run("cmake", "-S", work + "/refused", "-B", work + "/refused/build", "-DCMAKE_PREFIX_PATH=" + prefix,
                         "-DCMAKE_CXX_COMPILER=" + compiler, fails=True)
        if sentence not in said:
            sys.exit("find_package(accrete %s) was refused, but not for that:\n%s" % (wanted, said))
    return [work + "/build/robot", work + "/build/scene"]


def pkg_config(work, prefix, compiler, flags):
    folders = [base for base, _, names in os.walk(prefix) if "accrete.pc" in names]
    path = folders[0] + (":" + os.environ["PKG_CONFIG_PATH"] if os.environ.get("PKG_CONFIG_PATH") else "")
    core = shell.run("pkg-config", "--static", "--libs", "accrete", PKG_CONFIG_PATH=path).split()
    if [w for w in core if w.startswith("-l")] != ["-laccrete"] or "-pthread" in core:
        sys.exit("the core needs no other library, but accrete.pc says: " + " ".join(core))
    if "eigen" in shell.run("pkg-config", "--static", "--cflags", "accrete-hal", PKG_CONFIG_PATH=path).lower():
        sys.exit("accrete-hal.pc names Eigen")
    shell.run("./build.sh", cwd=work, PKG_CONFIG_PATH=path, CXX=(compiler + " " + flags).strip())
    return [work + "/robot", work + "/scene"]


def from_source(work, source, build, compiler):
    """The core as a part of the user's project, its objects out of our own build where the commands are the same."""
    log = work + "/launcher.log"
    launcher = ";".join([sys.executable, HERE + "/reuse_objects.py", build + "/compile_commands.json", source, log])
    with open(build + "/CMakeCache.txt", encoding="utf-8") as f:
        cache = dict(line.rstrip("\n").split("=", 1) for line in f if "=" in line and line[0].isalpha())
    same = ["-D%s=%s" % (key, cache[key]) for key in cache
            if key.startswith(("CMAKE_BUILD_TYPE:", "CMAKE_CXX_FLAGS:", "ACCRETE_DETERMINISTIC:", "ACCRETE_INSTRUCTION_SETS:"))]
    shell.run("cmake", "-S", work, "-B", work + "/build", "-DCMAKE_CXX_COMPILER=" + compiler,
              "-DCMAKE_CXX_COMPILER_LAUNCHER=" + launcher, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON", *same)
    shell.run("cmake", "--build", work + "/build", "--parallel", "2")
    check_no_eigen(work)
    with open(work + "/build/CMakeCache.txt", encoding="utf-8") as f:
        if "ACCRETE_WITH_PNG" in f.read():
            sys.exit("the hardware layer was configured, though nobody asked for it")
    with open(log, encoding="utf-8") as f:
        words = [line.split()[0] for line in f]
    print("%d objects compiled, %d out of %s" % (words.count("compiled"), words.count("reused"), os.path.basename(build)))
    shell.run("cmake", "--install", work + "/build", "--prefix", work + "/prefix")
    if os.path.exists(work + "/prefix"):
        sys.exit("the including project would install our files")
    return [work + "/build/robot"]


def main(way, source, prefix, build, compiler, work):
    for program in {"cross": ["aarch64-linux-gnu-g++", "qemu-aarch64"], "pkg_config": ["pkg-config"]}.get(way, []):
        if not shutil.which(program):
            print("skipped: there is no %s here" % program)
            return shell.SKIPPED
    if shutil.which("ninja"):
        os.environ["CMAKE_GENERATOR"] = "Ninja"
    prepare(source, work, way)
    flags = "-mavx2 -mfma" if shell.has_avx2() else ""
    if way == "find_package":
        programs = find_package(work, prefix, compiler, flags)
    elif way == "pkg_config":
        programs = pkg_config(work, prefix, compiler, flags)
    elif way == "cross":  # unoptimised: compiling is what takes time, a minute
        if shutil.which("ccache"):
            os.environ["CMAKE_CXX_COMPILER_LAUNCHER"] = "ccache"
        shell.run("./build.sh", cwd=work, CMAKE_BUILD_TYPE="None", CXXFLAGS="-O0", CMAKE_BUILD_PARALLEL_LEVEL="2")
        programs = [work + "/build/robot"]
    else:
        programs = from_source(work, source, build, compiler)
    for program in programs:
        emulator = ["qemu-aarch64"] if way == "cross" else []
        print(shell.run(*emulator, program).splitlines()[-1])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 7 else __doc__)
