"""Reads the recipes of docs/howto/packaging/: {version, tree, sums of LICENSE, depends, options}. What cannot be read is a
mistake in the recipe and ends the test."""
import ast
import glob
import itertools
import json
import os
import re
import sys
import tempfile
import types

import shell

OPTION = re.compile(r"-D(ACCRETE_\w+)=(\w+)")


def read(*path):
    with open(os.path.join(*path), encoding="utf-8") as f:
        return f.read()


def values(pairs):
    found = {}
    for name, value in pairs:
        found.setdefault(name, set()).add(value)
    return found


def yocto(folder):
    """Every line is one of the few forms that the recipe uses; Python in it is evaluated."""
    path, = glob.glob(folder + "/*.bb")
    variables, flags = {}, {}
    for line in read(path).splitlines():
        if not line or line.startswith("#"):
            continue
        if re.fullmatch(r"inherit( [a-z]+)+", line):
            variables["inherit"] = line.split()[1:]
            continue
        match = re.fullmatch(r'([A-Z_]+)((?::[^ =]+)?)(?:\[(\w+)\])? (?:=|\?\?=|=\+) "([^"]*)"', line)
        if not match:
            sys.exit("%s: bitbake would not understand: %s" % (path, line))
        name, override, flag, value = match.groups()
        if flag:
            flags[flag] = value.split(",")
        else:
            variables[name + override] = value
    if {"cmake", "pkgconfig", "externalsrc"} - set(variables["inherit"]):
        sys.exit(path + ": a class is lacking")
    if set(variables["PACKAGECONFIG"].split()) - set(flags) or any(len(parts) != 3 for parts in flags.values()):
        sys.exit(path + ": PACKAGECONFIG: with, without, depends")
    with tempfile.TemporaryDirectory() as layer:  # which has a link to the recipe
        link = os.path.join(layer, os.path.basename(path))
        os.symlink(path, link)
        data = types.SimpleNamespace(getVar={"FILE": link}.get)
        where = eval(re.fullmatch(r"\$\{@(.*)\}", variables["EXTERNALSRC"]).group(1), {"os": os, "d": data})
    for name, (on, off, _) in flags.items():
        if on.replace("=ON", "") != off.replace("=OFF", ""):
            sys.exit("%s: PACKAGECONFIG[%s] switches two things" % (path, name))
    depends = set(variables["DEPENDS"].split()).union(*(parts[2].split() for parts in flags.values()))
    words = " ".join([variables["EXTRA_OECMAKE"]] + [part for parts in flags.values() for part in parts[:2]])
    checksum = re.fullmatch(r"file://LICENSE;md5=([0-9a-f]{32})", variables["LIC_FILES_CHKSUM"]).group(1)
    return {"version": re.fullmatch(r"accrete_(.*)\.bb", os.path.basename(path)).group(1), "tree": where,
            "sums": {"md5": checksum}, "depends": depends, "options": values(OPTION.findall(words))}


def buildroot(folder):
    """Run by make, with everything selected and with nothing."""
    if "name: ACCRETE\n" not in read(folder, "external.desc"):
        sys.exit("external.desc: another name than in the paths")
    config = read(folder, "package/accrete/Config.in")
    if not config.startswith("config BR2_PACKAGE_ACCRETE\n\tbool \"accrete\"\n"):
        sys.exit("Config.in does not begin with the package")
    if any(len(line.expandtabs(8)) > 80 for line in config.splitlines()):
        sys.exit("Config.in: a line is longer than 80")
    selected = re.findall(r"ifeq \(\$\((BR2_\w+)\),y\)", read(folder, "package/accrete/accrete.mk"))
    said = []
    for value in ("y", ""):
        with tempfile.NamedTemporaryFile("w", suffix=".mk") as f:
            f.write("BR2_EXTERNAL_ACCRETE_PATH = %s\n" % folder + "".join("%s = %s\n" % (s, value) for s in selected) +
                    "define cmake-package\nCALLED = yes\nendef\ninclude $(BR2_EXTERNAL_ACCRETE_PATH)/external.mk\n"
                    "$(foreach v,VERSION SITE SITE_METHOD DEPENDENCIES CONF_OPTS,$(info $(v)=$(ACCRETE_$(v))))\n"
                    "$(info called=$(CALLED))\nall:;@:\n")
            f.flush()
            said.append(dict(line.split("=", 1) for line in
                             shell.run("make", "-r", "--warn-undefined-variables", "-f", f.name).splitlines()))
    full = said[0]
    if full["called"] != "yes" or full["SITE_METHOD"] != "local":
        sys.exit("accrete.mk: no package of CMake out of a folder: %s" % full)
    (checksum,) = re.findall(r"^sha256  ([0-9a-f]{64})  LICENSE$", read(folder, "package/accrete/accrete.hash"), re.M)
    options = values(OPTION.findall(said[0]["CONF_OPTS"] + " " + said[1]["CONF_OPTS"]))
    return {"version": full["VERSION"], "tree": full["SITE"], "sums": {"sha256": checksum},
            "depends": set(full["DEPENDENCIES"].split()) - {"host-pkgconf"}, "options": options}


