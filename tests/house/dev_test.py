#!/usr/bin/env python3
"""dev_test.py ROOT: what `dev` does about packages, with an apt, a dpkg and a sudo of our own on the PATH."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = None
PLAIN = ["bash", "cat", "mkdir", "tail", "dirname", "readlink", "env", "grep", "head", "nproc"]  # what dev itself calls


class Dev(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.path = os.path.join(self.folder.name, "bin")
        self.log = os.path.join(self.folder.name, "calls")
        os.mkdir(self.path)
        for name in PLAIN:
            os.symlink(shutil.which(name), os.path.join(self.path, name))
        shutil.copy(os.path.join(ROOT, "dev"), self.folder.name)
        self.tool("apt-get", "exit 0")
        self.tool("dpkg-query", 'case "$4" in clang*) exit 1;; esac; printf installed')
        self.tool("id", "echo 1000")

    def tearDown(self):
        self.folder.cleanup()

    def tool(self, name, script):
        path = os.path.join(self.path, name)
        with open(path, "w", encoding="utf-8") as f:
            record = "" if name in ("dpkg-query", "id", "uname") else 'echo "%s $*" >> "%s"\n' % (name, self.log)
            f.write("#!/bin/bash\n" + record + script + "\n")
        os.chmod(path, 0o755)

    def dev(self, *arguments):
        result = subprocess.run([os.path.join(self.folder.name, "dev"), *arguments], capture_output=True, text=True,
                                env={"PATH": self.path}, stdin=subprocess.DEVNULL)
        if not os.path.exists(self.log):
            return result, []
        with open(self.log, encoding="utf-8") as f:
            return result, f.read().splitlines()

    def test_nothing_missing_means_no_apt(self):
        result, calls = self.dev("install", "demo")  # needs no clang
        self.assertEqual((result.returncode, calls), (0, []), result.stderr)

    def test_root_installs_what_is_missing(self):
        self.tool("id", "echo 0")
        result, calls = self.dev("install", "lint")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(len(calls), 2)
        self.assertTrue(calls[0].endswith("update"))
        self.assertTrue(calls[1].endswith("install -y --no-install-recommends clang clang-format clang-tidy"), calls[1])

    def test_another_user_takes_sudo(self):
        self.tool("sudo", 'exec "$@"')
        result, calls = self.dev("install", "lint")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual([c.split()[0] for c in calls], ["sudo", "apt-get", "sudo", "apt-get"])

    def test_without_sudo_the_exact_line_is_printed(self):
        result, calls = self.dev("install", "lint")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("apt-get update && apt-get install -y --no-install-recommends clang clang-format clang-tidy\n",
                      result.stderr)
        self.assertEqual(calls, [])

    def test_a_failing_apt_is_told(self):
        self.tool("id", "echo 0")
        self.tool("apt-get", "echo 'Temporary failure resolving'; exit 100")
        result, _ = self.dev("install", "lint")
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("Temporary failure resolving", result.stderr)
        self.assertIn("apt-get install", result.stderr)

    def test_another_system_is_not_stopped(self):
        os.remove(os.path.join(self.path, "dpkg-query"))
        result, calls = self.dev("install", "test")
        self.assertEqual((result.returncode, calls), (0, []))
        self.assertIn("libeigen3-dev", result.stderr)

    def test_wrong_words(self):
        for words, text in ((["demp"], "no command 'demp'"), (["demo", "chess"], "no demo 'chess'"),
                            (["install", "x"], "nothing to install for 'x'"),
                            (["hal-test", "quick"], "hal-test takes --short"),
                            (["cross"], "cross needs a target"), (["cross", "z80"], "no target 'z80'")):
            result, _ = self.dev(*words)
            self.assertNotEqual(result.returncode, 0)
            self.assertIn(text, result.stderr)

    def test_hal_test_is_skipped_visibly_where_there_is_no_virtual_machine(self):
        self.tool("dpkg-query", "printf installed")
        self.tool("uname", "echo Linux x86_64")
        result, _ = self.dev("hal-test")  # no qemu on this PATH
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("SKIPPED: there is no qemu-system-x86_64", result.stdout)
        self.assertIn("0 passed, 0 failed, 1 skipped", result.stdout)
        self.tool("uname", "echo Linux aarch64")
        result, _ = self.dev("hal-test", "--short")
        self.assertIn("SKIPPED: the virtual machine is made for Linux on x86-64", result.stdout)

    def test_help_lists_every_command(self):
        result, _ = self.dev("help")
        self.assertEqual(result.returncode, 0)
        for command in ("demo", "test", "hal-test", "evaluate", "determinism", "cross TARGET", "package", "lint", "install"):
            self.assertIn("./dev " + command, result.stdout)


if __name__ == "__main__":
    ROOT = sys.argv.pop(1)
    unittest.main()
