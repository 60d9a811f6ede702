#!/usr/bin/env python3
"""The golden replay, on every machine that can be had here (docs/determinism.md).

determinism.py ROOT [--short] [--only NAME] [--renew]
    builds and runs all rows (or those whose name contains NAME), prints a table and says whether all hashes are equal
    and equal to tests/golden/determinism.txt; without --short and --only writes the table to docs/determinism.md.
    --renew: writes the hashes to the golden file, if all are equal.
determinism.py --check GOLDEN SET... -- PROGRAM
    a test: the short form of one program (after its emulator), with each instruction set, and with subnormals flushed by
    the processor. What needs AVX-512 runs in Bochs where the processor has none (bochs.py).
determinism.py --check-selftest GOLDEN SET... -- PROGRAM
    a test: the model of `accrete selftest` has the bits that GOLDEN says, with each instruction set.
    --check-short-selftest: of twelve frames, in which not every figure can be met.
determinism.py --check-fused OBJDUMP ARCHIVE
    a test: the archive has no fused multiply-add."""
import json
import os
import re
import shutil
import subprocess
import sys
import threading
import time

import bochs

# What must happen at least once, or else the replay proves little.
EVENTS = {"short": ["born", "stereo", "mono", "missed", "starved", "confirmed", "preserved", "deleted_undecided",
                    "deleted_background", "merged", "evicted"]}
EVENTS["long"] = EVENTS["short"] + ["ambiguous", "deleted_existence"]
RENEW = ("If the arithmetic was changed on purpose: ./dev determinism --renew, and say in the commit why. (On one build "
         "alone, two minutes: ./dev determinism --only 'x86-64 baseline, g++' --renew)")
NO_SETS = "-DACCRETE_INSTRUCTION_SETS=OFF"
ONE_LANE = "-DCMAKE_CXX_FLAGS=-DACCRETE_ISA=one_lane -DACCRETE_LANE_WIDTH=1"

# build folder: options of cmake
BUILDS = {
    "gcc": ["-DCMAKE_CXX_COMPILER=g++"],
    "clang": ["-DCMAKE_CXX_COMPILER=clang++"],
    "gcc-one-lane": ["-DCMAKE_CXX_COMPILER=g++", ONE_LANE, NO_SETS],
    "clang-one-lane": ["-DCMAKE_CXX_COMPILER=clang++", ONE_LANE, NO_SETS],
    "gcc-v3": ["-DCMAKE_CXX_COMPILER=g++", "-DACCRETE_MARCH=x86-64-v3"],
    "gcc-v4": ["-DCMAKE_CXX_COMPILER=g++", "-DACCRETE_MARCH=x86-64-v4"],
    "clang-v4": ["-DCMAKE_CXX_COMPILER=clang++", "-DACCRETE_MARCH=x86-64-v4"],
    "aarch64-linux-gnu": ["--toolchain", "toolchains/aarch64-linux-gnu.cmake"],
    "arm-linux-gnueabihf": ["--toolchain", "toolchains/arm-linux-gnueabihf.cmake"],
    "riscv64-linux-gnu": ["--toolchain", "toolchains/riscv64-linux-gnu.cmake"],
}
for core in ("m4", "m7", "m55"):
    BUILDS["arm-none-eabi-" + core] = ["--toolchain", "toolchains/arm-none-eabi.cmake", "-DACCRETE_CORTEX=" + core]
BOARDS = {"m4": "mps2-an386", "m7": "mps2-an500", "m55": "mps3-an547"}


def cortex(core):
    return ["qemu-system-arm", "-M", BOARDS[core], "-display", "none", "-monitor", "none", "-serial", "none",
            "-semihosting-config", "enable=on,target=native", "-kernel"]