STUBS = """
cmake_minimum_required(VERSION 3.25)
set(FEATURES core tools)
foreach(name IN ITEMS vcpkg_check_linkage vcpkg_cmake_install vcpkg_cmake_config_fixup vcpkg_fixup_pkgconfig vcpkg_copy_tools)
  function(${name})
  endfunction()
endforeach()
function(vcpkg_check_features)
  cmake_parse_arguments(PARSE_ARGV 0 arg "" OUT_FEATURE_OPTIONS FEATURES)
  set(options "")
  while(arg_FEATURES)
    list(POP_FRONT arg_FEATURES feature option)
    list(APPEND options -D${option}=ON)
    message("feature ${feature}")
  endwhile()
  set(${arg_OUT_FEATURE_OPTIONS} "${options}" PARENT_SCOPE)
endfunction()
function(vcpkg_cmake_configure)
  message("configure ${ARGV}")
endfunction()
function(vcpkg_install_copyright)
  message("copyright ${ARGV}")
endfunction()
set(CURRENT_PACKAGES_DIR /nonexistent)
"""


def vcpkg(folder):
    """The port file is run by CMake with functions of our own; the manifest is checked against vcpkg's schema by hand."""
    manifest = json.loads(read(folder, "accrete/vcpkg.json"))
    features = manifest["features"]
    allowed = {"name", "version-semver", "description", "license", "supports", "dependencies", "default-features", "features"}
    lists = [manifest["dependencies"]] + [feature["dependencies"] for feature in features.values()]
    names = [d if isinstance(d, str) else d["name"] for d in itertools.chain(*lists)]
    if (set(manifest) - allowed or set(manifest["default-features"]) - set(features) or
            any(set(f) != {"description", "dependencies"} for f in features.values()) or
            any(not re.fullmatch(r"[a-z0-9]+(-[a-z0-9]+)*", n) for n in [manifest["name"], *names, *features]) or
            any(set(d) - {"name", "host", "features", "platform"} for d in itertools.chain(*lists) if not isinstance(d, str))):
        sys.exit("vcpkg.json is not as vcpkg's schema wants it")
    with tempfile.NamedTemporaryFile("w", suffix=".cmake") as f:
        f.write(STUBS + "include(%s/accrete/portfile.cmake)\n" % folder)
        f.flush()
        said = shell.run("cmake", "-P", f.name)
    if set(re.findall(r"^feature (.*)", said, re.M)) != set(features):
        sys.exit("vcpkg: the features of vcpkg.json are not those of portfile.cmake")
    where = re.search(r"^configure SOURCE_PATH;([^;]*);", said, re.M).group(1)
    if "copyright FILE_LIST;%s/LICENSE\n" % where not in said:
        sys.exit("vcpkg: the licence is not installed")
    return {"version": manifest["version-semver"], "tree": where, "sums": {},
            "depends": set(names) - {"vcpkg-cmake", "vcpkg-cmake-config"}, "options": values(OPTION.findall(said))}


def conan(folder):
    """The recipe is run with a `conan` of our own, with every option."""
    text = read(folder, "conanfile.py")
    ast.parse(text)
    copied, variables, options = [], [], {}

    class Toolchain:
        def __init__(self, _):
            self.cache_variables = {}

        def generate(self):
            variables.extend(self.cache_variables.items())

    def module(name, **content):
        sys.modules[name] = types.ModuleType(name)
        sys.modules[name].__dict__.update(content)

    nothing = types.SimpleNamespace(generate=lambda: None)
    module("conan", ConanFile=object)
    module("conan.tools")
    module("conan.tools.build", check_min_cppstd=lambda _, standard: standard)
    module("conan.tools.cmake", CMake=None, CMakeDeps=lambda _: nothing, CMakeToolchain=Toolchain, cmake_layout=None)
    module("conan.tools.files", copy=lambda _, pattern, src, dst: copied.append((pattern, src)), rmdir=None)
    content = {}
    exec(compile(text, folder + "/conanfile.py", "exec"), content)
    recipe, depends = content["Accrete"](), set()
    recipe.recipe_folder, recipe.export_sources_folder = folder, "."
    recipe.requires = lambda reference, visible=True: depends.add(reference.split("/")[0])
    recipe.export_sources()
    for pattern, where in copied:
        if not glob.glob(os.path.join(where, pattern)):
            sys.exit("conanfile.py exports %s, and there is none in %s" % (pattern, where))
    if {name for name in recipe.options if recipe.default_options[name] not in recipe.options[name]}:
        sys.exit("conanfile.py: an option has a value that it does not allow")
    for chosen in itertools.product(*recipe.options.values()):
        options = types.SimpleNamespace(**dict(zip(recipe.options, chosen)))
        run = content["Accrete"]()
        run.options, run.requires = options, recipe.requires
        run.requirements()
        run.generate()
        run.validate()
        properties = []
        component = lambda: types.SimpleNamespace(set_property=lambda *pair: properties.append(pair), requires=[])
        components = {"core": component(), "hal": component()}
        run.cpp_info = types.SimpleNamespace(components=components, set_property=lambda *pair: properties.append(pair))
        run.package_info()
        if ("cmake_target_name", "accrete::accrete") not in properties:
            sys.exit("conanfile.py: no accrete::accrete")
    return {"version": recipe.version, "tree": copied[0][1], "sums": {}, "depends": depends, "options": values(variables)}
