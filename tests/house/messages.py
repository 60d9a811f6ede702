#!/usr/bin/env python3
"""messages.py ROOT: every message that docs/troubleshooting.md explains, a line **`message`**, still is one of the program's or of
the build's: the pieces between "..." all stand in the literals of one file."""
import re
import sys

import tree

MESSAGE = re.compile(r"^\*\*`([^`\n]+)`\*\*$", re.M)
LITERAL = re.compile(r'"((?:\\.|[^"\\\n])*)"')


def literals(text):
    """The literals of a file; what is between two of them, and placeholders, is a line's end."""
    text = re.sub(r'(?<!\\)"\s*\n\s*"', "", text)
    found = "\n".join(m.replace("\\n", "\n").replace('\\"', '"') for m in LITERAL.findall(text))
    return re.sub(r"\{[^{}\n]*\}|\$\{\w+\}", "\n", found)


def pieces(message):
    return [piece.strip() for piece in message.split("...") if len(piece.strip()) > 1]


def says(text, message):
    """Whether a file with these literals can print the message."""
    return all(piece in text for piece in pieces(message))


def check(root):
    problems = []
    sources = [literals(tree.read(root, p)) for p in
               tree.files(root, ["src", "hal", "CMakeLists.txt", "cmake"], (".h", ".cpp", "CMakeLists.txt", ".cmake"))]
    messages = MESSAGE.findall(tree.read(root, "docs/troubleshooting.md"))
    for message in messages:
        if sum(map(len, pieces(message))) < 12 and "are OFF" not in message:
            problems.append("'%s' is too little to look for" % message)
        elif not any(says(text, message) for text in sources):
            problems.append("no file says '%s' any more" % message)
    if not messages:
        problems.append("docs/troubleshooting.md has no message")
    return problems, len(messages)


if __name__ == "__main__":
    found, count = check(sys.argv[1] if len(sys.argv) > 1 else ".")
    print("\n".join(found) if found else "%d messages still exist" % count)
    sys.exit(1 if found else 0)
