#!/usr/bin/env python3
"""code_size.py TRIPLE ARCHIVE FILE: the instructions of the whole core, each function once, are at most 150 kB; writes the
figure between the marks in FILE (docs/memory.md)."""
import os
import re
import subprocess
import sys
import tempfile

MOST = 150000  # bytes, on AArch64 with -Os
BEGIN, END = "<!-- code: begin -->\n", "<!-- code: end -->\n"


def sections(triple, archive):
    """{'text': bytes, 'rodata': bytes} of all objects joined: the linker keeps one of each inline function."""
    with tempfile.TemporaryDirectory() as folder:
        whole = os.path.join(folder, "core.o")
        subprocess.run([triple + "-ld", "-r", "-o", whole, "--whole-archive", archive], check=True)
        table = subprocess.run([triple + "-size", "-A", whole], check=True, capture_output=True, text=True).stdout
    sums = {"text": 0, "rodata": 0}
    for kind, size in re.findall(r"^\.(text|rodata)\S*\s+(\d+)", table, re.M):
        sums[kind] += int(size)
    return sums


def main(triple, archive, path):
    size = sections(triple, archive)
    line = "`.text` of the whole core: %d bytes, constants: %d bytes (g++, AArch64, `-Os`).\n" % (size["text"], size["rodata"])
    print(line, end="")
    if not 10000 < size["text"] <= MOST:
        print("code_size.py: at most %d bytes of instructions are allowed (and fewer than 10000 are no core)" % MOST)
        return 1
    with open(path, encoding="utf-8") as f:
        before, rest = f.read().split(BEGIN)
    with open(path, "w", encoding="utf-8") as f:
        f.write(before + BEGIN + "\n" + line + "\n" + END + rest.split(END)[1])
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
