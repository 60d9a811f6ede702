#!/usr/bin/env python3
"""installed_sizes.py PREFIX STACK_TEST MEMORY_TABLE ROOT [--write]: the tables of ROOT/docs/memory.md about what is installed in
PREFIX, and about RAM and stack of the three capacity profiles, say what is measured: memory exactly, bytes of files within 5 %
and the stack within 25 %, as another compiler of the same year may need."""
import os
import re
import sys

import shell

BEGIN, END = "<!-- installed: begin -->\n", "<!-- installed: end -->\n"


def installed(prefix):
    """Rows of (what, bytes)."""
    kinds = {"headers": 0, "`libaccrete.a`: the core, its filter for every instruction set of the processor": 0,
             "`libaccrete_hal.a`: cameras and files": 0, "the program `accrete`": 0, "all with the rest": 0}
    headers, core, hal, program, everything = kinds
    for base, _, names in os.walk(prefix):
        for name in names:
            size = os.lstat(os.path.join(base, name)).st_size
            kinds[everything] += size
            for kind, mine in ((headers, name.endswith(".h")), (core, name == "libaccrete.a"),
                               (hal, name == "libaccrete_hal.a"), (program, name == "accrete" and base.endswith("bin"))):
                kinds[kind] += size if mine else 0
    return list(kinds.items())


def profiles(stack_test, memory_table):
    """Rows of (limits, bytes of an Accumulator, bytes of stack)."""
    said = shell.run(stack_test, "--gtest_filter=*DoesNotGrow*")
    ram = dict(re.findall(r"^\| `(\w+)` .*\((\d+)\) \|$", shell.run(memory_table), re.MULTILINE))
    return [(name, int(ram[name]), int(stack)) for name, stack in re.findall(r"^stack (\w+) (\d+)$", said, re.MULTILINE)]


def tables(files, memory):
    rows = ["| installed | bytes |", "|---|---:|"] + ["| %s | %d |" % row for row in files]
    rows += ["", "| capacity profile | RAM: sizeof(Accumulator) | stack of a step, 4 lanes |", "|---|---:|---:|"]
    return "\n".join(rows + ["| `%s` | %d | %d |" % row for row in memory])


def differences(old, new):
    """Sentences about what is not as the page says; the two have the same rows."""
    problems, limits = [], {1: 0.05, 2: 0.25}
    old, new = old.splitlines(), new.splitlines()
    if [row.split("|")[1:2] for row in old] != [row.split("|")[1:2] for row in new]:
        return ["its rows are others"]
    for was, now in zip(old, new):
        for column, (before, after) in enumerate(zip(was.split("|")[2:-1], now.split("|")[2:-1]), 1):
            if not after.strip().isdigit():
                continue
            exact = "Limits`" in now and column == 1
            if abs(int(after) - int(before)) > (0 if exact else limits[column]) * int(before):
                problems.append("%s: %s, measured %s" % (now.split("|")[1].strip(), before.strip(), after.strip()))
    return problems


def main(prefix, stack_test, memory_table, root, write):
    path = os.path.join(root, "docs", "memory.md")
    with open(path, encoding="utf-8") as f:
        text = f.read()
    new = tables(installed(prefix), profiles(stack_test, memory_table))
    before, rest = text.split(BEGIN)
    old, after = rest.split(END)
    if write:
        with open(path, "w", encoding="utf-8") as f:
            f.write(before + BEGIN + "\n" + new + "\n\n" + END + after)
        return 0
    problems = differences(old.strip("\n"), new)
    for problem in problems:
        print("docs/memory.md: %s" % problem)
    if problems:
        print("Write it with: %s --write" % " ".join(sys.argv))
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) not in (5, 6) or sys.argv[5:] not in ([], ["--write"]):
        sys.exit(__doc__)
    sys.exit(main(*sys.argv[1:5], len(sys.argv) == 6))
