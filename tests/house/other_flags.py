#!/usr/bin/env python3
"""other_flags.py SOURCE PREFIX COMPILER CLANG: tests/install/robot.cpp, compiled with other flags than the library in PREFIX
and by another compiler, prints the same: sizes, alignments and every bit of the model."""
import glob
import os
import sys
import tempfile

import shell

PLAIN = ["-O2"]
OTHERS = [["-O0"], ["-O3", "-fno-exceptions", "-fno-rtti", "-D_GLIBCXX_ASSERTIONS"]]
AVX2 = [["-O0", "-mavx2", "-mfma", "-fno-inline"], ["-O3", "-mavx2", "-mfma", "-ffp-contract=fast"]]


def output(compiler, flags, source, prefix, folder):
    program = os.path.join(folder, "robot")
    library = glob.glob(os.path.join(prefix, "lib*/**/libaccrete.a"), recursive=True)[0]
    # The user's object comes first: where both have a copy of an inline function, the linker keeps the user's.
    shell.run(compiler, "-std=c++20", *flags, os.path.join(source, "tests/install/robot.cpp"), "-I" + prefix + "/include",
              library, "-o", program)
    return shell.run(program)


def main(source, prefix, compiler, clang):
    variants = [(compiler, f) for f in OTHERS + (AVX2 if shell.has_avx2() else [])]
    if os.path.exists(clang):
        variants.append((clang, ["-O2"] + (["-mavx2"] if shell.has_avx2() else [])))
    with tempfile.TemporaryDirectory() as folder:
        expected = output(compiler, PLAIN, source, prefix, folder)
        for other, flags in variants:
            said = output(other, flags, source, prefix, folder)
            if said != expected:
                pairs = list(zip(expected.splitlines(), said.splitlines()))
                differ = [p for p in pairs if p[0] != p[1]] or [(expected[-80:], said[-80:])]
                return "%s %s: %d lines differ, the first:\n%s\n%s" % (other, " ".join(flags), len(differ), *differ[0])
    print("%d ways to compile, the same %d lines" % (len(variants) + 1, expected.count("\n")))
    return 0 if expected.count("\n") > 40 else "too little was printed"


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 5 else __doc__)
