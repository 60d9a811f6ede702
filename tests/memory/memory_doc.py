#!/usr/bin/env python3
"""memory_doc.py PROGRAM FILE [--write]: the tables between the marks in FILE are what PROGRAM prints."""
import subprocess
import sys

BEGIN, END = "<!-- tables: begin -->\n", "<!-- tables: end -->\n"


def main(program, path, write):
    tables = subprocess.run([program], check=True, capture_output=True, text=True).stdout
    with open(path, encoding="utf-8") as f:
        text = f.read()
    before, rest = text.split(BEGIN)
    old, after = rest.split(END)
    if old.strip("\n") == tables.strip("\n"):
        return 0
    if not write:
        print("%s is out of date; it should say:\n\n%s\nWrite it with: %s --write" % (path, tables, " ".join(sys.argv)))
        return 1
    with open(path, "w", encoding="utf-8") as f:
        f.write(before + BEGIN + "\n" + tables + "\n" + END + after)
    return 0


if __name__ == "__main__":
    if len(sys.argv) not in (3, 4) or sys.argv[3:] not in ([], ["--write"]):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[2], len(sys.argv) == 4))
