#!/usr/bin/env python3
"""program_files.py PROGRAM PREFIX SOURCE: the manual page and the completion that are installed beside the program know
what the program knows: its own --help is the one truth."""
import glob
import os
import re
import shutil
import subprocess
import sys
import tempfile

import shell

FLAG = re.compile(r"--[a-z][a-z-]*")


def commands_of(program):
    listed = shell.run(program, "--help").split("Subcommands:\n")[1].split("\n\n")[0]
    return [line.split()[0] for line in listed.splitlines()]


def entries(text):
    """Flags that begin an entry of --help."""
    return {FLAG.search(line).group() for line in text.splitlines() if re.match(r"  (-\w,)?--", line)}


def check_page(page, program):
    with open(page, encoding="utf-8") as f:
        text = f.read()
    plain = "\n".join(re.sub(r'^\.\w+ ?"?', "", line) for line in text.splitlines())
    plain = re.sub(r"\\f[BIR]", "", plain).replace("\\-", "-").replace("\\&", "").replace("\\e", "\\")
    squeezed = "".join(plain.split())
    problems = []
    for command in [[]] + [[c] for c in commands_of(program)]:
        if command and '\n.SH "ACCRETE %s"\n' % command[0].upper() not in text:
            problems.append("the page has no section of " + command[0])
        for line in shell.run(program, *command, "--help").splitlines():
            line = re.sub(r"^Usage: |^Exit status: |:$", "", line)
            if line != "accrete [OPTIONS] SUBCOMMAND" and "".join(line.split()) not in squeezed:
                problems.append("the page lacks a line of accrete %s --help: %s" % (" ".join(command), line))
    known = set().union(*(FLAG.findall(shell.run(program, *c, "--help")) for c in [[]] + [[c] for c in commands_of(program)]))
    problems += ["the page has %s, the program has not" % f for f in sorted(set(FLAG.findall(plain)) - known)]
    if shutil.which("groff"):
        said = subprocess.run(["groff", "-man", "-Tutf8", "-ww", "-z", page], capture_output=True, text=True).stderr
        problems += said.splitlines()
    return problems


def complete(script, program, words, folder):
    """What bash offers for the last of `words`."""
    line = 'source "$1"; shift; COMP_WORDS=("$@"); COMP_CWORD=$(($# - 1)); _accrete; printf "%s\\n" "${COMPREPLY[@]}"'
    return {w for w in shell.run("bash", "-c", line, "bash", script, program, *words, cwd=folder).splitlines() if w}


def check_completion(script, program):
    problems = []
    commands = set(commands_of(program))
    with tempfile.TemporaryDirectory() as folder:
        for name in ("box.yml", "bag.txt"):
            open(os.path.join(folder, name), "w", encoding="utf-8").close()

        def expect(words, wanted):
            offered = complete(script, program, words, folder)
            if offered != wanted:
                problems.append("accrete %s: offered %s, wanted %s" % (" ".join(words), sorted(offered), sorted(wanted)))

        expect([""], commands | {"--help", "--version"})
        expect(["re"], {c for c in commands if c.startswith("re")})
        for command in commands:
            flags = entries(shell.run(program, command, "--help"))
            expect([command, "--"], flags)
            expect([command, "--he"], {"--help"})
        expect(["run", "bo"], {"box.yml"})
        expect(["run", "--calibration", "b"], {"box.yml", "bag.txt"})
        expect(["run", "-o", "ba"], {"bag.txt"})
        expect(["run", "--frames", "b"], set())  # numbers
        expect(["run", "--json", "ba"], {"bag.txt"})  # it takes no value
        expect(["walk", "--"], set())
    if subprocess.run(["bash", "-n", script]).returncode != 0:
        problems.append(script + " is no script for bash")
    return problems


def main(program, prefix, source):
    installed = os.path.join(prefix, "bin/accrete")
    problems = check_page(glob.glob(prefix + "/share/man/man1/accrete.1")[0], installed)
    problems += check_completion(prefix + "/share/bash-completion/completions/accrete", installed)
    with open(source + "/include/accrete/version.h", encoding="utf-8") as f:
        text = f.read()
    numbers = ".".join(re.findall(r"#define ACCRETE_VERSION_\w+ (\d+)", text))
    pkg = " ".join(open(p, encoding="utf-8").read() for p in glob.glob(prefix + "/lib*/**/pkgconfig/*.pc", recursive=True))
    versions = {numbers, re.search(r'kVersion\[\] = "(.*)"', text).group(1), shell.run(installed, "--version").split()[-1],
                *re.findall(r"^Version: (.*)", pkg, re.M), *re.findall(r"^Requires: accrete = (.*)", pkg, re.M)}
    if len(versions) != 1 or shell.run(program, "--version") != shell.run(installed, "--version"):
        problems.append("there is more than one version: " + ", ".join(sorted(versions)))
    print("\n".join(problems) if problems else "page and completion know %d commands" % len(commands_of(program)))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 4 else __doc__)
