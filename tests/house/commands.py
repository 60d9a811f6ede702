#!/usr/bin/env python3
"""commands.py ROOT PROGRAM WORK: the commands of the tutorial and of the how-to pages work.

The blocks of a page that are marked ```sh and ```python are run one after the other, in one shell that ends with the first
failure, in an empty folder with the program on the PATH and where ./dev demo builds it, and with links to the project's
bench/ and examples/. A block ```text below one is what it prints: these lines, in this order, "..." for anything.
A block below <!-- not run: WHY --> needs what no test has (a camera, a board, root, the network); there every flag of the
program, every command of ./dev and every option of CMake must exist. Blocks below <!-- file: PATH --> belong to snippets.py."""
import os
import re
import shutil
import subprocess
import sys

import tree

# A page that goes on in the folder of another one.
GOES_ON = {"docs/reference/results.md": "docs/tutorial.md"}
BLOCK = re.compile(r"(?:^<!-- (not run|file): (.*?) -->\n)?^```(sh|python)\n(.*?)^```\n(?:\n?^```text\n(.*?)^```\n)?", re.M | re.S)
SECONDS = 550  # of one page: a few of one core; ctest allows 600, and machines are busy
END = "--- end of a block ---"


def matches(wanted, printed):
    """The first line of `wanted` that `printed` does not have, in this order, or None."""
    lines = iter(printed.splitlines())
    for line in wanted.splitlines():
        pattern = re.compile(".*".join(re.escape(part) for part in line.strip().split("...")))
        if line.strip() and not any(pattern.fullmatch(l.strip()) for l in lines):
            return line
    return None


def run_page(blocks, folder, program):
    """What is wrong with blocks [(language, text, expected)] run in `folder`."""
    script = "set -euo pipefail\n"
    for language, text, _ in blocks:
        script += text if language == "sh" else "python3 - <<'END_OF_PYTHON'\n%sEND_OF_PYTHON\n" % text
        script += "\necho '%s'\n" % END
    path = os.path.dirname(program) + ":" + os.environ["PATH"]
    try:
        result = subprocess.run(["bash", "-c", script], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                                stdin=subprocess.DEVNULL, timeout=SECONDS, env={**os.environ, "PATH": path})
    except subprocess.TimeoutExpired:
        return ["takes more than %d s" % SECONDS]
    printed = result.stdout.split(END + "\n")
    if result.returncode != 0:
        failed = blocks[min(len(printed), len(blocks)) - 1][1]
        return ["exit status %d:\n%s%s" % (result.returncode, failed, printed[-1][-2000:])]
    problems = []
    for (_, text, expected), output in zip(blocks, printed):
        lacking = matches(expected or "", output)
        if lacking:
            problems.append("%sdoes not print '%s', but\n%s" % (text, lacking, output[-2000:]))
    return problems


class Known:
    """Flags, commands and options that exist."""

    def __init__(self, root, program):
        self.program, self.helps = program, {}
        self.dev = subprocess.run([os.path.join(root, "dev"), "help"], capture_output=True, text=True).stdout
        cmake = "".join(tree.read(root, p) for p in tree.files(root, ["CMakeLists.txt", "hal", "toolchains", "cmake"],
                                                               ("CMakeLists.txt", ".cmake")))
        self.options = set(re.findall(r"ACCRETE_\w+", cmake))
        self.options |= {"ACCRETE_WITH_" + name for name in re.findall(r"accrete_optional\((\w+)", cmake)}
        self.options |= {"ACCRETE_" + name for name in re.findall(r"accrete_part\((\w+)", cmake)}

    def help(self, command):
        if command not in self.helps:
            result = subprocess.run([self.program, command, "--help"], capture_output=True, text=True)
            self.helps[command] = result.stdout if result.returncode == 0 else None
        return self.helps[command]

    def check(self, text):
        problems = []
        text = re.sub(r"\s*\\\n\s*", " ", text)
        for command, rest in re.findall(r"(?:^|[\s/])accrete (\w+)([^|;&\n]*)", re.sub(r"#.*", "", text)):
            known = self.help(command)
            if known is None:
                problems.append("there is no accrete " + command)
                continue
            problems += ["accrete %s has no %s" % (command, flag) for flag in re.findall(r"(?<=\s)--?[a-z][a-z-]*", rest)
                         if not re.search(r"(?<![\w-])%s(?![\w-])" % re.escape(flag), known)]
        problems += ["there is no ./dev " + c for c in re.findall(r"\./dev ([\w-]+)", text) if "./dev " + c not in self.dev]
        problems += ["there is no option " + o for o in re.findall(r"-D(ACCRETE_\w+)", text) if o not in self.options]
        return problems


def check_page(text, folder, program, known):
    """(problems, blocks that were run, blocks that were only looked at)."""
    problems, run, looked_at = [], [], 0
    for mark, reason, language, block, expected in BLOCK.findall(text):
        if mark == "file":
            continue
        problems += known.check(block)
        if mark == "not run":
            looked_at += 1
            if len(reason.split()) < 2:
                problems.append("a block is not run, and nobody says why")
        else:
            run.append((language, block, expected))
    if run and not problems:
        problems += run_page(run, folder, program)
    return problems, len(run), looked_at


def main(root, program, work):
    shutil.rmtree(work, ignore_errors=True)
    known, problems, run, looked_at = Known(root, program), [], 0, 0
    pages = tree.files(root, ["docs/tutorial.md", "docs/howto", "docs/reference", "docs/troubleshooting.md"], (".md",))
    for page in sorted(pages, key=lambda p: (p in GOES_ON, p)):
        folder = os.path.join(work, os.path.basename(GOES_ON.get(page, page)))
        if not os.path.isdir(folder):
            os.makedirs(os.path.join(folder, "build/native/src/cli"))
            os.symlink(program, os.path.join(folder, "build/native/src/cli/accrete"))
            for name in ("bench", "examples"):
                os.symlink(os.path.join(root, name), os.path.join(folder, name))
        found, ran, looked = check_page(tree.read(root, page), folder, program, known)
        problems += ["%s: %s" % (page, p) for p in found]
        run, looked_at = run + ran, looked_at + looked
    if run < 10:
        problems.append("only %d blocks were run" % run)
    print("\n".join(problems) if problems else "%d blocks were run, %d only looked at" % (run, looked_at))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*[os.path.abspath(a) for a in sys.argv[1:]]) if len(sys.argv) == 4 else __doc__)
