# SPDX-License-Identifier: MIT
"""No memory is allocated in an update: a host that counts every malloc of its process, in all schemes and tangents."""
import pathlib
import re
import subprocess
import tempfile

from checking import build, check, preset, root


sanitized = preset == "sanitize"


def test_no_update_allocates():
    if sanitized:
        print("note: sanitizers have an allocator of their own: they look for leaks, but nothing is counted")
    cache = dict(re.findall(r"^(\w+):\w+=(.*)$", (build / "CMakeCache.txt").read_text(encoding="utf-8"), re.MULTILINE))
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder) / "counting_host"
        # -fno-builtin: a compiler that knows malloc might leave out the calls that the control counts.
        more = ["-DSANITIZED", "-fsanitize=address,undefined"] if sanitized else []
        subprocess.run([cache.get("CMAKE_C_COMPILER", "cc"), "-std=c11", "-Wall", "-Wextra", "-Werror", "-fno-builtin",
                        f"-I{root / 'umat/include'}", root / "tests/consumers/counting_host.c", build / "umat/libmud.a",
                        "-lgfortran", "-lgomp", "-lm", *more, "-o", program], check=True)
        # A hundred thousand updates in the release.
        text = subprocess.run([program, "4200" if preset == "release" else "200"], check=True, capture_output=True,
                              text=True).stdout

    lines = [line for line in text.splitlines() if "allocations" in line]
    counts = {line.split(":")[0]: int(line.split()[-1]) for line in lines}
    checks = [("24 variants of updates, one in pieces, 4 of batches and the control are counted", len(counts) == 30),
              ("the control's three allocations are seen", counts.get("control") == (0 if sanitized else 3)),
              ("every variant is updated and refuses one increment",
               sum(bool(re.search(r" [1-9]\d* done, 1 refused,", line)) for line in lines) == 24),
              ("increments in pieces are done", bool(re.search(r"^in pieces: [1-9]\d* done,", text, re.MULTILINE))),
              ("no point of a batch fails", sum(": 0 failed," in line for line in lines) == 4)]
    if not sanitized:
        checks += [(f"{name}: no allocation, found {count}", count == 0) for name, count in counts.items()
                   if name != "control"]
    for name, right in checks:
        check(name, right, text)
