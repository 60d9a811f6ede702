#!/usr/bin/env python3
"""memory_doc.py FILE [--write] -- PROGRAM...: the tables between the marks in FILE are what PROGRAM prints."""
import subprocess
import sys

BEGIN, END = "<!-- tables: begin -->\n", "<!-- tables: end -->\n"


def main(path, program, write):
    tables = subprocess.run(program, check=True, capture_output=True, text=True).stdout
    with open(path, encoding="utf-8") as f:
        text = f.read()
    before, rest = text.split(BEGIN)
    old, after = rest.split(END)
    if old.strip("\n") == tables.strip("\n"):
        return 0
    if not write:
        print("%s is out of date; it should say:\n\n%s\nWrite it with: %s %s --write -- %s" %
              (path, tables, sys.argv[0], path, " ".join(program)))
        return 1
    with open(path, "w", encoding="utf-8") as f:
        f.write(before + BEGIN + "\n" + tables + "\n" + END + after)
    return 0


if __name__ == "__main__":
    flags = sys.argv[2:sys.argv.index("--")] if "--" in sys.argv[2:] else None
    if flags not in ([], ["--write"]):
        sys.exit(__doc__)
    sys.exit(main(sys.argv[1], sys.argv[3 + len(flags):], bool(flags)))
