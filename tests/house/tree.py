"""What the checks of the house share: our files, and their text without comments and literals."""
import os
import re
import subprocess


def files(root, folders, endings):
    """Paths relative to root, sorted; files that git ignores are not ours."""
    try:
        out = subprocess.run(["git", "-C", root, "ls-files", "--cached", "--others", "--exclude-standard", "--"] + folders,
                             check=True, capture_output=True, text=True).stdout.splitlines()
    except (OSError, subprocess.CalledProcessError):  # an unpacked archive, or no git
        out = []
        for folder in folders:
            path = os.path.join(root, folder)
            if os.path.isfile(path):
                out.append(folder)
            for base, _, names in os.walk(path):
                out += [os.path.relpath(os.path.join(base, n), root) for n in names]
    return sorted(p for p in set(out) if p.endswith(endings) and os.path.isfile(os.path.join(root, p)))


def read(root, path):
    with open(os.path.join(root, path), encoding="utf-8") as f:
        return f.read()


TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|"(?:\\.|[^"\\\n])*"|\'(?:\\.|[^\'\\\n])+\'', re.S)


def code(text):
    """The text without comments and literals; lines stay where they are. Digit separators survive."""
    text = re.sub(r"(?<=[0-9a-fA-F])'(?=[0-9a-fA-F])", "", text)
    return TOKEN.sub(lambda m: ("\n" * m.group().count("\n")) or ('""' if m.group()[0] in "\"'" else " "), text)


INCLUDE = re.compile(r'^[ \t]*#[ \t]*include[ \t]*([<"])([^>"]+)[>"]', re.M)


def includes(text):
    """(line number, quote, path) of every include that is not commented out."""
    plain = re.sub(r"/\*.*?\*/", lambda m: "\n" * m.group().count("\n"), text, flags=re.S)
    return [(plain.count("\n", 0, m.start()) + 1, m.group(1), m.group(2)) for m in INCLUDE.finditer(plain)]
