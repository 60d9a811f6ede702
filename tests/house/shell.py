"""Running commands in the checks of the house."""
import os
import subprocess
import sys

SKIPPED = 77  # the exit status of a test that says why it does nothing here


def run(*command, cwd=None, fails=False, **environment):
    """What the command printed. It must succeed, or with `fails` it must not."""
    result = subprocess.run(command, cwd=cwd, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                            env={**os.environ, **environment})
    if (result.returncode != 0) != fails:
        sys.exit("%s\n%s\nexit status %d" % (" ".join(command), result.stdout, result.returncode))
    return result.stdout


def has_avx2():
    """Whether this is an x86-64 processor with AVX2 and FMA."""
    try:
        with open("/proc/cpuinfo", encoding="utf-8") as f:
            words = f.read().split()
    except OSError:
        return False
    return "avx2" in words and "fma" in words