# name, lanes, build, emulator, options; forms it runs. "avx512": on the processor, or else in Bochs, where the long form
# takes ten minutes, and which takes clang's vgatherqps with an index in ymm16 to ymm31 for illegal (Bochs 2.7).
AVX512 = "avx512"
LONG_IN_BOCHS = ("gcc",)
NOT_IN_BOCHS = ("clang-v4",)
ROWS = [
    ("x86-64 baseline, g++", 4, "gcc", [], ["--set", "baseline"], ("short", "long")),
    ("x86-64 AVX2 kernels, g++", 8, "gcc", [], ["--set", "avx2"], ("short", "long")),
    ("x86-64 AVX-512 kernels, g++", 16, "gcc", AVX512, ["--set", "avx512"], ("short", "long")),
    ("x86-64 baseline, g++, subnormals flushed", 4, "gcc", [], ["--set", "baseline", "--flush"], ("short", "long")),
    ("x86-64, one lane, g++", 1, "gcc-one-lane", [], [], ("short", "long")),
    ("x86-64, one lane, clang++", 1, "clang-one-lane", [], [], ("short", "long")),
    ("x86-64-v3 throughout, g++", 8, "gcc-v3", [], [], ("short", "long")),
    ("x86-64-v4 throughout, g++", 16, "gcc-v4", AVX512, [], ("short", "long")),
    ("x86-64-v4 throughout, clang++", 16, "clang-v4", AVX512, [], ("short", "long")),
    ("x86-64 baseline, clang++", 4, "clang", [], ["--set", "baseline"], ("short", "long")),
    ("x86-64 AVX2 kernels, clang++", 8, "clang", [], ["--set", "avx2"], ("short", "long")),
    ("x86-64 AVX-512 kernels, clang++", 16, "clang", AVX512, ["--set", "avx512"], ("short", "long")),
    ("AArch64, g++, emulated", 4, "aarch64-linux-gnu", ["qemu-aarch64"], [], ("short", "long")),
    ("AArch64, g++, emulated, subnormals flushed", 4, "aarch64-linux-gnu", ["qemu-aarch64"], ["--flush"], ("short",)),
    ("ARMv7 VFPv4, g++, emulated", 4, "arm-linux-gnueabihf", ["qemu-arm"], [], ("short", "long")),
    ("ARMv7 VFPv4, g++, emulated, subnormals flushed", 4, "arm-linux-gnueabihf", ["qemu-arm"], ["--flush"], ("short",)),
    ("RISC-V RV64GC, g++, emulated", 4, "riscv64-linux-gnu", ["qemu-riscv64"], [], ("short", "long")),
    ("Cortex-M4F, g++, emulated", 1, "arm-none-eabi-m4", cortex("m4"), [], ("short",)),
    ("Cortex-M7, g++, emulated", 1, "arm-none-eabi-m7", cortex("m7"), [], ("short",)),
    ("Cortex-M55, g++, emulated", 1, "arm-none-eabi-m55", cortex("m55"), [], ("short",)),
]


def execute(command):
    """(hashes, {event: count}) of one run, None where the processor lacks it. Raises ValueError on anything else."""
    result = subprocess.run(command, capture_output=True, text=True, timeout=1800, stdin=subprocess.DEVNULL)
    return outcome_of(command, result.returncode, result.stdout + result.stderr)  # semihosting prints on the latter


def outcome_of(command, status, text):
    if status == 77:
        return None
    found = re.search(r"^([0-9a-f]{16} [0-9a-f]{16}) (.*)$", text, re.M)
    if status != 0 or not found or found.group(1).startswith("0" * 16):
        raise ValueError("%s: exit status %d: %s" % (" ".join(command), status, text.strip()[:500]))
    return found.group(1), dict(re.findall(r"(\w+)=(\d+)", found.group(2)))


def execute_in_bochs(folder, command):
    """execute() of a program that needs AVX-512 and has no emulator. None, with a word, where Bochs cannot be had."""
    try:
        (status, text), = bochs.run(folder, [command], 600)
    except bochs.Unavailable as reason:
        print("no Bochs for AVX-512: %s" % reason)
        return None
    return outcome_of(command, status, text)


def golden(path):
    with open(path, encoding="utf-8") as f:
        return dict(line.split(None, 1) for line in f.read().splitlines() if line and not line.startswith("#"))


def never_happened(form, counts):
    return [e for e in EVENTS[form] if counts.get(e) == "0"]


def check(path, sets, program):
    expected = golden(path)["short"]
    bad = ran = 0
    for options in [["--set", s] for s in sets] + [["--set", sets[0], "--flush"]]:
        command = program + ["--short"] + options
        outcome = execute(command)
        if outcome is None and options == ["--set", AVX512] and len(program) == 1:
            outcome = execute_in_bochs(os.path.join(os.path.dirname(program[0]), "bochs"), command)
        if outcome is None:
            print("not here: %s" % " ".join(options))
            continue
        ran += 1
        state, measurements = outcome[0].split()
        if outcome[0] != expected:
            bad += 1
            print("%s: state %s, measurements %s\n  tests/golden/determinism.txt says %s" %
                  (" ".join(options), state, measurements, expected))
        missing = never_happened("short", outcome[1])
        if missing:
            bad += 1
            print("the replay no longer shows: " + ", ".join(missing))
    print(RENEW if bad else "%d runs, one hash: %s" % (ran, expected))
    return 1 if bad or not ran else 0


