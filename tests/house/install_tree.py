#!/usr/bin/env python3
"""install_tree.py BUILD SOURCE PREFIX: installs the build, moves the folder to PREFIX (it must bear that), and looks at what
is there: nothing is lacking, and nothing names the source or the build, or Eigen (but the bridge to it)."""
import os
import re
import shutil
import sys

import shell

WANTED = [r"include/accrete/accumulator\.h", r"include/accrete/version\.h", r"include/accrete/hal/synthetic\.h",
          r"include/accrete/interop/eigen\.h", r"include/accrete/interop/opencv\.h",
          r"lib.*/libaccrete\.a", r"lib.*/libaccrete_hal\.a", r"lib.*/cmake/accrete/accreteConfig\.cmake",
          r"lib.*/cmake/accrete/accreteConfigVersion\.cmake", r"lib.*/pkgconfig/accrete\.pc",
          r"lib.*/pkgconfig/accrete-hal\.pc", r"share/doc/accrete/LICENSE"]
PROGRAM = [r"bin/accrete", r"share/man/man1/accrete\.1", r"share/bash-completion/completions/accrete"]
# All that may be there: headers of ours, libraries, and what finds them.
ALLOWED = re.compile("|".join(WANTED + PROGRAM + [r"include/accrete/((hal|interop)/)?\w+\.h", r"lib.*/cmake/accrete/\w+(-\w+)?\.cmake"]))
TEXT = (".h", ".cmake", ".pc", ".1")


def check(prefix, words, with_program):
    problems, there = [], []
    for base, _, names in os.walk(prefix):
        for name in names:
            path = os.path.join(base, name)
            there.append(os.path.relpath(path, prefix))
            if name.endswith(TEXT):
                with open(path, encoding="utf-8") as f:
                    text = f.read()
                bridge = path.endswith("include/accrete/interop/eigen.h")
                problems += ["%s names %s" % (path, word) for word in words
                             if word in text and not (bridge and word == "Eigen")]
    for pattern in WANTED + (PROGRAM if with_program else []):
        if not any(re.fullmatch(pattern, path) for path in there):
            problems.append("%s is lacking in %s" % (pattern, prefix))
    problems += ["%s is installed, and nobody asked for it" % path for path in there if not ALLOWED.fullmatch(path)]
    return problems, len(there)


def main(build, source, prefix):
    before = prefix + ".before"
    for folder in (before, prefix):
        shutil.rmtree(folder, ignore_errors=True)
    shell.run("cmake", "--install", build, "--prefix", before)
    os.rename(before, prefix)
    problems, count = check(prefix, ["Eigen", "eigen3", source, build, before],
                            os.path.exists(os.path.join(build, "src/cli/accrete")))
    print("\n".join(problems) if problems else "%d files" % count)
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
