#!/usr/bin/env python3
"""symbols.py NM FILE...: objects and archives of the core call no allocator, throw nothing, stop nothing, print nothing.

The memory rule of docs/conventions.md, proven on what the compiler made. contract.cpp is where a program may be stopped.
And they call no function of libm but those whose result IEEE 754 fixes to the last bit (docs/determinism.md)."""
import re
import subprocess
import sys

# Demangled names, as nm -C prints them.
FORBIDDEN = re.compile(r"""^(
    operator\ (new|delete)\b.*
  | (malloc|calloc|realloc|reallocarray|free|posix_memalign|aligned_alloc|memalign|valloc|alloca|strdup|sbrk|mmap)
  | __cxa_(allocate_exception|throw|rethrow|begin_catch|end_catch|throw_bad_array_new_length|guard_\w+|atexit|pure_virtual)
  | _Unwind_\w+ | __gxx_personality_v0 | std::terminate.* | std::__throw_.* | std::bad_alloc.* | std::__cxx11::.*
  | __dynamic_cast | (vtable|typeinfo)\ for\ std::.*
  | abort | exit | _exit | _Exit | __assert\w* | __stack_chk_fail | raise
  | (v?f?printf|v?s?n?printf|puts|putchar|fputs|fwrite|write|perror)(_chk)? | __\w*printf_chk | std::(cout|cerr|clog)
  | (time|clock|clock_gettime|gettimeofday|getenv|rand|srand)
  )(@.*)?$""", re.X)
# Neither sqrt, floor, ceil, trunc, round and their kin, nor fmin, fmax, fabs and ldexp: those are exact everywhere.
INEXACT = re.compile(r"""^_*(
    a?(sin|cos|tan)h? | atan2 | sincos(pi)? | exp(2|10|m1)? | log(2|10|1p|b)? | pow | cbrt | hypot | erfc? | [lt]gamma
  | fma | fmod | remainder | c(abs|arg|exp|log|pow|sqrt)
  )[fl]?(_finite)?(@.*)?$""", re.X)
MAY_STOP = {"contract.cpp.o": re.compile(r"^(abort|raise)(@.*)?$")}


def undefined(nm, path):
    """(member or file, demangled undefined symbol) of one archive or object."""
    result = subprocess.run([nm, "-u", "-C", path], capture_output=True, text=True)
    if result.returncode != 0:
        raise OSError(result.stderr.strip())
    member = path.rsplit("/", 1)[-1]
    for line in result.stdout.splitlines():
        if line.endswith(":"):
            member = line[:-1].rsplit("/", 1)[-1]
        elif line.strip():
            yield member, line.strip().split(None, 1)[1]  # "U name", "w name"


def main(nm, paths):
    problems = []
    count = 0
    for path in paths:
        for member, symbol in undefined(nm, path):
            count += 1
            allowed = MAY_STOP.get(member)
            if INEXACT.match(symbol):
                problems.append("%s: %s uses '%s': src/base/elementary.h has the library's own" % (path, member, symbol))
            if FORBIDDEN.match(symbol) and not (allowed and allowed.match(symbol)):
                problems.append("%s: %s uses '%s'" % (path, member, symbol))
    if count == 0:
        problems.append("no undefined symbols at all in %s: is that the library?" % ", ".join(paths))
    print("\n".join(problems) if problems else "%d undefined symbols, none of an allocator, an exception or an inexact function" % count)
    return 1 if problems else 0


if __name__ == "__main__":
    if len(sys.argv) < 3:
        sys.exit(__doc__)
    try:
        sys.exit(main(sys.argv[1], sys.argv[2:]))
    except OSError as error:
        sys.exit("symbols.py: %s" % error)
