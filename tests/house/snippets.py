#!/usr/bin/env python3
"""snippets.py ROOT COMPILER: every block marked ```cpp in README.md and docs/ compiles, as a file or as the body of a
function below its includes, every relative link there leads to a file, and a block below <!-- file: PATH --> is that file
(so that a user's project in the documentation is the one that the tests build, tests/install and examples)."""
import os
import re
import subprocess
import sys

import tree

BLOCK = re.compile(r"^```cpp\n(.*?)^```", re.M | re.S)
LINK = re.compile(r"\]\(([^)#\s]+)")
FILE = re.compile(r"^<!-- file: (\S+) -->\n\n?```\w*\n(.*?)^```", re.M | re.S)


def compile_block(root, compiler, block):
    """None, or what the compiler said."""
    lines, said = block.splitlines(), ""
    body = ([l for l in lines if l.startswith("#include")] + ["void snippet() {"] +
            [l for l in lines if not l.startswith("#include")] + ["}"])
    for text in (block, "\n".join(body) + "\n"):
        result = subprocess.run([compiler, "-std=c++20", "-fsyntax-only", "-Wall", "-Wextra", "-Werror", "-x", "c++", "-",
                                 "-I" + os.path.join(root, "include"), "-I" + os.path.join(root, "hal/include")],
                                input=text, capture_output=True, text=True)
        if result.returncode == 0:
            return None
        said += result.stderr
    return said


def shown_files(root, path, text):
    """(problems, the files that the page shows)."""
    problems, shown = [], set()
    for name, block in FILE.findall(text):
        shown.add(name)
        if not os.path.isfile(os.path.join(root, name)):
            problems.append("%s: %s is not there" % (path, name))
        elif tree.read(root, name) != block:
            problems.append("%s: the block is not %s any more" % (path, name))
    if text.count("<!-- file:") != len(FILE.findall(text)):
        problems.append("%s: a line <!-- file: ... --> without a block below it" % path)
    return problems, shown


def check(root, compiler):
    problems, count, shown = [], 0, set()
    for path in tree.files(root, ["README.md", "CHANGELOG.md", "docs", "bench"], (".md",)):
        text = tree.read(root, path)
        found, here = shown_files(root, path, text)
        problems += found
        shown |= here
        for block in BLOCK.findall(FILE.sub("", text)):  # files are compiled where they lie
            count += 1
            said = compile_block(root, compiler, block)
            if said:
                problems.append("%s: a block does not compile:\n%s" % (path, said))
        for link in LINK.findall(re.sub(r"^```.*?^```", "", text, flags=re.M | re.S)):
            if "://" not in link and not os.path.exists(os.path.join(root, os.path.dirname(path), link)):
                problems.append("%s: %s is not there" % (path, link))
    users = tree.files(root, ["tests/install"], ("/CMakeLists.txt", ".sh"))
    users += [p for p in tree.files(root, ["examples"], (".cpp",)) if not p.endswith("_board.cpp")]
    problems += ["%s is on no page of docs/" % name for name in users if name not in shown]
    return problems, count


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    found, blocks = check(sys.argv[1], sys.argv[2])
    if blocks == 0:
        found.append("no block at all was found")
    print("\n".join(found) if found else "%d blocks compile, links lead somewhere" % blocks)
    sys.exit(1 if found else 0)
