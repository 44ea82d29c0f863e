# SPDX-License-Identifier: MIT
"""Every key of scenes and cases is used by a test, a page or a case: one without use has no proof that it works."""
import re
import subprocess

from checking import build, check, root

PLACES = ("tests", "verification", "drivers/cases", "benchmarks")
KINDS = {".nml", ".py", ".pf"}
files = [path for place in PLACES for path in (root / place).rglob("*")
         if path.suffix in KINDS]
# As `key = ` of a namelist, or as a word in quotes of a test that writes one.
USED = {name for path in files for pair in re.findall(r"\b(\w+)\s*=|[\"'](\w+)[\"']", path.read_text(encoding="utf-8"))
        for name in pair}
# Parameters of the library, which its registry and the tests of umat/ hold.
EXEMPT = {"mud_host": set(), "mud_triax": {"material"}}


def keys(program):
    """Pairs of group and key of a template."""
    text = subprocess.run([program, "--template"], capture_output=True, text=True).stdout
    group, found = "", []
    for line in text.splitlines():
        if line.startswith("&"):
            group = line[1:].split()[0]
        elif key := re.match(r"\s+!?\s*(\w+)\s*=", line):
            found.append((group, key[1]))
    return found


def test_every_key_of_template_is_used():
    for folder, name in (("host", "mud_host"), ("drivers", "mud_triax")):
        found = keys(build / folder / name)
        idle = [f"&{group} {key}" for group, key in found if group not in EXEMPT[name] and key not in USED]
        check(f"every key of {name} --template is used", len(found) > 10 and not idle, idle)
