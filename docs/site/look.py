# SPDX-License-Identifier: MIT
"""Pictures of pages of the site, by headless Chromium without a network; fails where a formula cannot be drawn.

A name that cannot be resolved stands for the network: whatever a page fetches from elsewhere would be missing.
"""
import pathlib
import shutil
import subprocess
import sys
import tempfile

work = pathlib.Path(__file__).resolve().parents[2] / "build/site"
PAGES = ("index", "README", "gallery", "c_header", "python_package", "fortran", "docs/theory/material",
         "docs/theory/host", "docs/theory/memory-rules", "docs/theory/contact", "docs/troubleshooting",
         "docs/tutorials/element_test", "docs/tutorials/own_sand", "umat/README", "host/README",
         "verification/studies/hard_cases/README", "verification/studies/cost/README")
OFFLINE = "--host-resolver-rules=MAP * ~NOTFOUND"
WIDTH, HEIGHT = 1280, 4200


def main():
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    if browser is None:
        sys.exit("there is no chromium; Debian: apt-get install chromium")
    pictures = work / "screenshots"
    shutil.rmtree(pictures, ignore_errors=True)
    pictures.mkdir(parents=True)
    wrong = []
    with tempfile.TemporaryDirectory() as profile:
        for page in PAGES:
            picture = pictures / (page.replace("/", "_") + ".png")
            subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", "--hide-scrollbars", OFFLINE,
                            f"--user-data-dir={profile}", f"--window-size={WIDTH},{HEIGHT}", f"--screenshot={picture}",
                            (work / "html" / f"{page}.html").as_uri()], check=True, capture_output=True, timeout=300)
            print(picture.relative_to(work.parents[1]))
            drawn = subprocess.run([browser, "--headless", "--no-sandbox", "--disable-gpu", OFFLINE, "--dump-dom",
                                    f"--user-data-dir={profile}", "--virtual-time-budget=60000",
                                    (work / "html" / f"{page}.html").as_uri()], check=True, capture_output=True,
                                   text=True, timeout=300).stdout
            formulas, good = drawn.count('class="math '), drawn.count("<mjx-container")
            if formulas != good or 'data-mml-node="merror"' in drawn:
                wrong.append(f"{page}: {good} of {formulas} formulas are drawn, {drawn.count('merror')} with an error")
    if wrong:
        sys.exit("\n".join(wrong))


if __name__ == "__main__":
    main()
