#!/usr/bin/env python3
"""targets_doc.py FILE TARGET JUNIT.xml: writes the row of TARGET, and why its tests are skipped, between the marks in FILE
(docs/targets.md)."""
import collections
import os
import re
import sys
import xml.etree.ElementTree as ElementTree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "house"))
import count_tests  # noqa: E402

BEGIN, END = "<!-- %s: begin -->\n", "<!-- %s: end -->\n"


def reason(case):
    """What a skipped test printed, without what is different on each machine."""
    output = case.findtext("system-out") or ""
    said = re.search(r"SKIPPED: (.*)", output) or re.search(r": Skipped\n(.*)", output) or re.search(r"skipped: (.*)", output)
    text = said.group(1) if said else case.find("skipped").get("message", "")
    return re.sub(r"\"?(/[\w.+-]+){2,}\"?", lambda m: os.path.basename(m.group().strip('"')), text).strip() or "no reason"


def replace(text, mark, body):
    before, rest = text.split(BEGIN % mark)
    return before + BEGIN % mark + "\n" + body + "\n" + END % mark + rest.split(END % mark)[1]


def old_lines(text, mark):
    return text.split(BEGIN % mark)[1].split(END % mark)[0].strip("\n").splitlines()


def main(path, target, junit):
    with open(path, encoding="utf-8") as f:
        text = f.read()
    passed, failed, skipped = count_tests.count(junit)
    if failed:
        sys.exit("targets_doc.py: %d tests failed: nothing is written" % failed)
    cases = ElementTree.parse(junit).getroot().iter("testcase")
    why = collections.Counter(reason(c) for c in cases if c.find("skipped") is not None or c.get("status") == "disabled")
    row = "| `%s` |" % target
    lines = old_lines(text, "counts")
    for i, line in enumerate(lines):
        if line.startswith(row):  # what the target is made of stays
            lines[i] = "%s%s| %d | 0 | %d |" % (row, line.split("|")[2], passed, skipped)
    text = replace(text, "counts", "\n".join(lines) + "\n")
    others = [line for line in old_lines(text, "skipped")[2:] if not line.startswith(row)]
    mine = ["%s %d | %s |" % (row, n, r.replace("|", "\\|")) for r, n in sorted(why.items())]
    text = replace(text, "skipped", "| target | tests | why |\n|---|---:|---|\n" + "\n".join(sorted(others + mine)) + "\n")
    with open(path, "w", encoding="utf-8") as f:
        f.write(text)


if __name__ == "__main__":
    if len(sys.argv) != 4:
        sys.exit(__doc__)
    main(*sys.argv[1:])
