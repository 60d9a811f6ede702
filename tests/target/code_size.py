#!/usr/bin/env python3
"""code_size.py TRIPLE SYSROOT ARCHIVE ROOT: the instructions of the core that a program with one Accumulator links, each
function once, are at most 150 kB; writes the figures between the marks in ROOT/docs/memory.md."""
import os
import re
import subprocess
import sys
import tempfile

MOST = 150000  # bytes, on AArch64 with -Os
BEGIN, END = "<!-- code: begin -->\n", "<!-- code: end -->\n"


def joined(triple, folder, words):
    """{'text': bytes, 'rodata': bytes} of objects joined: the linker keeps one of each inline function."""
    whole = os.path.join(folder, "whole.o")
    subprocess.run([triple + "-ld", "-r", "-o", whole] + words, check=True)
    table = subprocess.run([triple + "-size", "-A", whole], check=True, capture_output=True, text=True).stdout
    sums = {"text": 0, "rodata": 0}
    for kind, size in re.findall(r"^\.(text|rodata)\S*\s+(\d+)", table, re.M):
        sums[kind] += int(size)
    return sums


def main(triple, sysroot, archive, root):
    with tempfile.TemporaryDirectory() as folder:
        user = os.path.join(folder, "user.o")  # every member of an Accumulator: what it calls is drawn from the archive
        subprocess.run([triple + "-g++", "--sysroot=" + sysroot, "-std=c++20", "-Os", "-DNDEBUG", "-fno-exceptions", "-fno-rtti",
                        "-I" + os.path.join(root, "include"), "-c", os.path.join(root, "tests/house/accumulator_object.cpp"),
                        "-o", user], check=True)
        used = joined(triple, folder, [user, archive])
        everything = joined(triple, folder, ["--whole-archive", archive])
    line = ("A program with one Accumulator links %d bytes of instructions and %d of constants (g++, AArch64, `-Os`; the whole\n"
            "archive, with the kinds of features that the pipeline does not use yet, has %d and %d).\n" %
            (used["text"], used["rodata"], everything["text"], everything["rodata"]))
    print(line, end="")
    if not 10000 < used["text"] <= MOST:
        print("code_size.py: at most %d bytes of instructions are allowed (and fewer than 10000 are no core)" % MOST)
        return 1
    path = os.path.join(root, "docs/memory.md")
    with open(path, encoding="utf-8") as f:
        before, rest = f.read().split(BEGIN)
    with open(path, "w", encoding="utf-8") as f:
        f.write(before + BEGIN + "\n" + line + "\n" + END + rest.split(END)[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 5 else __doc__)
