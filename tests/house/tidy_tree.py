#!/usr/bin/env python3
"""tidy_tree.py ROOT: files stay small, name no machine, and every test file is registered."""
import re
import sys

import tree

MAX_LINES = 400
# Paths that exist on one machine only, and recordings that live outside the project (tests find them by themselves).
MACHINE_PATH = re.compile(r"(?<![\w.$}])/(home|root|work|farm|Users|mnt)/[\w.-]+|\.\./shared")
TEST = re.compile(r"^\s*accrete_\w*test\(\s*([\w/]+)", re.M)


def check(root):
    problems = []
    sources = (".h", ".cpp")
    for path in tree.files(root, ["include", "src", "hal"], sources):
        lines = tree.read(root, path).count("\n")
        if lines > MAX_LINES:
            problems.append("%s: %d lines; a file holds one concept and at most %d lines" % (path, lines, MAX_LINES))
    text = sources + (".md", ".txt", ".json", ".yml", ".yaml", ".py", ".sh", ".cmake", "dev", "run")
    for path in tree.files(root, ["include", "src", "hal", "bench", "docs", "examples", "toolchains", "cmake", "tests", "README.md", "CHANGELOG.md",
                                  "CMakeLists.txt", "CMakePresets.json", "dev", ".ci"], text):
        if path == "tests/house/tidy_tree.py":
            continue
        for number, line in enumerate(tree.read(root, path).splitlines(), 1):
            found = MACHINE_PATH.search(line)
            if found and not (path.startswith("tests/") and found.group() == "../shared"):
                problems.append("%s:%d: '%s' exists on one machine only" % (path, number, found.group()))
    registered = set()
    for path in tree.files(root, ["tests"], ("CMakeLists.txt",)):
        folder = path.rsplit("/", 1)[0]
        registered |= {"%s/%s.cpp" % (folder, name) for name in TEST.findall(tree.read(root, path))}
    for path in tree.files(root, ["tests"], ("_test.cpp",)):
        if path not in registered:
            problems.append("%s: not registered with accrete_test: a test that is not registered is not a test" % path)
    for path in tree.files(root, ["include", "hal/include"], (".h",)):
        if "#pragma once" not in tree.read(root, path):
            problems.append("%s: lacks #pragma once" % path)
    return problems


if __name__ == "__main__":
    found = check(sys.argv[1] if len(sys.argv) > 1 else ".")
    print("\n".join(found) if found else "the tree is tidy")
    sys.exit(1 if found else 0)
