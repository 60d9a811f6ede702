#!/usr/bin/env python3
"""recipes.py ROOT BUILD: what docs/howto/packaging/ assumes about this project is so. Each recipe is run, or read, far enough
to see with which options it configures and what it depends on; the systems themselves are not needed."""
import hashlib
import os
import re
import shutil
import sys

import recipe_readers
import shell
import tree

# find_package(NAME) -> what Yocto, Buildroot, vcpkg and Conan call it; None: what needs
# it is not built.
NAMES = {"Eigen3": ("libeigen", "eigen", "eigen3", "eigen"), "PNG": ("libpng", "libpng", "libpng", "libpng"),
         "libjpeg-turbo": ("libjpeg-turbo", "jpeg-turbo", "libjpeg-turbo", "libjpeg-turbo"),
         "yaml-cpp": ("yaml-cpp", "yaml-cpp", "yaml-cpp", "yaml-cpp"), "CLI11": ("cli11", None, "cli11", None),
         "fmt": ("fmt", None, "fmt", None), "nlohmann_json": ("nlohmann-json", None, "nlohmann-json", None),
         "libcamera": ("libcamera", "libcamera", None, None)}  # for boards with cameras
OF_THE_SYSTEM = {"Threads", "PkgConfig"}
SYSTEMS = {"yocto": recipe_readers.yocto, "buildroot": recipe_readers.buildroot, "vcpkg": recipe_readers.vcpkg,
           "conan": recipe_readers.conan}


def looked_for(root):
    """What the libraries and the program are built with, out of their CMakeLists.txt."""
    found = set()
    for path in tree.files(root, ["CMakeLists.txt", "src", "hal"], ("CMakeLists.txt",)):
        text = re.sub(r"#.*", "", tree.read(root, path))
        found |= set(re.findall(r"find_package\((\w[\w-]*)", text))
        found |= set(re.findall(r'^accrete_optional\(\w+ "[^"]*" (\S+)', text, re.M))
        found |= set(re.findall(r"pkg_check_modules\(.* ([a-z]+)>=", text))
    return found - OF_THE_SYSTEM


def cache_of(build):
    """(all options, those that may be AUTO)"""
    with open(build + "/CMakeCache.txt", encoding="utf-8") as f:
        text = f.read()
    return (set(re.findall(r"^(ACCRETE_\w+):(?:BOOL|STRING)=", text, re.M)),
            set(re.findall(r"^(ACCRETE_\w+)-STRINGS:INTERNAL=AUTO;", text, re.M)))


def check(root, build):
    problems, folder = [], os.path.join(root, "docs/howto/packaging")
    version = re.search(r'kVersion\[\] = "(.*)"', tree.read(root, "include/accrete/version.h")).group(1)
    with open(os.path.join(root, "LICENSE"), "rb") as f:
        licence = f.read()
    (cache, automatic), packages = cache_of(build), looked_for(root)
    problems += ["no recipe knows the package " + name for name in sorted(packages - set(NAMES))]
    problems += ["%s is looked for nowhere, but recipes name it" % name for name in sorted(set(NAMES) - packages)]
    for number, (system, reader) in enumerate(SYSTEMS.items()):
        recipe = reader(folder + "/" + system)
        if recipe["version"] != version:
            problems.append("%s: version %s, version.h says %s" % (system, recipe["version"], version))
        if os.path.realpath(recipe["tree"]) != os.path.realpath(root):
            problems.append("%s would build %s" % (system, recipe["tree"]))
        for kind, value in recipe["sums"].items():
            if hashlib.new(kind, licence).hexdigest() != value:
                problems.append("%s: the %s of LICENSE is another" % (system, kind))
        wanted = {names[number] for names in NAMES.values()} - {None}
        if recipe["depends"] != wanted:
            problems.append("%s: depends on %s, not on %s" % (system, sorted(recipe["depends"]), sorted(wanted)))
        options = recipe["options"]  # {name: the values it is given}
        problems += ["%s: there is no option %s" % (system, name) for name in sorted(set(options) - cache)]
        problems += ["%s: %s=%s" % (system, name, v) for name, values in options.items() for v in values - {"ON", "OFF"}]
        problems += ["%s leaves %s to what happens to be there" % (system, name) for name in sorted(automatic - set(options))]
        if options.get("ACCRETE_TESTS") != {"OFF"}:
            problems.append(system + " would build the tests")
    return problems


if __name__ == "__main__":
    if len(sys.argv) != 3:
        sys.exit(__doc__)
    if not shutil.which("make"):
        print("skipped: there is no make here")
        sys.exit(shell.SKIPPED)
    found_problems = check(sys.argv[1], sys.argv[2])
    print("\n".join(found_problems) if found_problems else "%d recipes agree with the tree" % len(SYSTEMS))
    sys.exit(1 if found_problems else 0)
