#!/usr/bin/env python3
"""includes.py ROOT: includes go one way only (docs/conventions.md, "The way of the data").

A file includes its own stage, stages that come before it, and the base. The accumulator joins the stages, the hardware
layer knows the base alone, the program everything, and nothing of the core knows either of them. Eigen is known to
src/math only; the core and its headers use neither streams nor containers that allocate. The bridges in
include/accrete/interop know Eigen or OpenCV and are known to nobody: what they include is a user's choice."""
import os
import re
import sys

import tree

# The way of the data: whoever is further down may include whoever is further up.
STAGES = ["base", "math", "extract", "stereo", "predict", "associate", "filter", "kernels", "existence", "feature", "store", "model",
          "accumulator"]
# What the hardware layer may know (docs/conventions.md).
BASE = {"status", "contract", "timestamp", "limits", "geometry", "image", "camera", "stereo_frame", "motion", "primitive",
        "pair_runner", "version"}
# Tunables and counts of all stages: known to the core, not to the hardware layer.
CORE_BASE = {"params", "step_report", "instruction_set", "observed_frame"}
# Bridges to the types of other libraries, and whose headers each may include.
INTEROP = {"include/accrete/interop/eigen.h": "Eigen/", "include/accrete/interop/opencv.h": "opencv2/"}
STREAMS = {"iostream", "ostream", "istream", "sstream", "fstream", "cstdio", "stdio.h", "print", "format"}
ALLOCATING = {"vector", "string", "map", "unordered_map", "set", "unordered_set", "deque", "list", "functional", "any",
              "stdexcept", "exception", "regex", "thread", "mutex", "future", "filesystem", "chrono", "ctime"}
# "new (memory) T" constructs in place. What hides from this list the check of the symbols finds.
WORDS = re.compile(r"\b(throw|try|catch|malloc|calloc|realloc|free|printf|puts|abort|assert|typeid|dynamic_cast)\b\s*[(\"{;]"
                   r"|\bthrow\b|(?<!operator )\bnew\b(?!\s*\()|(?<!= )(?<!operator )\bdelete\b")


def layer(path):
    """('core', stage), ('hal',), ('cli',) or None of a file of ours."""
    part = path.split("/")
    if path in INTEROP:
        return ("interop",)
    if path.startswith("include/accrete/"):
        name = part[2][:-2]
        if len(part) != 3:
            return None
        if name in BASE | CORE_BASE:
            return ("core", "base")
        if name == "saved_model":
            return ("core", "accumulator")
        return ("core", name) if name in ("model", "accumulator") else None
    if part[0] == "src":
        if part[1] == "cli":
            return ("cli",)
        return ("core", part[1]) if part[1] in STAGES and len(part) == 3 else None
    return ("hal",) if part[0] == "hal" else None


def resolve(root, includer, name):
    """The file of ours that an include means, or None."""
    roots = ["include", "src", "hal/include", "hal", os.path.dirname(includer)]
    for base in roots:
        path = os.path.normpath(os.path.join(base, name))
        if os.path.isfile(os.path.join(root, path)):
            return path
    return None


def forbidden(who, target, target_path):
    """Why `who` may not include `target`, or None."""
    if who[0] == "cli" and target[0] != "interop":
        return None
    if target[0] == "cli":
        return "only the program may include the program"
    if target[0] == "interop":
        return "only a user's program may include a bridge"
    if who[0] == "interop":
        return None if target_path.startswith("include/") else "a bridge knows the public headers of the core alone"
    if who[0] == "hal":
        if target[0] == "hal":
            return None
        name = os.path.basename(target_path)[:-2]
        if target_path.startswith("include/") and name in BASE:
            return None
        return "the hardware layer knows the base alone: " + ", ".join(sorted(BASE))
    if target[0] == "hal":
        return "the core does not know the hardware layer"
    if STAGES.index(target[1]) > STAGES.index(who[1]):
        return "%s comes after %s in the way of the data" % (target[1], who[1])
    return None


def check(root):
    problems = []
    for path in tree.files(root, ["include", "src", "hal"], (".h", ".cpp")):
        text = tree.read(root, path)
        who = layer(path)
        if who is None:
            problems.append("%s: belongs to no layer; a new stage is added in tests/house/includes.py" % path)
            continue
        for line, quote, name in tree.includes(text):
            where = "%s:%d: #include %s" % (path, line, name)
            if name.startswith(("Eigen", "unsupported/Eigen")):
                if not path.startswith("src/math/") and not name.startswith(INTEROP.get(path, "-")):
                    problems.append(where + ": only src/math knows Eigen")
                continue
            target_path = resolve(root, path, name)
            if quote == '"' and target_path is None:
                problems.append(where + ": no such file; system headers take <>")
            elif target_path is None:
                if who[0] == "core" and name in STREAMS | ALLOCATING:
                    problems.append(where + ": the core neither prints nor allocates")
            else:
                target = layer(target_path)
                reason = forbidden(who, target, target_path) if target else "belongs to no layer"
                if reason:
                    problems.append("%s: %s" % (where, reason))
        if who[0] == "core":
            for number, line in enumerate(tree.code(text).splitlines(), 1):
                found = None if line.lstrip().startswith("#") else WORDS.search(line)
                if found:
                    problems.append("%s:%d: '%s' in the core" % (path, number, found.group().strip(' (";{')))
    return problems


if __name__ == "__main__":
    found = check(sys.argv[1] if len(sys.argv) > 1 else ".")
    print("\n".join(found) if found else "includes go one way")
    sys.exit(1 if found else 0)
