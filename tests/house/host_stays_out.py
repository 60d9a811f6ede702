#!/usr/bin/env python3
"""Nothing of the machine that compiles gets into what it compiles for another.

host_stays_out.py --toolchain FILE WORK: a project that looks for libraries in every way that CMake has finds nothing but
    Eigen through this toolchain file without a sysroot; the same project does find them for this machine.
host_stays_out.py --build BUILD [SYSROOT]: all that a build for another machine has found, compiles and links with lies in
    SYSROOT, where there is one, in the project or in the compiler's own folders."""
import json
import os
import re
import shutil
import sys

import shell

# Each line of PROBE reports one thing that was found. try_compile sees what the compiler itself searches.
PROBE = r"""
cmake_minimum_required(VERSION 3.25)
project(probe CXX)
function(report what where)
  if(where)
    message(STATUS "FOUND ${what} ${where}")
  endif()
endfunction()
foreach(package IN ITEMS Eigen3 GTest nlohmann_json fmt yaml-cpp CLI11 libjpeg-turbo PNG ZLIB)
  find_package(${package} QUIET)
  report(package:${package} "${${package}_FOUND}")
endforeach()
find_library(library_z z)
report(library:z "${library_z}")
find_path(header_zlib zlib.h)
report(header:zlib "${header_zlib}")
find_package(PkgConfig QUIET)
pkg_check_modules(module_zlib QUIET zlib)
report(module:zlib "${module_zlib_FOUND}")
file(WRITE ${CMAKE_BINARY_DIR}/probe.cpp "#include <zlib.h>\n")
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
try_compile(compiled ${CMAKE_BINARY_DIR} ${CMAKE_BINARY_DIR}/probe.cpp)
report(include:zlib "${compiled}")
"""


def found(work, name, *options):
    folder = os.path.join(work, name)
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    with open(os.path.join(folder, "CMakeLists.txt"), "w", encoding="utf-8") as f:
        f.write(PROBE)
    # As a user's shell may have it: the host's folders.
    said = shell.run("cmake", "-S", folder, "-B", folder + "/build", *options, PKG_CONFIG_PATH=os.pathsep.join(
        "/usr/lib/%s/pkgconfig" % name for name in os.listdir("/usr/lib") if "linux" in name))
    return set(re.findall(r"^-- FOUND (\S+)", said, re.M))


def check_toolchain(toolchain, work):
    with open(toolchain, encoding="utf-8") as f:
        compiler = re.search(r"(?:set\(triple (\S+)\)|CMAKE_CXX_COMPILER (\S+)-g\+\+)", f.read())
    if not shutil.which((compiler.group(1) or compiler.group(2)) + "-g++"):
        print("skipped: there is no %s-g++ here" % (compiler.group(1) or compiler.group(2)))
        return shell.SKIPPED
    native = found(work, "native")
    others = native - {"package:Eigen3"}
    if not {"library:z", "header:zlib", "include:zlib"} & others:
        print("skipped: this machine has no zlib that could be found by mistake")
        return shell.SKIPPED
    cross = found(work, "cross", "--toolchain", toolchain)
    print("for this machine: %s\nwith %s: %s" % (", ".join(sorted(native)), os.path.basename(toolchain),
                                                 ", ".join(sorted(cross)) or "nothing"))
    if cross - {"package:Eigen3"}:
        print("those are the host's")
    if "package:Eigen3" in native - cross:
        print("but Eigen, which is headers alone, must be found")
    return 1 if cross - {"package:Eigen3"} or "package:Eigen3" in native - cross else 0


def foreign(word, sysroot, build, source):
    """A path of the host in one word of a command."""
    path = re.search(r"(?:^|=|-I|-L|-isystem)(/(?:usr|lib|opt|home|root)[^\s:;]*)", word)
    if not path:
        return None
    path = os.path.normpath(path.group(1))
    allowed = [build, source] + ([sysroot] if sysroot else ["/usr/include/eigen3", "/usr/share/eigen3"])
    return None if any(path == a or path.startswith(a + "/") for a in allowed) else path


# What a cache says of programs that run here, and of the place where an installation will lie.
NOT_LINKED = re.compile(r"^(CMAKE_(\w*_)?(COMPILER|AR|RANLIB|NM|OBJCOPY|OBJDUMP|READELF|STRIP|LINKER|ADDR2LINE|DLLTOOL|MAKE_PROGRAM"
                        r"|COMMAND|ROOT|COMPILER_\w+|TAPI|MT|UNAME)|\w*CMAKE_INSTALL_\w+|_?Python3?_\w+|PKG_CONFIG_EXECUTABLE|ACCRETE_(GXX|CLANGXX|QEMU\w+)"
                        r"|PYTHON_\w+|FIND_PACKAGE_MESSAGE_DETAILS_Python3)$")


def check_build(build, sysroot):
    with open(os.path.join(build, "CMakeCache.txt"), encoding="utf-8") as f:
        cache = [re.match(r"([^#/:][^:]*):\w+=(.+)", line) for line in f]
    values = {m.group(1): m.group(2) for m in cache if m}
    source = values["CMAKE_HOME_DIRECTORY"]
    problems = []
    for key, value in values.items():
        if not NOT_LINKED.match(key):
            problems += ["CMakeCache.txt: %s is %s" % (key, path)
                         for path in (foreign(word, sysroot, build, source) for word in re.split("[; ]", value)) if path]
    with open(os.path.join(build, "compile_commands.json"), encoding="utf-8") as f:
        entries = json.load(f)
    words = 0
    for entry in entries:
        for word in entry["command"].split()[1:]:  # the first is the compiler, or its launcher
            words += 1
            path = foreign(word, sysroot, build, source)
            if path and not re.search(r"/(ccache|[\w-]*g\+\+[\w-]*)$", path):
                problems.append("%s: is compiled with %s" % (os.path.relpath(entry["file"], source), path))
    with open(os.path.join(build, "build.ninja"), encoding="utf-8") as f:
        links = re.findall(r"^  (?:LINK_LIBRARIES|LINK_PATH|LINK_FLAGS) = (.*)$", f.read(), re.M)
    for link in links:
        problems += ["a program is linked with " + path
                     for path in (foreign(word, sysroot, build, source) for word in link.split()) if path]
    if not words or not links:
        problems.append("%s: no commands were found" % build)
    print("\n".join(sorted(set(problems))) if problems else
          "%d entries, %d files, %d programs: nothing of the host" % (len(values), len(entries), len(links)))
    return 1 if problems else 0


if __name__ == "__main__":
    if sys.argv[1:2] == ["--toolchain"] and len(sys.argv) == 4:
        sys.exit(check_toolchain(*sys.argv[2:]))
    if sys.argv[1:2] == ["--build"] and len(sys.argv) in (3, 4):
        sys.exit(check_build(sys.argv[2], sys.argv[3] if len(sys.argv) == 4 else ""))
    sys.exit(__doc__)
