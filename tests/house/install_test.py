#!/usr/bin/env python3
"""install_test.py BUILD SOURCE COMPILER: installs the build into a folder of its own and builds and runs a user's
project (tests/install) against it."""
import os
import subprocess
import sys
import tempfile


def run(*command):
    result = subprocess.run(command, capture_output=True, text=True)
    if result.returncode != 0:
        sys.exit("%s\n%s%s\nexit status %d" % (" ".join(command), result.stdout, result.stderr, result.returncode))
    return result.stdout


def main(build, source, compiler):
    with tempfile.TemporaryDirectory() as folder:
        prefix, user = os.path.join(folder, "prefix"), os.path.join(folder, "user")
        run("cmake", "--install", build, "--prefix", prefix)
        for base, _, names in os.walk(prefix):
            for name in names:
                if name.endswith((".h", ".cmake")):
                    with open(os.path.join(base, name), encoding="utf-8") as f:
                        text = f.read()
                    for word in ("Eigen", source, build):
                        if word in text:
                            sys.exit("%s names %s" % (os.path.join(base, name), word))
        run("cmake", "-S", os.path.join(source, "tests/install"), "-B", user, "-DCMAKE_PREFIX_PATH=" + prefix,
            "-DCMAKE_CXX_COMPILER=" + compiler, "-DCMAKE_BUILD_TYPE=Release")
        run("cmake", "--build", user)
        with open("/proc/cpuinfo", encoding="utf-8") as f:
            if "avx2" not in f.read() and "x86" in os.uname().machine:
                print("this processor has no AVX2: built, not run")
                return
        for program in ("core", "scene"):
            print(run(os.path.join(user, program)), end="")


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
