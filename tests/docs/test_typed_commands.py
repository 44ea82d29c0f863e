# SPDX-License-Identifier: MIT
"""What a page tells a user to type, a test types: every command in a block of the pages below is run here, in a session
of the manual (test_pages_of_manual.py), by another test that is named here, or by scripts/before_release."""
import os
import pathlib
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).parent))
from checking import build, check, light, root, work
import pages  # noqa: E402

PAGES = ["README.md", "umat/README.md", "python/README.md", "host/README.md", "host/SCENE.md", "host/OUTPUT.md",
         "drivers/README.md", "calibration/README.md", "clients/README.md",
         *sorted(str(path.relative_to(root)) for folder in ("docs/tutorials", "docs/how-to")
                 for path in (root / folder).glob("*.md"))]
PROGRAM = re.compile(r"^(?:\./)?(?:[\w.]+/)*(?:check|demo|run|cmake|cpack|pip|gcc|gfortran|ninja|reuse|fpm|conda|spack|"
                     r"mud_\w+|python3|scripts/\w+)(?= |$)")
# The beginning of a command: the test that types it, and what of it stands in that test.
ELSEWHERE = {
    "./check": ("scripts/run_suites.py", "ctest"),   # what runs this test
    "cmake --install build/release": ("tests/umat/test_install.py", '"cmake", "--install", build'),
    "cpack --config build/release/CPackConfig.cmake": ("tests/umat/test_install.py", '"cpack", "--config", build'),
    "gcc host.c": ("tests/umat/test_install.py", "one_gcc_line_with_pkg_config_links_the_shared_library"),
    "gfortran host.f90": ("tests/umat/test_install.py", "one_gfortran_line_with_pkg_config_links_the_archive"),
    "pip install .": ("tests/python/test_pip_install.py", '"pip", "install"'),
    "pip install '.[": ("scripts/before_release", "pip install '.[plots,host,frames,calibrate,study]'"),
    "mud_check_law libsoil.so": ("tests/python/test_check_law.py", "mud.check_law"),
    "mud_calibrate": ("tests/python/test_python_calibration.py", "mud.calibration.command"),
    "build/release/host/mud_host my.nml --output out --restart": ("tests/host/test_host_output.py", '"--restart"'),
    "mud_triax CASE.nml": ("tests/drivers/test_triax.py", "--output"),
    "mud_describe props": ("tests/umat/test_readme.py", "mud_describe"),
    "mud_describe HOST": ("tests/drivers/test_describe.py", "abaqus"),
    "build/release/drivers/mud_triax drivers/cases/undrained_e833_p100.nml --material out":
        ("tests/python/test_python_calibration.py", '"--material", path, "--output"')}
# Typed as they stand, in this order, in a folder that looks like the top of the tree.
HERE = ("build/release/host/mud_host", "build/venv/bin/python3 host/plot_run.py", "mud_triax --")
LONG = subprocess.run([root / "scripts/before_release", "--list"], capture_output=True, text=True).stdout


def commands(text):
    """Commands in blocks that are fenced without a language, or as a shell's, or indented."""
    blocks = [block.text for block in pages.blocks(text) if block.words[:1] in ([], ["sh"], ["bash"])]
    blocks += re.findall(r"(?:^    .*\n)+", pages.FENCE.sub("", text), re.MULTILINE)
    lines = re.sub(r" *\\\n\s*", " ", "\n".join(blocks)).splitlines()
    return [re.split(r"\s+#\s|\s{3,}", line.strip())[0].strip() for line in lines if PROGRAM.match(line.strip())]


def typed_elsewhere(command, read):
    """Whether a test that is named above, or before_release, types the command."""
    for beginning, (name, words) in ELSEWHERE.items():
        if command.startswith(beginning):
            return words in read(name)
    return any(command.startswith(line.split(maxsplit=1)[1].split()[0]) for line in LONG.splitlines())


def tree():
    """A folder whose programs are those of this build."""
    top = work / "tree"
    (top / "build/venv/bin").mkdir(parents=True)
    for entry in root.iterdir():
        if entry.name not in ("build", ".git"):
            (top / entry.name).symlink_to(entry)
    (top / "build/release").symlink_to(build)
    (top / "build/venv/bin/python3").write_text(f'#!/bin/sh\nexec "{sys.executable}" "$@"\n')
    (top / "build/venv/bin/python3").chmod(0o755)
    return top


read = lambda name: (root / name).read_text(encoding="utf-8")  # noqa: E731


def test_commands_are_found_and_nothing_else():
    sample = ("```\nmud_triax --help      all keys\n```\n\n    scripts/nothing --all   # what\n    not a command\n\n"
              "```c\nrun x\n```\n")
    check("commands are found, and nothing else", commands(sample) == ["mud_triax --help", "scripts/nothing --all"],
          commands(sample))
    check("a command that nobody types is seen", not typed_elsewhere("scripts/nothing --all", read))
    check("before_release says what it runs", "clients/check all" in LONG and "scripts/site" in LONG, LONG)


def test_every_command_of_the_pages_is_typed_by_a_test_or_before_a():
    found = [(page, command) for page in PAGES for command in commands(read(page))]
    here = [(page, command) for page, command in found if command.startswith(HERE) and not any(
        command.startswith(beginning) for beginning in ELSEWHERE)]
    idle = [f"{page}: {command}" for page, command in found if (page, command) not in here
            and not typed_elsewhere(command, read)]
    check("every command of the pages is typed by a test or before a release", not idle, "\n  " + "\n  ".join(idle))
    check("there are commands to look at", len(found) > 12, found)
    if not light:
        top = tree()
        environment = dict(os.environ, MPLBACKEND="Agg", OMP_NUM_THREADS="1",
                           PATH=f"{build / 'drivers'}:{build / 'host'}:{os.environ['PATH']}")
        for page, command in here:
            done = subprocess.run(["bash", "-c", command], cwd=top, capture_output=True, text=True, env=environment)
            check(f"{page}: {command}", done.returncode == 0, (done.stdout + done.stderr)[-1500:])
