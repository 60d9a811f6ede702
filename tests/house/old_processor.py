#!/usr/bin/env python3
"""old_processor.py QEMU PROGRAM: PROGRAM runs on an emulated x86-64 processor without AVX, and says what it uses."""
import json
import os
import subprocess
import sys
import tempfile

SKIPPED = 77


def main(qemu, program):
    if not os.path.exists(qemu):
        print("skipped: no qemu-x86_64 (Debian's qemu-user)")
        return SKIPPED
    with tempfile.TemporaryDirectory() as folder:
        command = [qemu, "-cpu", "Nehalem", program, "run", "synthetic:box", "--frames", "0:7", "-q", "-o", folder]
        result = subprocess.run(command, capture_output=True, text=True, timeout=500)
        if result.returncode != 0:
            return "%s: exit status %d\n%s" % (" ".join(command), result.returncode, result.stderr)
        with open(os.path.join(folder, "summary.json"), encoding="utf-8") as f:
            used = json.load(f)["versions"]["instruction_set"]
    print("ran with " + used)
    return 0 if used == "baseline" else "expected baseline on a Nehalem, not " + used


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 3 else __doc__)
