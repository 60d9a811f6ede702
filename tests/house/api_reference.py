#!/usr/bin/env python3
"""api_reference.py ROOT [--write]: docs/reference/api.md is what the public headers say: their comments, and their
declarations without bodies and private parts. Every function and type has a comment: its own, or that of the lines that it
stands among, without a blank one in between. Operators, constructors and what is deleted or defaulted need none. --write: writes
the page."""
import os
import re
import sys

import tree

PAGE = "docs/reference/api.md"
HEAD = """# Every public header

Written by `tests/house/api_reference.py . --write` from the headers; not by hand. What crosses several of them:
[../conventions.md](../conventions.md) (frames, units, failures), [threads.md](threads.md), [../memory.md](../memory.md).

"""
NAMED = re.compile(r"^(?:template <[^>]*>\s*)*(?:enum class|class|struct)(?:\s*\[\[\w+\]\]| alignas\(\d+\))?"
                   r"\s+(\w+)(?![\w;])", re.M)


def without_bodies(code):
    """Function bodies become ';', initialiser lists vanish; braces of types, enums and values stay."""
    plain = re.sub(r"//[^\n]*", lambda m: " " * len(m.group()), code)  # the same positions
    out, kept, begin, i = "", 0, 0, 0  # `begin`: of the statement
    while i < len(plain):
        if plain[i] == "{" and opens_body(plain[begin:i]):
            end = closing(plain, i) + 1
            list_begin = re.search(r"\)\s*(:)(?!:)", plain[begin:i])
            remark = re.match(r"\{ *(//[^\n]*)\n", code[i:])
            out += code[kept:begin + list_begin.start(1) if list_begin else i].rstrip() + ";"
            out += "  " + remark.group(1) if remark else ""
            i = begin = kept = end + 1 if plain.startswith(";", end) else end
            continue
        if plain[i] in ";{}":
            begin = i + 1
        i += 1
    return out + code[kept:]


def opens_body(statement):
    """Whether the '{' after this opens the body of a function: parentheses end before it, and nothing is assigned."""
    statement = re.sub(r"operator\S+?\(", "operator(", re.sub(r"template <[^>]*>", "", statement)).strip()
    outside = re.sub(r"\([^()]*\)", "()", re.sub(r"\([^()]*\)", "()", statement))  # no default arguments
    return bool(re.search(r"\)(\s*(const|noexcept|override))*\s*(:(?!:).*)?$", outside, re.S)) and "=" not in outside


def closing(code, i):
    depth = 0
    for j in range(i, len(code)):
        depth += {"{": 1, "}": -1}.get(code[j], 0)
        if depth == 0:
            return j
    raise ValueError("a brace is never closed")


def public_part(code):
    """Without private members; structs have none."""
    return re.sub(r"\n private:\n.*?(?=^\};)", "\n", code, flags=re.M | re.S)


def split(text):
    """(comment of the header, its code inside the namespace)."""
    lines = text.splitlines()
    count = next(i for i, line in enumerate(lines) if not line.startswith("//"))
    begin = re.search(r"^namespace accrete[\w:]* \{\n", text, re.M)
    inside = text[begin.end():text.rindex("\n}  // namespace")] if begin else ""
    macros = [line.rstrip(" \\") for line in re.findall(r"^#define [^\n]*", text, re.M)]
    return lines[:count], "\n".join([inside.strip("\n"), ""] + macros)


def prose(comment):
    return " ".join(line.lstrip("/ ").rstrip() for line in comment)


def paragraphs(code):
    """Lines without a blank one between them, of a namespace or of a class."""
    return [p for p in re.split(r"\n\s*\n", code) if p.strip()]


FUNCTION = re.compile(r"^\s*(?:\[\[nodiscard\]\] )?(?:(?:static|virtual|constexpr|inline|explicit|friend) )*"
                      r"[\w:<>,&*\s]*?[\s&*]?(\w+|operator\S+)\([^;]*;", re.M)


def undocumented(name, code):
    """Paragraphs that declare a function or a type and have no comment at all."""
    problems = []
    for paragraph in paragraphs(code):
        first = paragraph.lstrip().splitlines()[0]
        declares = [m.group(1) for m in FUNCTION.finditer(paragraph)] or NAMED.findall(paragraph)
        plain = [d for d in declares if not d.startswith("operator") and "= delete" not in paragraph and "= default" not in paragraph
                 and not re.match(r"\s*~?%s\(" % d, first) and d not in ("static_assert",)]
        if plain and "//" not in paragraph and not re.match(r"^(class|struct) \w+;$", first):
            problems.append("%s: nobody says what this does: %s" % (name, first.strip()))
    return problems


def section(root, path):
    """(text of the page, problems) of one header."""
    name = path.split("include/", 1)[1]
    comment, code = split(tree.read(root, path))
    if not comment:
        return "", [name + ": has no comment at its beginning"]
    code = without_bodies(public_part(code)).strip() + "\n"
    code = re.sub(r"\n{3,}", "\n\n", code)
    problems = undocumented(name, code)
    link = os.path.relpath(path, os.path.dirname(PAGE))
    return "## [%s](%s)\n\n%s\n\n```c++\n%s```\n\n" % (name, link, prose(comment), code), problems


def page(root):
    text, problems, index = "", [], []
    for path in tree.files(root, ["include", "hal/include"], (".h",)):
        part, found = section(root, path)
        text, problems = text + part, problems + found
        name = path.split("include/", 1)[1]
        anchor = re.sub(r"[^\w-]", "", name)
        index.append("| [%s](#%s) | %s |" % (name, anchor, ", ".join("`%s`" % t for t in NAMED.findall(part))))
    return HEAD + "| header | types |\n|---|---|\n" + "\n".join(index) + "\n\n" + text.rstrip("\n") + "\n", problems


def main(root, write):
    text, problems = page(root)
    if write:
        with open(os.path.join(root, PAGE), "w", encoding="utf-8") as f:
            f.write(text)
    elif not os.path.isfile(os.path.join(root, PAGE)) or tree.read(root, PAGE) != text:
        problems.append("%s is out of date: python3 tests/house/api_reference.py . --write" % PAGE)
    print("\n".join(problems) if problems else "%s is what the headers say" % PAGE)
    return 1 if problems else 0


if __name__ == "__main__":
    arguments = [a for a in sys.argv[1:] if a != "--write"]
    sys.exit(main(arguments[0], "--write" in sys.argv) if len(arguments) == 1 else __doc__)
