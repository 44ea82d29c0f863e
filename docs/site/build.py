# SPDX-License-Identifier: MIT
"""Builds the site into build/site/html: gathers the pages and runs Sphinx. Every warning is an error."""
import pathlib
import re
import shutil
import subprocess
import sys

import stage

root = pathlib.Path(__file__).resolve().parents[2]
work = root / "build/site"
# What a browser would fetch from elsewhere when it shows a page; links that a reader follows are no such thing.
FETCH = re.compile(r"""<(?:script|img|iframe)[^>]*src="(?:https?:)?//|<link[^>]*href="(?:https?:)?//|url\(["']?https?:""")


def main():
    pages, html = work / "pages", work / "html"
    stage.stage(root, pages)
    shutil.rmtree(html, ignore_errors=True)
    run = subprocess.run([sys.executable, "-m", "sphinx", "-q", "-W", "--keep-going", "-b", "html", "-c",
                          str(root / "docs/site"), "-d", str(work / "doctrees"), str(pages), str(html)])
    if run.returncode:
        return run.returncode
    if fetched := [str(page.relative_to(html)) for page in sorted(html.rglob("*")) if page.suffix in (".html", ".css")
                   and FETCH.search(page.read_text(encoding="utf-8"))]:
        print("these pages would load something from the network:", *fetched, sep="\n   ", file=sys.stderr)
        return 1
    print(f"the site is in {html.relative_to(root)}/index.html")
    return 0


if __name__ == "__main__":
    sys.exit(main())
