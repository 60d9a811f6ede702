#!/usr/bin/env python3
"""stack_usage.py FOLDER: what the compiler wrote with -fstack-usage: no function of the core takes more than MAX_FRAME
bytes of stack, and none an amount that only shows at run time (docs/memory.md)."""
import os
import sys

MAX_FRAME = 8192


def functions(folder):
    """(file:line:column:name, bytes, kind) of every function."""
    for base, _, names in os.walk(folder):
        for name in sorted(names):
            if name.endswith(".su"):
                with open(os.path.join(base, name), encoding="utf-8") as f:
                    for line in f:
                        where, size, kind = line.rstrip("\n").split("\t")
                        yield where, int(size), kind


def check(folder):
    problems, deepest, count = [], (0, ""), 0
    for where, size, kind in functions(folder):
        count += 1
        deepest = max(deepest, (size, where))
        if kind == "dynamic":  # "static" and "dynamic,bounded" are known beforehand
            problems.append("%s: the size of its frame depends on values" % where)
        if size > MAX_FRAME:
            problems.append("%s: %d bytes of stack, at most %d are allowed" % (where, size, MAX_FRAME))
    if count == 0:
        problems.append("no .su file in %s: was the core compiled with -fstack-usage?" % folder)
    return problems, "%d functions, the largest frame has %d bytes: %s" % (count, deepest[0], deepest[1])


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    found, summary = check(sys.argv[1])
    print("\n".join(found) if found else summary)
    sys.exit(1 if found else 0)
