#!/usr/bin/env python3
"""bare_metal.py ROOT: bare_metal.cpp compiles for three Cortex-M with the flags of toolchains/arm-none-eabi.cmake, and asks
for nothing but the core and what every C compiler brings."""
import os
import re
import shutil
import subprocess
import sys
import tempfile

SKIPPED = 77
# Of the core; of the compiler's own library and of the C library, as they are for static objects and copies.
KNOWN = re.compile(r"_ZN?K?7accrete|memcpy|memset|memmove|__aeabi_\w+|__dso_handle")


def main(root):
    for program in ("arm-none-eabi-g++", "arm-none-eabi-nm"):
        if not shutil.which(program):
            print("skipped: there is no %s here" % program)
            return SKIPPED
    with open(os.path.join(root, "toolchains/arm-none-eabi.cmake"), encoding="utf-8") as f:
        cores = re.findall(r'set\(cortex_flags_(\w+) "([^"]+)"\)', f.read())
    problems = [] if len(cores) == 3 else ["toolchains/arm-none-eabi.cmake has not three cores: %s" % cores]
    with tempfile.TemporaryDirectory() as folder:
        for core, flags in cores:
            made = os.path.join(folder, core + ".o")
            result = subprocess.run(["arm-none-eabi-g++", "-std=c++20", "-Os", "-mthumb", *flags.split(), "-mfloat-abi=hard",
                                     "-fno-exceptions", "-fno-rtti", "-fno-threadsafe-statics", "-Wall", "-Wextra", "-Werror",
                                     "-I" + os.path.join(root, "include"), "-c", os.path.join(root, "examples/bare_metal.cpp"),
                                     "-o", made], capture_output=True, text=True)
            if result.returncode != 0:
                problems.append("%s:\n%s" % (core, result.stderr))
                continue
            wanted = subprocess.run(["arm-none-eabi-nm", "-u", made], check=True, capture_output=True, text=True).stdout
            problems += ["%s: asks for %s" % (core, s) for s in wanted.split() if s != "U" and not KNOWN.match(s)]
    print("\n".join(problems) if problems else "compiles for %s" % ", ".join(core for core, _ in cores))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]) if len(sys.argv) == 2 else __doc__)
