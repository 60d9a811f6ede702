#!/usr/bin/env python3
"""must_not_compile.py ROOT COMPILER...: tests/must_not_compile/*.cpp.

Each file compiles as it stands, and does not with -DBROKEN; the message then holds the text of each line "// expect: TEXT" (or
one of several, divided by |).
So a file that fails for another reason does not pass."""
import os
import subprocess
import sys

import tree


def compile_file(root, compiler, path, *flags):
    return subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-I" + os.path.join(root, "include"), *flags,
                           os.path.join(root, path)], capture_output=True, text=True,
                          env={**os.environ, "LC_ALL": "C"})  # plain quotation marks


def check(root, compiler, path):
    expected = [l.split("// expect:", 1)[1].strip() for l in tree.read(root, path).splitlines() if "// expect:" in l]
    if not expected:
        return "%s: lacks a line '// expect: TEXT'" % path
    sound = compile_file(root, compiler, path)
    if sound.returncode != 0:
        return "%s with %s: does not compile even without BROKEN:\n%s" % (path, compiler, sound.stderr)
    broken = compile_file(root, compiler, path, "-DBROKEN")
    if broken.returncode == 0:
        return "%s with %s: compiles, and must not" % (path, compiler)
    message = broken.stdout + broken.stderr
    lacking = [text for text in expected if not any(t in message for t in text.split("|"))]
    if lacking:
        return "%s with %s: the message lacks '%s':\n%s" % (path, compiler, lacking[0], message)
    return None


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    files = tree.files(sys.argv[1], ["tests/must_not_compile"], (".cpp",))
    problems = [p for compiler in sys.argv[2:] for p in (check(sys.argv[1], compiler, f) for f in files) if p]
    print("\n".join(problems) if problems else "%d files are refused as they should be" % len(files))
    sys.exit(1 if problems or not files else 0)
