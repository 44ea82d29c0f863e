# SPDX-License-Identifier: MIT
"""A checkpoint of another scene is refused with the first key that differs, and with what it is here and there."""
import os
import re
import subprocess

from checking import build, check, root, work

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1"}
scene = work / "scene.nml"


def run(changed, *more):
    scene.write_text(changed)
    return subprocess.run([host, scene, "--output", work / "out", "--quiet", *more], capture_output=True, text=True,
                          env=environment)


def test_the_run_that_is_to_be_continued():
    # The stage of the rest alone: a few steps.
    text = (root / "tests/host/scenes/restart.nml").read_text().replace("../../..", str(root))
    text = text.replace("duration = 0.3\n", "duration = 0.01\n").replace("duration = 0.03\n", "duration = 0.001\n")

    done = run(text)
    kept = work / "out/checkpoint.h5"
    if done.returncode == 0 and kept.exists():   # without HDF5 there is no checkpoint to refuse
        support = re.search(r"&fix\s[^/]*/", text)[0]
        for what, changed, words in (
                ("a value", text.replace("void_ratio = 0.8", "void_ratio = 0.81"),
                 ("&region 1: void_ratio is 0.81 here, and 0.8 in the checkpoint",)),
                ("a list", text.replace("sigma = -100, -100, -100", "sigma = -100, -98, -100"),
                 ("&initial 1: sigma is -100 -98 -100 here, and -100 -100 -100 in",)),
                ("a history's past", text.replace("values = 1, 1.2", "values = 1, 1.3"),
                 ("history is ramp (its values so far: ", " here, and ramp (its values so far: ")),
                ("a group more", text + "&load group = 'top' kind = 'pressure' value = 1e-3 /\n",
                 ("the checkpoint has no &load ", "(top): group = top")),
                ("a group less", text.replace(support, "", 1), ("&fix ",)),
                ("a key more", text.replace("&region\n", "&region\n   rho_s = 2.6\n"),
                 ("the checkpoint has no &region 1: rho_s = 2.6",))):
            check(f"{what}: the scene differs", changed != text)
            done = run(changed, "--restart", kept)
            check(f"{what}: the key is named", done.returncode == 17 and len(done.stderr.splitlines()) == 1
                  and all(word in done.stderr for word in words), f"{done.returncode} {done.stderr}")
    else:
        check("the run that is to be continued", done.returncode == 0, done.stderr)
