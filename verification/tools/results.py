# SPDX-License-Identifier: MIT
"""Where a script that makes committed files of a page writes them: never into the source tree."""
import os
import pathlib

ROOT = pathlib.Path(__file__).resolve().parents[2]


def folder(script):
    """`build/verification/PAGE/made` for a script of a page, or what `verification/run PAGE --make` names."""
    page = pathlib.Path(script).resolve().parent.relative_to(ROOT / "verification")
    path = pathlib.Path(os.environ.get("MUD_VERIFICATION_OUTPUT") or ROOT / "build/verification" / page / "made")
    path.mkdir(parents=True, exist_ok=True)
    return path
