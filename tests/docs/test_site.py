# SPDX-License-Identifier: MIT
"""The pages of the site, as Sphinx gets them, the gallery and the tables of sources among them: what they link to and
what the margin lists exists. Sphinx itself, which scripts/site runs, is not needed for that."""
import re
import sys

from checking import check, root, work

sys.path[:0] = [str(root / "tests/docs"), str(root / "docs/site")]
import pages  # noqa: E402
import stage  # noqa: E402

TREE = re.compile(r"^```\{toctree\}\n(.*?)^```", re.DOTALL | re.MULTILINE)


def listed(text):
    """The pages that the lists of a page name."""
    lines = [line for found in TREE.findall(text) for line in found.splitlines() if line and not line.startswith(":")]
    return [line.split("<")[-1].rstrip(">") for line in lines]


def test_links_of_the_site():
    site = work / "site"
    stage.stage(root, site)
    texts = {path.relative_to(site).as_posix(): path.read_text(encoding="utf-8") for path in site.rglob("*.md")}
    wrong = [f"{name}: {fault}" for name, text in sorted(texts.items()) if not text.startswith(stage.ORPHAN)
             for fault in pages.broken(name, text, site, lambda path: pages.anchors(path.read_text(encoding="utf-8")))]
    check("no link of the site is broken", not wrong, "\n  " + "\n  ".join(wrong[:30]))
    missing = [name for name in listed(texts["index.md"]) if f"{name}.md" not in texts]
    check("every page of the margin exists", not missing, missing)