def check_selftest(path, sets, program, key="selftest", frames="60", statuses=(0,)):
    expected, bad, ran = golden(path).get(key), 0, 0
    for name in sets:
        result = subprocess.run(program + ["selftest", "--json", "--set", name, "--scene-frames", frames],
                                capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if result.returncode == 2 and "does not have it" in result.stderr:
            print("not here: " + name)
            continue
        ran += 1
        bits = json.loads(result.stdout)["model_bits"] if result.returncode in statuses else None
        if bits is None or bits != expected:
            bad += 1
            print("%s: exit status %d, model %s, but tests/golden/determinism.txt says %s\n%s" %
                  (name, result.returncode, bits, expected, result.stderr))
    print("If the numbers were changed on purpose: write the new one after `%s` in that file, and say in the commit why." % key
          if bad else "%d runs, one model: %s" % (ran, expected))
    return 1 if bad or not ran else 0


def check_short_selftest(path, sets, program):
    return check_selftest(path, sets, program, "selftest_short", "12", (0, 1))


def check_fused(objdump, archive):
    bad = fused(objdump, archive)
    print("\n".join("%s: multiplies and adds in one step" % o for o in bad) if bad else "nothing is fused")
    return 1 if bad else 0


def build(root, name):
    folder = os.path.join(root, "build", "determinism", name)
    os.makedirs(folder, exist_ok=True)
    kind = "MinSizeRel" if name.startswith("arm-none-eabi") else "Release"
    launcher = ["-DCMAKE_CXX_COMPILER_LAUNCHER=ccache"] if shutil.which("ccache") else []
    with open(os.path.join(folder, "build.log"), "w", encoding="utf-8") as log:
        for command in (["cmake", "-S", root, "-B", folder, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=" + kind,
                         "-DACCRETE_DETERMINISTIC=ON", "-DACCRETE_HAL=OFF", "-DACCRETE_TOOLS=OFF",
                         "-DACCRETE_TESTS=OFF", "-DACCRETE_REPLAY=ON", "-DACCRETE_WERROR=ON"] + launcher + BUILDS[name],
                        ["cmake", "--build", folder, "--target", "determinism"]):
            if subprocess.run(command, cwd=root, stdout=log, stderr=subprocess.STDOUT).returncode != 0:
                return None
    return os.path.join(folder, "tests", "determinism", "determinism")


# Fused multiply-adds of x86, AArch64, ARM and RISC-V: there must be none, whatever the compiler was told.
FUSED = re.compile(r"\t(vfn?m(add|sub|addsub|subadd)\w*|fn?m(add|sub|la|ls)(\.\w+)?|vfn?m[as][a-z.0-9]*)\s")


def fused_in_build(root, name):
    prefix = re.sub(r"-m\d+$", "", name) + "-" if "gnu" in name or "eabi" in name else ""
    return fused(prefix + "objdump", os.path.join(root, "build", "determinism", name, "src", "libaccrete.a"))


def fused(objdump, archive):
    """Object files of the core with fused multiply-adds."""
    text = subprocess.run([objdump, "-d", "--no-show-raw-insn", archive], check=True, capture_output=True, text=True).stdout
    member, members, bad = "", 0, set()
    for line in text.splitlines():
        if "file format" in line:
            member = line.split(":")[0]
            members += 1
        elif FUSED.search(line + " "):
            bad.add(member)
    if members < 10:
        raise ValueError("%s holds %d objects: is that the core?" % (archive, members))
    return sorted(bad)


def commands_of(row, forms, program):
    """{form: command}"""
    _, _, folder, emulator, options, possible = row
    prefix = [] if emulator == AVX512 else emulator
    return {form: prefix + [program] + (["--short"] if form == "short" and not folder.startswith("arm-none-eabi") else []) +
            options for form in forms if form in possible}


class Programs:
    """The program of a row, built when first asked for. None, and a problem of the table, where that fails."""

    def __init__(self, root, problems):
        self.root, self.problems, self.built = root, problems, {}

    def of(self, row):
        name = row[2]
        if name not in self.built:
            self.built[name] = build(self.root, name)
            if self.built[name] is None:
                self.problems.append("%s does not build: build/determinism/%s/build.log" % (name, name))
            else:
                self.problems += ["%s, %s: multiplies and adds in one step" % (name, o) for o in fused_in_build(self.root, name)]
        return self.built[name]


class InBochs(threading.Thread):
    """Rows that need AVX-512, all in one guest, while the other rows run."""

    def __init__(self, folder, rows, forms, programs):
        super().__init__(daemon=True)
        self.folder, self.results, self.problem = folder, [], None
        self.rows = [(row, [f for f in forms if f == "short" or row[2] in LONG_IN_BOCHS], programs.of(row)) for row in rows]
        self.rows = [r for r in self.rows if r[2] is not None]
        self.commands = [c for row in self.rows for c in commands_of(*row).values()]

    def run(self):
        try:
            self.results = bochs.run(self.folder, self.commands, 7200) if self.commands else []
        except (bochs.Unavailable, RuntimeError, OSError) as reason:
            self.problem = reason

    def execute(self, command):
        if self.problem is None:
            return outcome_of(command, *self.results[self.commands.index(command)])
        if isinstance(self.problem, bochs.Unavailable):
            print("no Bochs for AVX-512: %s" % self.problem)
            return None
        raise ValueError(str(self.problem))


class Table:
    HEAD = "| machine | lanes | short form | long form |\n|---|---|---|---|"

    def __init__(self):
        self.lines, self.hashes, self.problems, self.measured = {}, {"short": {}, "long": {}}, [], {}

    def add(self, row, forms, program, how=execute):
        name, lanes, folder = row[:3]
        commands, cells = commands_of(row, forms, program), []
        for form in ("short", "long"):
            if form not in commands:
                cells.append("-")
                continue
            try:
                outcome = how(commands[form])
            except (ValueError, OSError, subprocess.TimeoutExpired) as error:
                self.problems.append("%s, %s: %s" % (name, form, error))
                cells.append("failed")
                continue
            if outcome is None:
                cells.append("not on this processor")
                continue
            self.hashes[form].setdefault(outcome[0], []).append(name)
            self.problems += ["%s, %s: the replay no longer shows %s" % (name, form, e)
                              for e in never_happened(form, outcome[1])]
            cells.append("`%s`" % outcome[0].split()[0])
            self.measured[folder] = outcome[1]
        if how is not execute:
            name += ", emulated"
        self.lines[row[0]] = "| %s | %d | %s | %s |" % (name, lanes, *cells)
        print(self.lines[row[0]], flush=True)

    def text(self):
        return "\n".join([self.HEAD] + [self.lines[row[0]] for row in ROWS if row[0] in self.lines]) + "\n"


def compare(table, root, forms, renew):
    path = os.path.join(root, "tests", "golden", "determinism.txt")
    known = golden(path) if os.path.exists(path) else {}
    equal = True
    for form in forms:
        hashes = table.hashes[form]
        if len(hashes) > 1:
            equal = False
            for value, names in hashes.items():
                table.problems.append("%s form: state and measurements %s on %s" % (form, value, "; ".join(names)))
    if renew and equal and not table.problems:
        os.makedirs(os.path.dirname(path), exist_ok=True)
        known.update({form: next(iter(table.hashes[form])) for form in forms if table.hashes[form]})
        with open(path, "w", encoding="utf-8") as f:
            f.write("# The golden replay: hash of all states, hash of the measurements. Written by ./dev determinism --renew.\n"
                    "# selftest: the model of `accrete selftest`, and of twelve frames of it, written by hand.\n")
            f.writelines("%s %s\n" % (form, known[form]) for form in ("short", "long", "selftest", "selftest_short") if form in known)
    for form in forms:
        for value in table.hashes[form]:
            if value != known.get(form):
                table.problems.append("%s form: %s, but tests/golden/determinism.txt says %s. %s" %
                                      (form, value, known.get(form, "nothing"), RENEW))


def write_between_marks(path, mark, text):
    begin, end = "<!-- %s: begin -->\n" % mark, "<!-- %s: end -->\n" % mark
    with open(path, encoding="utf-8") as f:
        before, rest = f.read().split(begin)
    with open(path, "w", encoding="utf-8") as f:
        f.write(before + begin + "\n" + text + "\n" + end + rest.split(end)[1])


def cortex_table(root, measured):
    """Code, memory and stack of the three microcontrollers, for docs/memory.md."""
    lines = ["| core | code | Accumulator | stack of a step | largest frame |", "|---|---|---|---|---|"]
    for core, name in (("m4", "Cortex-M4F"), ("m7", "Cortex-M7"), ("m55", "Cortex-M55")):
        folder = os.path.join(root, "build", "determinism", "arm-none-eabi-" + core)
        program = os.path.join(folder, "tests", "determinism", "determinism")
        size = subprocess.run(["arm-none-eabi-size", program], check=True, capture_output=True, text=True).stdout
        code = int(size.splitlines()[1].split()[0])
        symbols = subprocess.run(["arm-none-eabi-nm", "-S", program], check=True, capture_output=True, text=True).stdout
        accumulator = int(re.search(r"^\w+ (\w+) \w \S*accumulator_memory\S*$", symbols, re.M).group(1), 16)
        counts = measured["arm-none-eabi-" + core]
        frame = 0
        for base, _, names in os.walk(os.path.join(folder, "src")):
            for su in (n for n in names if n.endswith(".su")):
                with open(os.path.join(base, su), encoding="utf-8") as f:
                    frame = max([frame] + [int(line.split("\t")[1]) for line in f if "/extract/" not in line])
        lines.append("| %s | %d | %d | %s | %d |" % (name, code, accumulator, counts["stack"], frame))
    return "\n".join(lines) + "\n"


def main(root, forms, only, renew):
    rows = [r for r in ROWS if only in r[2] or only in r[0]]
    if not rows:
        print("nothing is called '%s'; builds are %s" % (only, ", ".join(BUILDS)))
        return 1
    table, begin = Table(), time.time()
    programs = Programs(root, table.problems)
    late = [] if bochs.host_has_avx512() else [row for row in rows if row[3] == AVX512]
    in_bochs = InBochs(os.path.join(root, "build", "determinism", "bochs"),
                       [row for row in late if row[2] not in NOT_IN_BOCHS], forms, programs)
    in_bochs.start()
    print(Table.HEAD)
    for row in rows:
        if row not in late and programs.of(row):
            table.add(row, forms, programs.of(row))
    in_bochs.join()
    for row, its_forms, program in in_bochs.rows:
        table.add(row, its_forms, program, in_bochs.execute)
    for row in (r for r in late if r[2] in NOT_IN_BOCHS):
        table.add(row, (), "")
    compare(table, root, forms, renew)
    print("\n".join(table.problems) if table.problems else
          "%d rows, all hashes are equal (%d s)" % (len(table.lines), time.time() - begin))
    if table.problems:
        return 1
    if all("arm-none-eabi-" + c in table.measured for c in BOARDS):
        memory = cortex_table(root, table.measured)
        print("\n" + memory)
        write_between_marks(os.path.join(root, "docs", "memory.md"), "microcontrollers", memory)
    if not only and "long" in forms:
        write_between_marks(os.path.join(root, "docs", "determinism.md"), "table", table.text())
    return 0


if __name__ == "__main__":
    arguments = sys.argv[1:]
    checks = {"--check": check, "--check-selftest": check_selftest, "--check-short-selftest": check_short_selftest}
    if arguments and arguments[0] in checks and "--" in arguments[3:]:
        dashes = arguments.index("--")
        sys.exit(checks[arguments[0]](arguments[1], arguments[2:dashes], arguments[dashes + 1:]))
    if arguments[:1] == ["--check-fused"] and len(arguments) == 3:
        sys.exit(check_fused(*arguments[1:]))
    if not arguments or arguments[0].startswith("-"):
        sys.exit(__doc__)
    where, rest, flags = os.path.abspath(arguments[0]), arguments[1:], {"--only": ""}
    while rest:
        flag = rest.pop(0)
        if flag not in ("--short", "--renew", "--only") or (flag == "--only" and not rest):
            sys.exit("determinism.py: '%s' is no option\n%s" % (flag, __doc__))
        flags[flag] = rest.pop(0) if flag == "--only" else True
    sys.exit(main(where, ("short",) if "--short" in flags else ("short", "long"), flags["--only"], "--renew" in flags))
