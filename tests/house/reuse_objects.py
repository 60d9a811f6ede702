#!/usr/bin/env python3
"""reuse_objects.py COMPILE_COMMANDS ROOT LOG COMPILER ARGUMENTS...: a compiler launcher for projects that contain this one.

A command that equals one of COMPILE_COMMANDS (our own build of ROOT) but for the folders gives that build's object instead
of compiling once more: the core takes minutes. Everything else is compiled. LOG gets a line for each."""
import json
import os
import shlex
import shutil
import subprocess
import sys

IGNORED = ("-MD", "-Werror", "-fstack-usage")  # change no code
WITH_VALUE = ("-o", "-MT", "-MF", "-c")


def split(tokens, root):
    """(what the code depends on, {"-o": ..., "-c": ...}); paths below root as @."""
    said, files, i = [], {}, 0
    while i < len(tokens):
        if tokens[i] in WITH_VALUE:
            files[tokens[i]] = tokens[i + 1]
            i += 1
        elif tokens[i] not in IGNORED:
            said.append(tokens[i].replace(root, "@"))
        i += 1
    return said, files


def find(commands, root, said, source):
    for entry in commands:
        if entry["file"].replace(root, "@") != source:
            continue
        tokens = shlex.split(entry["command"])
        while tokens and tokens[0] != said[0]:  # another launcher
            tokens = tokens[1:]
        other, files = split(tokens, root)
        if other == said and "-o" in files:
            made = os.path.join(entry["directory"], files["-o"])
            if os.path.exists(made) and os.path.getmtime(made) >= os.path.getmtime(entry["file"]):
                return made
    return None


def main(database, root, log, command):
    with open(database, encoding="utf-8") as f:
        commands = json.load(f)
    made = None
    if "-c" in command:
        source = command[command.index("-c") + 1]
        user_root = next((source[:i + 8] for i in [source.find("/accrete/")] if i >= 0), None)
        if user_root:
            said, files = split(command, user_root)
            made = find(commands, root, said, source.replace(user_root, "@"))
    with open(log, "a", encoding="utf-8") as f:
        f.write("%s %s\n" % ("reused" if made else "compiled", command[-1]))
    if not made:
        return subprocess.run(command).returncode
    shutil.copyfile(made, files["-o"])
    if "-MF" in files:
        with open(files["-MF"], "w", encoding="utf-8") as f:
            f.write("%s: %s\n" % (files.get("-MT", files["-o"]), files["-c"]))
    return 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:4], sys.argv[4:]))
