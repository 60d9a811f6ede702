#!/usr/bin/env python3
"""headers.py ROOT COMPILER...: every public header compiles alone, twice in one file, without a warning, on every
compiler given; those of the core also without exceptions and run-time types. A bridge (interop) is left out where there is
no library to bridge to."""
import os
import subprocess
import sys

import tree

# Where Debian has what a bridge needs. Only these headers are compiled with a path to it.
BRIDGES = {"include/accrete/interop/eigen.h": ("/usr/include/eigen3", "Eigen/Core"),
           "include/accrete/interop/opencv.h": ("/usr/include/opencv4", "opencv2/core.hpp")}


def absent(path):
    """Whether the other library of a bridge is not there."""
    return path in BRIDGES and not os.path.exists(os.path.join(*BRIDGES[path]))


def check(root, compiler, path):
    base = "hal/include" if path.startswith("hal/") else "include"
    name = os.path.relpath(path, base)
    flags = ["-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Wpedantic", "-Wshadow", "-Wconversion",
             "-Wno-sign-conversion", "-Werror", "-I" + os.path.join(root, "include")]
    flags += ["-I" + os.path.join(root, "hal/include")] if base != "include" else ["-fno-exceptions", "-fno-rtti"]
    if path in BRIDGES:
        flags += ["-fexceptions", "-isystem", BRIDGES[path][0]]
    text = '#include "%s"\n#include "%s"\n' % (name, name)
    result = subprocess.run([compiler, *flags, "-x", "c++", "-"], input=text, capture_output=True, text=True)
    return None if result.returncode == 0 else "%s with %s:\n%s" % (path, compiler, result.stderr)


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    headers = tree.files(sys.argv[1], ["include", "hal/include"], (".h",))
    for header in filter(absent, headers):
        print("left out: %s, there is no %s here" % (header, BRIDGES[header][1]))
    headers = [h for h in headers if not absent(h)]
    problems = [p for compiler in sys.argv[2:] for p in (check(sys.argv[1], compiler, h) for h in headers) if p]
    print("\n".join(problems) if problems else "%d headers compile alone" % len(headers))
    sys.exit(1 if problems or not headers else 0)
