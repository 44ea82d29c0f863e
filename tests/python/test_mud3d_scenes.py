# SPDX-License-Identifier: MIT
"""mud3d reads scene files: its own, and those of mud_host that its page names. The program itself needs dolfinx, which
the check does not install; the reader does not."""

import os
import sys

from checking import build, check, needs_plain_library, root, work

needs_plain_library()
os.environ["MUD_LIBRARY_DIR"] = str(build)
sys.path[:0] = [str(root / "python"), str(root / "clients/fenicsx")]
from mud3d.scene import Scene, SceneError  # noqa: E402

BODY = """&scene name = {name} fields = 'u' /   ! '/' is no end in a comment
&MESH r = 0, 1 r_cells = 1
      z = -1, 0 z_cells = 2 /
&elastic name = '7' Young = 1d4, poisson = 0.25 /
&region material = '7' /
&stage name = 'rest' analysis = "static" duration = 1 /
"""


def scene_of(text):
    file = work / "mud3d.nml"
    file.write_text(text, encoding="utf-8")
    return Scene(file)


def test_every_scene_of_the_page_is_read():
    files = sorted((root / "clients/fenicsx/scenes").glob("*.nml"))
    files += [root / "verification/host" / part for part in ("site/scene.nml", "terzaghi/scene.nml", "waves/column.nml",
                                                             "shaken_column/scene.nml", "layered_site/scene.nml")]
    for file in files:
        scene = Scene(file)
        check(f"{file.parent.name}/{file.name}: stages and regions", scene.stages and scene.regions, scene.__dict__)


def refusal(text):
    try:
        scene_of(text)
    except SceneError as problem:
        return str(problem)
    return ""


def test_words_numbers_and_texts():
    scene = scene_of(BODY.format(name="'Weald''s ! and \"clay\"'"))
    check("a quote written twice, marks within a text", scene.scene.name == "Weald's ! and \"clay\"", scene.scene.name)
    check("a number in letters of Fortran", scene.elastics[0].young == 1e4, scene.elastics[0])
    check("a number between quotes is a text", scene.elastics[0].name == scene.regions[0].material == "7",
          scene.regions)
    check("lists over two lines", (scene.mesh.r, scene.mesh.z_cells) == ([0.0, 1.0], [2.0]), scene.mesh)


def test_what_it_cannot_read_is_told():
    told = refusal(BODY.format(name="'clay"))
    check("a text that is not closed", "mud3d.nml:1: a quoted text is not closed" in told, told)
    told = refusal(BODY.format(name="'clay' wide = 1"))
    check("a key that it does not have", "&scene wide: this program does not carry this key" in told, told)
