# SPDX-License-Identifier: MIT
"""The tables of umat/README.md are what the library says of itself. Run with --write to renew them."""
import os
import pathlib
import re
import subprocess
import sys

root = pathlib.Path(os.environ.get("MUD_SOURCE_DIR") or pathlib.Path(__file__).parents[2])
build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or root / "build/release")
readme = root / "umat/README.md"
BLOCK = re.compile(r"(<!-- (mud_describe \w+) -->\n)(.*?)(<!-- end -->)", re.DOTALL)
PROMISED = {"mud_describe props", "mud_describe statev"}


def content(block):
    return subprocess.run([build / "drivers/mud_describe", block.split()[1]], check=True, capture_output=True,
                          text=True).stdout


text = readme.read_text(encoding="utf-8")
if "--write" in sys.argv:
    readme.write_text(BLOCK.sub(lambda m: m[1] + content(m[2]) + m[4], text), encoding="utf-8")
    sys.exit()
blocks = BLOCK.findall(text)
wrong = [what for _, what, held, _ in blocks if held != content(what)]
missing = PROMISED - {what for _, what, _, _ in blocks}
for what in wrong:
    print(f"FAILED umat/README.md, block {what}: not what it should be; renew with tests/umat/test_readme.py --write")
for what in missing:
    print(f"FAILED umat/README.md: no block {what}")
print(f"{len(blocks) - len(wrong)} passed, {len(wrong) + len(missing)} failed")
sys.exit(bool(wrong or missing))
