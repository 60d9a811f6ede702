#!/usr/bin/env python3
"""The checks of the house find what they are for: each is run on a small tree with one mistake in it."""
import contextlib
import io
import os
import subprocess
import sys
import tempfile
import unittest

import count_tests
import headers
import includes
import installed_sizes
import must_not_compile
import reuse_objects
import snippets
import stack_usage
import symbols
import tidy_tree
import tree

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "target"))
import targets_doc  # noqa: E402


class Tree(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.root = self.folder.name
        self.write("include/accrete/image.h", "#pragma once\n")
        self.write("src/extract/extract.h", '#pragma once\n#include "accrete/image.h"\n')
        self.write("src/stereo/match.cpp", '#include "extract/extract.h"\n')

    def tearDown(self):
        self.folder.cleanup()

    def write(self, path, text):
        full = os.path.join(self.root, path)
        os.makedirs(os.path.dirname(full), exist_ok=True)
        with open(full, "w", encoding="utf-8") as f:
            f.write(text)

    def finds(self, check, text):
        found = check(self.root)
        self.assertTrue(any(text in line for line in found), "%r not in %r" % (text, found))


class Includes(Tree):
    def test_a_sound_tree_is_clean(self):
        self.assertEqual(includes.check(self.root), [])

    def test_against_the_way_of_the_data(self):
        self.write("src/extract/bad.cpp", '#include "stereo/match.h"\n')
        self.write("src/stereo/match.h", "#pragma once\n")
        self.finds(includes.check, "stereo comes after extract")

    def test_core_and_hardware_layer(self):
        self.write("hal/include/accrete/hal/source.h", "#pragma once\n")
        self.write("src/store/bad.cpp", '#include "accrete/hal/source.h"\n')
        self.finds(includes.check, "the core does not know the hardware layer")

    def test_the_hardware_layer_knows_the_base_alone(self):
        self.write("include/accrete/params.h", "#pragma once\n")
        self.write("hal/replay.cpp", '#include "accrete/params.h"\n')
        self.finds(includes.check, "knows the base alone")
        self.write("hal/replay.cpp", '#include "extract/extract.h"\n')
        self.finds(includes.check, "knows the base alone")

    def test_nobody_includes_the_program(self):
        self.write("src/cli/run.h", "#pragma once\n")
        self.write("hal/replay.cpp", '#include "cli/run.h"\n')
        self.finds(includes.check, "only the program")

    def test_eigen_stays_in_math(self):
        self.write("src/math/solve.h", "#pragma once\n#include <Eigen/Core>\n")
        self.assertEqual(includes.check(self.root), [])
        self.write("src/filter/update.cpp", "#include <Eigen/Core>\n")
        self.finds(includes.check, "src/filter/update.cpp:1")

    def test_bridges_know_one_library_and_nobody_knows_them(self):
        self.write("include/accrete/interop/eigen.h", '#pragma once\n#include <Eigen/Core>\n#include "accrete/image.h"\n')
        self.assertEqual(includes.check(self.root), [])
        for path in ("src/cli/a.cpp", "hal/a.cpp", "include/accrete/image.h"):
            self.write(path, '#include "accrete/interop/eigen.h"\n')
            self.finds(includes.check, path + ":1: #include accrete/interop/eigen.h: only a user's program")
        self.write("include/accrete/interop/opencv.h", '#include <Eigen/Core>\n#include "extract/extract.h"\n')
        self.finds(includes.check, "opencv.h:1: #include Eigen/Core: only src/math knows Eigen")
        self.finds(includes.check, "opencv.h:2: #include extract/extract.h: a bridge knows the public headers")

    def test_the_core_neither_prints_nor_allocates(self):
        for line in ("#include <vector>", "#include <iostream>", "int* p = new int;", "void f() { throw 1; }",
                     "void f(int* p) { delete p; }", "void f() { printf(\"x\"); }"):
            self.write("src/store/bad.cpp", line + "\n")
            self.assertEqual(len(includes.check(self.root)), 1, line)
        for line in ("// new words: throw, delete", "A(const A&) = delete;", "auto* p = new (memory) T();",
                     'const char* s = "throw";', "int news = 0; renew();"):
            self.write("src/store/bad.cpp", line + "\n")
            self.assertEqual(includes.check(self.root), [], line)

    def test_a_missing_file_and_a_file_without_a_layer(self):
        self.write("src/store/bad.cpp", '#include "store/gone.h"\n')
        self.finds(includes.check, "no such file")
        self.write("src/other/new.cpp", "")
        self.finds(includes.check, "belongs to no layer")


class Tidy(Tree):
    def test_long_files_machine_paths_and_unregistered_tests(self):
        self.assertEqual(tidy_tree.check(self.root), [])
        self.write("src/store/long.cpp", "\n" * 401)
        self.finds(tidy_tree.check, "401 lines")
        self.write("docs/a.md", "see /" + "home/me/x\n")
        self.finds(tidy_tree.check, "docs/a.md:1")
        self.write("README.md", "data in ../" + "shared/data\n")
        self.finds(tidy_tree.check, "README.md:1")
        self.write("tests/lost_test.cpp", "")
        self.finds(tidy_tree.check, "not registered")
        self.write("include/accrete/bare.h", "")
        self.finds(tidy_tree.check, "#pragma once")

    def test_a_registered_test(self):
        self.write("tests/hal/found_test.cpp", "")
        self.write("tests/hal/CMakeLists.txt", "accrete_test(found_test accrete_hal)\n")
        self.assertEqual(tidy_tree.check(self.root), [])


class Compiled(Tree):
    def test_headers(self):
        self.assertIsNone(headers.check(self.root, "g++", "include/accrete/image.h"))
        self.write("include/accrete/image.h", "#pragma once\ninline std::size_t f() { return 0; }\n")
        self.assertIn("image.h", headers.check(self.root, "g++", "include/accrete/image.h"))

    def test_must_not_compile(self):
        path = "tests/must_not_compile/a.cpp"
        body = "#ifdef BROKEN\nint x = nothing;\n#endif\n"
        self.write(path, "// expect: nothing\n" + body)
        self.assertIsNone(must_not_compile.check(self.root, "g++", path))
        self.write(path, "// expect: another reason\n" + body)
        self.assertIn("lacks 'another reason'", must_not_compile.check(self.root, "g++", path))
        self.write(path, "// expect: nothing\nint x;\n")
        self.assertIn("must not", must_not_compile.check(self.root, "g++", path))
        self.write(path, "// expect: nothing\nint x = nothing;\n")
        self.assertIn("even without BROKEN", must_not_compile.check(self.root, "g++", path))

    def test_snippets(self):
        self.write("README.md", "[a](docs/a.md) [b](https://x)\n```cpp\n#include \"accrete/image.h\"\nint x = 1;\n```\n")
        self.write("docs/a.md", "```cpp\nif (true) {\n}\n```\n```sh\nnot [c](++)\n```\n")
        self.assertEqual(snippets.check(self.root, "g++"), ([], 2))
        self.write("docs/a.md", "```cpp\nint x = y;\n```\n")
        self.assertIn("docs/a.md: a block does not compile", snippets.check(self.root, "g++")[0][0])
        self.write("docs/a.md", "[gone](gone.md)\n")
        self.assertEqual(snippets.check(self.root, "g++"), (["docs/a.md: gone.md is not there"], 1))

    def test_shown_files(self):
        self.write("tests/install/x/CMakeLists.txt", "project(x)\n")
        self.write("docs/a.md", "```cpp\nint a;\n```\n")
        self.assertEqual(snippets.check(self.root, "g++"), (["tests/install/x/CMakeLists.txt is on no page of docs/"], 1))
        page = "<!-- file: tests/install/x/CMakeLists.txt -->\n```cmake\nproject(%s)\n```\n"
        self.write("docs/a.md", page % "x")
        self.assertEqual(snippets.check(self.root, "g++"), ([], 0))
        self.write("docs/a.md", page % "y")
        self.assertEqual(snippets.check(self.root, "g++")[0], ["docs/a.md: the block is not tests/install/x/CMakeLists.txt any more"])

    def test_reuse_objects(self):
        self.write("accrete/a.cpp", "int a;\n")
        self.write("build/a.o", "an object")
        command = "/usr/bin/ccache /usr/bin/g++ -I%s/accrete -O2 -MD -MF a.d -o a.o -c %s/accrete/a.cpp" % (self.root, self.root)
        known = [{"command": command, "directory": self.root + "/build", "file": self.root + "/accrete/a.cpp"}]

        def reused(command, root="/user/accrete"):
            said, files = reuse_objects.split(command.split(), root)
            return reuse_objects.find(known, self.root + "/accrete", said, files["-c"].replace(root, "@"))

        same = "/usr/bin/g++ -I/user/accrete -O2 -o b.o -c /user/accrete/a.cpp"
        self.assertEqual(reused(same), self.root + "/build/a.o")
        for other in (same.replace("-O2", "-O3"), same.replace("g++", "clang++"), same.replace("a.cpp", "b.cpp"), same + " -DX"):
            self.assertIsNone(reused(other), other)
        os.utime(self.root + "/build/a.o", (0, 0))
        self.assertIsNone(reused(same), "older than its source")

    def run_symbols(self, source):
        self.write("a.cpp", source)
        subprocess.run(["g++", "-std=c++20", "-O2", "-c", "a.cpp"], cwd=self.root, check=True)
        with contextlib.redirect_stdout(io.StringIO()) as out:
            return symbols.main("nm", [os.path.join(self.root, "a.o")]), out.getvalue()

    def test_symbols(self):
        self.assertEqual(self.run_symbols("int g(); int f() { return g(); }")[0], 0)
        for source, name in (("int* f() { return new int[99]; }", "operator new"),
                             ("#include <cstdlib>\nvoid* f(int n) { return std::malloc(n); }", "malloc"),
                             ("void f() { throw 1; }", "__cxa_throw"),
                             ("#include <vector>\nvoid f(std::vector<int>& v) { v.push_back(1); }", "operator new"),
                             ("#include <cstdlib>\nvoid f() { std::abort(); }", "abort"),
                             ("#include <cassert>\nvoid f(int x) { assert(x); }", "assert"),
                             ("#include <cstdio>\nvoid f(int x) { std::printf(\"%d\", x); }", "printf"),
                             ("int g(); int& f() { static int x = g(); return x; }", "guard")):
            status, text = self.run_symbols(source)
            self.assertEqual(status, 1, source)
            self.assertIn(name, text)


    def run_stack_usage(self, source):
        self.write("a.cpp", source)
        subprocess.run(["g++", "-std=c++20", "-O2", "-fstack-usage", "-c", "a.cpp"], cwd=self.root, check=True)
        return stack_usage.check(self.root)

    def test_stack_usage(self):
        self.assertIn("no .su file", stack_usage.check(self.root)[0][0])
        self.assertEqual(self.run_stack_usage("void g(char*); void f() { char a[4000]; g(a); }")[0], [])
        self.assertIn("at most 8192", self.run_stack_usage("void g(char*); void f() { char a[9000]; g(a); }")[0][0])
        self.assertIn("depends on values", self.run_stack_usage(
            "void g(void*); void f(int n) { g(__builtin_alloca(n)); }")[0][0])


class Counting(Tree):
    def test_counts(self):
        self.write("j.xml", """<testsuite>
          <testcase name="a" status="run"/>
          <testcase name="b" status="fail"><failure message=""/></testcase>
          <testcase name="c" status="notrun"><skipped message="SKIP_REGULAR_EXPRESSION_MATCHED"/></testcase>
          <testcase name="d" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/></testcase>
          <testcase name="e" status="notrun"><skipped message="Unable to find executable"/></testcase>
          <testcase name="f" status="disabled"/></testsuite>""")
        self.assertEqual(count_tests.count(os.path.join(self.root, "j.xml")), (1, 2, 3))

    def test_the_row_of_a_target(self):
        self.write("j.xml", """<testsuite><testcase name="a" status="run"/>
          <testcase name="b" status="notrun"><skipped message="SKIP_RETURN_CODE=77"/><system-out>SKIPPED: no camera here</system-out>
          </testcase></testsuite>""")
        page = ("<!-- counts: begin -->\n\n| target | what | passed | failed | skipped |\n|---|---|---:|---:|---:|\n"
                "| `one` | all | - | - | - |\n| `two` | the core | 7 | 0 | 0 |\n\n<!-- counts: end -->\n"
                "<!-- skipped: begin -->\n\n| target | tests | why |\n|---|---:|---|\n\n<!-- skipped: end -->\n")
        self.write("targets.md", page)
        targets_doc.main(os.path.join(self.root, "targets.md"), "one", os.path.join(self.root, "j.xml"))
        with open(os.path.join(self.root, "targets.md"), encoding="utf-8") as f:
            text = f.read()
        expected = page.replace("| `one` | all | - | - | - |", "| `one` | all | 1 | 0 | 1 |")
        self.assertEqual(text, expected.replace("---|\n\n<!-- skipped", "---|\n| `one` | 1 | no camera here |\n\n<!-- skipped"))


class Text(unittest.TestCase):
    def test_sizes_that_are_no_longer_what_the_page_says(self):
        page = installed_sizes.tables([("headers", 1000)], [("SmallLimits", 7000, 400)])
        for files, memory, wrong in (([("headers", 1040)], [("SmallLimits", 7000, 480)], 0),
                                     ([("headers", 1060)], [("SmallLimits", 7000, 400)], 1),
                                     ([("headers", 1000)], [("SmallLimits", 7001, 510)], 2),
                                     ([("headers", 1000), ("more", 1)], [("SmallLimits", 7000, 400)], 1)):
            self.assertEqual(wrong, len(installed_sizes.differences(page, installed_sizes.tables(files, memory))))

    def test_code_loses_comments_and_literals_but_no_line(self):
        text = "int a = 1'000; // new\n/* throw\n */ char c = '\"'; const char* s = \"new \\\" x\"; int b;\n"
        plain = tree.code(text)
        self.assertEqual(plain.count("\n"), text.count("\n"))
        self.assertNotIn("new", plain)
        self.assertNotIn("throw", plain)
        self.assertIn("int b", plain)


if __name__ == "__main__":
    unittest.main()
