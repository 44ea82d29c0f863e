# SPDX-License-Identifier: MIT
"""Where a script that makes committed files of a page writes them: never into the source tree, and not beside what
other programs have made."""
import hashlib
import os
import pathlib
import shutil

ROOT = pathlib.Path(__file__).resolve().parents[2]
PROGRAMS = ("host/mud_host", "drivers/mud_triax")
MARK = "programs"


def folder(script):
    """`build/verification/PAGE/made` for a script of a page, or what `verification/run PAGE --make` names."""
    page = pathlib.Path(script).resolve().parent.relative_to(ROOT / "verification")
    return current(os.environ.get("MUD_VERIFICATION_OUTPUT") or ROOT / "build/verification" / page / "made")


def current(path, build=None):
    """The folder `path`, emptied if what lies in it was not made with the present programs of `build`: a study that
    goes on, or takes a reference again, mixes no answers of two programs."""
    build = pathlib.Path(build or os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    path, digest = pathlib.Path(path), hashlib.sha256()
    for program in (build / name for name in PROGRAMS):
        digest.update(program.read_bytes() if program.exists() else b"none")
    mark = path / MARK
    path.mkdir(parents=True, exist_ok=True)
    if not mark.exists() or mark.read_text(encoding="utf-8") != digest.hexdigest():
        for inside in path.iterdir():   # It may be the working directory and stays.
            shutil.rmtree(inside) if inside.is_dir() else inside.unlink()
    mark.write_text(digest.hexdigest(), encoding="utf-8")
    return path
