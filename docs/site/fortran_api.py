# SPDX-License-Identifier: MIT
"""The Fortran API by FORD, without what its pages would load from the network."""
import pathlib
import re
import shutil
import subprocess
import sys

FOLDERS = ("umat/core", "umat/abi", "umat/include", "common", "materials", "drivers/src", "host")
PROJECT = """---
project: MUD
version: {version}
summary: The Fortran sources of MUD
{folders}
output_dir: {output}
css: {style}
predocmark: >
docmark: <
docmark_alt: #
predocmark_alt: |
display: public
source: false
graph: false
search: false
warn: false
preprocess: false
parallel: 0
print_creation_date: false
creation_date:
incl_src: false
---
Modules, types and procedures. What a comment calls a section of docs/theory is a section of the theory of this site.
"""
# What a page of FORD would fetch when it is viewed (Bootstrap, MathJax): fortran.css stands for the one, and no comment
# has formulas for the other.
FOREIGN = re.compile(r"<script[^>]*src=\"https?://[^>]*>\s*</script>|<link[^>]*href=\"https?://[^>]*>"
                     r"|<script type=\"text/x-mathjax-config\">.*?</script>", re.DOTALL)


def build(root, work, place):
    """Makes the folder `place`; SystemExit where FORD fails or warns."""
    output, project = work / "ford", work / "ford.md"
    version = re.search(r"project\(mud VERSION (\S+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
    folders = "src_dir: " + "\n    ".join(str(root / name) for name in FOLDERS)
    project.write_text(PROJECT.format(version=version, folders=folders, output=output,
                                      style=root / "docs/site/static/fortran.css"), encoding="utf-8")
    shutil.rmtree(output, ignore_errors=True)
    run = subprocess.run([str(pathlib.Path(sys.executable).parent / "ford"), "--quiet", str(project)], cwd=work,
                         capture_output=True, text=True)
    said = [line for line in (run.stdout + run.stderr).splitlines() if re.search(r"warning|error", line, re.IGNORECASE)]
    if run.returncode or said:
        print(run.stdout + run.stderr, file=sys.stderr)
        raise SystemExit("FORD failed or warned: see above")
    for page in output.rglob("*.html"):
        text = page.read_text(encoding="utf-8")
        page.write_text(FOREIGN.sub("", text), encoding="utf-8")
    shutil.copytree(output, place)
