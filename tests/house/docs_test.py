#!/usr/bin/env python3
"""The checks of the documentation find what they are for: each is run on small pages with one mistake in them."""
import os
import stat
import unittest

import api_reference
import commands
import messages
import checks_test

HEADER = """// What it is for.
#pragma once

namespace accrete {

struct Pair {  // two numbers
  int a = 0, b = 0;
};

%s

}  // namespace accrete
"""
PROGRAM = """#!/bin/sh
case "$*" in
  "run --help") echo "  -o,--out FOLDER   where to" ;;
  *--help) exit 2 ;;
  *) echo "9 frames used"; echo "done" ;;
esac
"""


class Commands(checks_test.Tree):
    def setUp(self):
        super().setUp()
        self.write("bin/accrete", PROGRAM)
        self.program = os.path.join(self.root, "bin/accrete")
        os.chmod(self.program, os.stat(self.program).st_mode | stat.S_IXUSR)
        self.write("dev", "#!/bin/sh\necho './dev demo   shows it'\n")
        os.chmod(os.path.join(self.root, "dev"), 0o755)
        self.write("CMakeLists.txt", 'option(ACCRETE_HAL "")\naccrete_optional(PNG "")\n')

    def page(self, text):
        return commands.check_page(text, self.root, self.program, commands.Known(self.root, self.program))

    def test_blocks_run_in_one_shell(self):
        text = "```sh\nexport A=3\n```\n\n```python\nprint(2 + 2)\n```\n```sh\ntest $A = 3\n```\n"
        self.assertEqual(self.page(text), ([], 3, 0))

    def test_what_fails_is_found(self):
        for text, said in (("```sh\nfalse\ntrue\n```\n", "exit status 1"), ("```sh\nfalse | cat\n```\n", "exit status 1"),
                           ("```python\nraise ValueError\n```\n", "ValueError")):
            self.assertIn(said, self.page(text)[0][0])

    def test_what_is_printed_is_compared(self):
        block = "```sh\naccrete run\n```\n\n```text\n%s\n```\n"
        for same in ("9 frames used", "... frames used\ndone", "done", "9 ... used"):
            self.assertEqual(self.page(block % same)[0], [], same)
        for other in ("8 frames used", "done\n9 frames used", "frames used", "... frames"):
            self.assertIn("does not print", self.page(block % other)[0][0], other)

    def test_what_is_not_run_is_looked_at(self):
        block = "<!-- not run: it needs cameras -->\n```sh\n%s\n```\n"
        self.assertEqual(self.page(block % "accrete run v4l2:0,1 --out a && ./dev demo && cmake -DACCRETE_HAL=OFF -DACCRETE_WITH_PNG=ON"),
                         ([], 0, 1))
        for line, said in (("accrete run --fast", "accrete run has no --fast"), ("accrete walk", "there is no accrete walk"),
                           ("./dev dance", "there is no ./dev dance"), ("cmake -DACCRETE_HULL=ON", "no option ACCRETE_HULL"),
                           ("accrete run \\\n  --fast", "accrete run has no --fast")):
            self.assertEqual(len(self.page(block % line)[0]), 1, line)
            self.assertIn(said, self.page(block % line)[0][0])
        self.assertIn("nobody says why", self.page("<!-- not run: no -->\n```sh\nls\n```\n")[0][0])

    def test_files_belong_to_another_check(self):
        self.assertEqual(self.page("<!-- file: a.sh -->\n```sh\nfalse\n```\n"), ([], 0, 0))


class Messages(checks_test.Tree):
    def test_a_message_must_exist(self):
        self.write("hal/a.cpp", 'fail(name + " is not there: "\n     "check the name"); warn(fmt::format("{} frames of {} lost", n, m));\n')
        self.write("docs/troubleshooting.md", "**`... is not there: check the name`**\nLook.\n\n**`... frames of ... lost`**\nSo what.\n")
        self.assertEqual(messages.check(self.root), ([], 2))
        self.write("docs/troubleshooting.md", "**`... is not here: check the name`**\n")
        self.assertIn("no file says", messages.check(self.root)[0][0])
        self.write("docs/troubleshooting.md", "**`... is not there: check the name ... frames of ... found`**\n")
        self.assertIn("no file says", messages.check(self.root)[0][0])


class ApiReference(checks_test.Tree):
    def section(self, code):
        self.write("include/accrete/a.h", HEADER % code)
        return api_reference.section(self.root, "include/accrete/a.h")

    def test_bodies_and_private_parts_are_left_out(self):
        text, problems = self.section("// A sum.\ninline int sum(Pair p = {}) { return p.a + p.b; }\n\n// Holds one.\nclass Box {\n public:\n"
                                      "  explicit Box(int i) : i_(i), j_(i) {}\n  int f() const {  // of i\n    if (i_) { return 1; }\n"
                                      "    return 0;\n  }\n\n private:\n  int i_, j_;\n};")
        self.assertEqual(problems, [])
        for kept in ("int a = 0, b = 0;", "inline int sum(Pair p = {});", "  explicit Box(int i);\n", "  int f() const;  // of i\n", "What it is for."):
            self.assertIn(kept, text)
        for gone in ("return", "private", "i_"):
            self.assertNotIn(gone, text)

    def test_what_nobody_explains_is_found(self):
        for code in ("int sum(int a, int b);", "struct Bare {\n  int i;\n};", "[[nodiscard]] Pair f();",
                     "// A class.\nclass C {\n public:\n  // One.\n  int one();\n\n  int two();\n};"):
            self.assertEqual(len(self.section(code)[1]), 1, code)
        for code in ("// A sum.\nint sum(int a, int b);", "class Later;", "Pair operator+(const Pair& a, const Pair& b);"):
            self.assertEqual(self.section(code)[1], [], code)

    def test_an_old_page_is_found(self):
        self.write("include/accrete/image.h", HEADER % "// A sum.\nint sum();")
        os.makedirs(os.path.join(self.root, "docs/reference"))
        self.assertEqual(api_reference.main(self.root, True), 0)
        self.assertEqual(api_reference.main(self.root, False), 0)
        self.write("include/accrete/image.h", HEADER % "// A sum of none.\nint sum();")
        self.assertEqual(api_reference.main(self.root, False), 1)


if __name__ == "__main__":
    unittest.main()
