#!/usr/bin/env python3
"""count_tests.py JUNIT.xml: prints "passed failed skipped" of a ctest run. A test that could not run counts as failed."""
import sys
import xml.etree.ElementTree as ElementTree


def count(path):
    passed = failed = skipped = 0
    for case in ElementTree.parse(path).getroot().iter("testcase"):
        if case.find("failure") is not None or case.find("error") is not None:
            failed += 1
        elif case.find("skipped") is not None:
            # ctest says "skipped" of a program that is not there too; only a test that ran can skip.
            why = case.find("skipped").get("message", "")
            if case.get("status") == "notrun" and "SKIP" not in why:
                failed += 1
            else:
                skipped += 1
        elif case.get("status") == "disabled":
            skipped += 1
        else:
            passed += 1
    return passed, failed, skipped


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    try:
        print(*count(sys.argv[1]))
    except (OSError, ElementTree.ParseError) as error:
        sys.exit("count_tests.py: %s: %s" % (sys.argv[1], error))
