# SPDX-License-Identifier: MIT
"""A checkpoint of another scene is refused with the first group that differs, and its line."""
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


def place(group, text, holds=""):
    """The words for a group that differs: the first of its name, or the one that holds a text."""
    at = text.rindex(group, 0, text.index(holds) if holds else text.index(group) + len(group))
    return f"{group} in line {text[:at].count(chr(10)) + 1} is another group, or has another key, value or file"


def test_the_run_that_is_to_be_continued():
    # The stage of the rest alone: a few steps.
    text = (root / "tests/host/scenes/restart.nml").read_text().replace("../../..", str(root))
    text = text.replace("duration = 0.3\n", "duration = 0.01\n").replace("duration = 0.03\n", "duration = 0.001\n")

    done = run(text)
    kept = work / "out/checkpoint.h5"
    if done.returncode == 0:
        support = re.search(r"&fix\s[^/]*/", text)[0]
        count = len(re.findall(r"^\s*&\w", text, re.M))
        for what, changed, words in (
                ("a value", text.replace("void_ratio = 0.8", "void_ratio = 0.81"), place("&region", text)),
                ("a list", text.replace("sigma = -100, -100, -100", "sigma = -100, -98, -100"),
                 place("&initial", text)),
                ("what is to come", text.replace("duration = 0.001\n", "duration = 0.002\n"),
                 place("&stage", text, "duration = 0.001\n")),
                ("a group more", text + "&load group = 'top' kind = 'pressure' value = 1e-3 /\n",
                 f"the checkpoint has no &load in line {text.count(chr(10)) + 1}, for its scene ended after {count} "),
                ("a group less", text.replace(support + "\n", "", 1), place("&fix", text)),
                ("the last group less", text[:text.rindex("\n&") + 1],
                 f"{count - 1} groups are here, and {count} were in the scene of the checkpoint"),
                ("a key more", text.replace("&region\n", "&region\n   rho_s = 2.6\n"), place("&region", text))):
            check(f"{what}: the scene differs", changed != text)
            done = run(changed, "--restart", kept)
            check(f"{what}: the group is named", done.returncode == 17 and len(done.stderr.splitlines()) == 1
                  and words in done.stderr, f"{words}: {done.returncode} {done.stderr}")
    else:
        check("the run that is to be continued", done.returncode == 0, done.stderr)
