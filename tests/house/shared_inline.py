#!/usr/bin/env python3
"""shared_inline.py NM ARCHIVE GXX SOURCE: the core shares no inline function with its users.

Of an inline function that both have, the linker keeps one: the user's may be compiled for another processor or with other
rules for rounding, and the library would run it. So the archive has no copy of an inline function of a public header, of
the standard library or of Eigen: all are inlined, and what is not has a name that nobody else uses."""
import os
import subprocess
import sys

import shell
import tree

# Templates of the public headers are emitted when they are instantiated; plain inline functions by a flag.
USER = """
template struct accrete::Transform<accrete::Left, accrete::Object>;
template struct accrete::Transform<accrete::Right, accrete::Left>;
template struct accrete::Transform<accrete::World, accrete::Left>;
template struct accrete::Transform<accrete::Left, accrete::Map>;
template class accrete::Result<accrete::Quaternion>;
template class accrete::Result<accrete::Pixel>;
template class accrete::Accumulator<accrete::SmallLimits>;
"""


def symbols(nm, path, kinds):
    found = set()
    for line in shell.run(nm, path).splitlines():
        word = line.split()
        if len(word) == 3 and word[1] in kinds:
            found.add(word[2])
    return found


def main(nm, archive, gxx, source):
    if not os.path.exists(gxx):
        print("skipped: only g++ emits every inline function, and there is none")
        return shell.SKIPPED
    headers = [h for h in tree.files(source, ["include/accrete"], (".h",)) if "/interop/" not in h]  # not of the binary interface
    text = "".join('#include "%s"\n' % h[len("include/"):] for h in headers) + USER
    user = archive + ".user.o"
    subprocess.run([gxx, "-std=c++20", "-O0", "-fkeep-inline-functions", "-I" + os.path.join(source, "include"), "-x", "c++",
                    "-c", "-", "-o", user], input=text, text=True, check=True)
    theirs = symbols(nm, user, "WVu")
    ours = symbols(nm, archive, "WVu")
    os.remove(user)
    problems = ["%s: the user's copy may take its place" % s for s in sorted(ours & theirs)]
    problems += ["%s: not ours alone" % s for s in sorted(ours) if "7accrete" not in s]
    if len([s for s in theirs if "7accrete" in s]) < 30:
        problems.append("the headers have hardly any inline function: was the user's object made as it should?")
    print("\n".join(problems) if problems else "%d copies in the archive, none of %d that a user may have" % (len(ours), len(theirs)))
    return 1 if problems else 0


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]) if len(sys.argv) == 5 else __doc__)
