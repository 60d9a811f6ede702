#!/usr/bin/env python3
"""stack_usage.py FOLDER BYTES [FOLDER BYTES ...]: what the compiler wrote with -fstack-usage: no function in FOLDER takes
more than BYTES of stack, and none an amount that only shows at run time (docs/memory.md)."""
import os
import sys

MAX_FRAME = 8192  # on four lanes


def functions(folder):
    """(file:line:column:name, bytes, kind) of every function."""
    for base, _, names in os.walk(folder):
        for name in sorted(names):
            if name.endswith(".su"):
                with open(os.path.join(base, name), encoding="utf-8") as f:
                    for line in f:
                        where, size, kind = line.rstrip("\n").split("\t")
                        yield where, int(size), kind


def check(folder, max_frame=MAX_FRAME):
    problems, deepest, count = [], (0, ""), 0
    for where, size, kind in functions(folder):
        count += 1
        deepest = max(deepest, (size, where))
        if kind == "dynamic":  # "static" and "dynamic,bounded" are known beforehand
            problems.append("%s: the size of its frame depends on values" % where)
        if size > max_frame:
            problems.append("%s: %d bytes of stack, at most %d are allowed" % (where, size, max_frame))
    if count == 0:
        problems.append("no .su file in %s: was the core compiled with -fstack-usage?" % folder)
    return problems, "%d functions, the largest frame has %d bytes: %s" % (count, deepest[0], deepest[1])


if __name__ == "__main__":
    if len(sys.argv) < 3 or len(sys.argv) % 2 == 0:
        sys.exit(__doc__)
    status = 0
    for folder, max_frame in zip(sys.argv[1::2], sys.argv[2::2]):
        found, summary = check(folder, int(max_frame))
        print("\n".join(found) if found else summary)
        status = 1 if found else status
    sys.exit(status)
