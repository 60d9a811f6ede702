#!/usr/bin/env python3
"""local_symbols.py NM OBJECT SYMBOL: of everything that OBJECT defines only SYMBOL is seen from outside.

Otherwise the linker could take an inline function that was compiled for a better processor for the whole program."""
import subprocess
import sys


def main(nm, path, symbol):
    lines = subprocess.run([nm, "--defined-only", "--extern-only", path], capture_output=True, text=True, check=True).stdout
    names = [line.split()[-1] for line in lines.splitlines() if line.strip()]
    others = [name for name in names if name != symbol]
    if others or symbol not in names:
        return "%s: defines %s for others, expected only %s" % (path, ", ".join(names) or "nothing", symbol)
    print("only " + symbol)
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
