# SPDX-License-Identifier: MIT
"""A state variable and a parameter of a trial, added to a copy of the tree as CONTRIBUTING.md says: in mud_registry,
mud_state and mud_start the one, in mud_registry and mud_params the other. What follows from the registry follows.

The trial counts the updates of a point and keeps in `trial` what the parameter `trial_step` says of each.
"""
import os
import re
import shutil
import subprocess
import sys

from checking import build, check, needs_nightly, root, work
import tables  # noqa: E402 (checking knows its folder)

needs_nightly("a build of library and drivers: ./check --tier nightly makes it")

CORE = "umat/core/"
# File, a text of it, and what the trial makes of that text.
STATE = [
    (CORE + "base/mud_registry.f90", "S_GAP, S_MARGIN, S_STACK", "S_GAP, S_MARGIN, S_TRIAL, S_STACK"),
    (CORE + "base/mud_registry.f90", "S_STACK = S_MARGIN + 1", "S_TRIAL = S_MARGIN + 1, S_STACK = S_TRIAL + 1"),
    (CORE + "base/mud_registry.f90", "      variable_t(S_STACK, 6, 'memory_#'",
     "      variable_t(S_TRIAL, 1, 'trial', 'T', '1', .false., 'ours', 'steps of the trial', '0', 'adds up'), &\n"
     "      variable_t(S_STACK, 6, 'memory_#'"),
    (CORE + "laws/mud_state.f90", "use mud_registry, only: NSTATV,", "use mud_registry, only: S_TRIAL, NSTATV,"),
    (CORE + "laws/mud_state.f90", "      real(wp) :: p_c          !<",
     "      real(wp) :: trial\n      real(wp) :: p_c          !<"),
    (CORE + "laws/mud_state.f90", "      call require(statev, S_VOID_RATIO,",
     "      call require(statev, S_TRIAL, 0.0_wp, huge(1.0_wp), status)\n      call require(statev, S_VOID_RATIO,"),
    (CORE + "laws/mud_state.f90", "      state%s_w = statev(S_SATURATION)\n",
     "      state%trial = statev(S_TRIAL)\n      state%s_w = statev(S_SATURATION)\n"),
    (CORE + "laws/mud_state.f90", "      statev(S_SATURATION) = state%s_w\n",
     "      statev(S_TRIAL) = state%trial\n      statev(S_SATURATION) = state%s_w\n"),
    (CORE + "integration/mud_start.f90", "      state%p_c = p_c\n",
     "      state%trial = 0.0_wp\n      state%p_c = p_c\n")]
PARAMETER = [
    (CORE + "base/mud_registry.f90", "P_RHO_E, P_SHEAR_ORDER,", "P_RHO_E, P_TRIAL, P_SHEAR_ORDER,"),
    (CORE + "base/mud_registry.f90", "   integer, parameter :: P_SHEAR_ORDER = ",
     "   integer, parameter :: P_TRIAL = 46\n   integer, parameter :: P_SHEAR_ORDER = "),
    (CORE + "base/mud_registry.f90", "      property_t(P_SHEAR_ORDER,",
     "      property_t(P_TRIAL, 'trial_step', '-', '1', KIND_REAL, 0.0_wp, 9.0_wp, 1.0_wp, 'ours', &\n"
     "         'step of the trial'), &\n"
     "      property_t(P_SHEAR_ORDER,"),
    (CORE + "laws/mud_params.f90", "P_RHO_E, P_SHEAR_ORDER,", "P_RHO_E, P_TRIAL, P_SHEAR_ORDER,"),
    (CORE + "laws/mud_params.f90", "      real(wp) :: rho_e     !<",
     "      real(wp) :: trial_step\n      real(wp) :: rho_e     !<"),
    (CORE + "laws/mud_params.f90", "      params%rho_e = props(P_RHO_E)\n",
     "      params%rho_e = props(P_RHO_E)\n      params%trial_step = props(P_TRIAL)\n")]
# The physics: every update adds a step.
PHYSICS = [(CORE + "integration/mud_start.f90", "      if (.not. present(blocks)) return\n",
            "      if (.not. present(blocks)) return\n      state%trial = state%trial + par%trial_step\n")]
FROM_PYTHON = """
import mud
sand = mud.Material(trial_step=2.0)
stress, statev = sand.initial_state([-100.0]*3 + [0.0]*3, void_ratio=0.735)
for _ in range(3):
    done = sand.update(stress, statev, [-1e-4, 5e-5, 5e-5, 0.0, 0.0, 0.0])
    stress, statev = done.stress, done.statev
print(float(mud.state(statev, "trial")))
try:
    mud.Material(trial_step=10.0)
except mud.InputError as told:
    print(told)
"""


def changed(text, old, new):
    if text.count(old) != 1:
        raise ValueError(f"{text.count(old)} times in its file: {old}")
    return text.replace(old, new)


def add_entries(tree):
    """The edits of the trial. Numbers of parameters behind the new one, and the layout of STATEV, are one more."""
    registry = tree / CORE / "base/mud_registry.f90"
    text = registry.read_text(encoding="utf-8")
    text = re.sub(r"\b(P_\w+|NPROPS) = (\d+)\b", lambda m: f"{m[1]} = {int(m[2]) + (int(m[2]) >= 46)}", text)
    text = re.sub(r"(STATE_LAYOUT) = (\d+)", lambda m: f"{m[1]} = {int(m[2]) + 1}", text)
    registry.write_text(text, encoding="utf-8")
    for name, old, new in STATE + PARAMETER + PHYSICS:
        path = tree / name
        path.write_text(changed(path.read_text(encoding="utf-8"), old, new), encoding="utf-8")


def run(*command, **environment):
    done = subprocess.run([str(word) for word in command], cwd=work, capture_output=True, text=True,
                          env={**os.environ, **environment})
    return done.returncode, done.stdout + done.stderr


def places(table):
    """{name: place} of a table of mud_describe."""
    return {name: int(place) for place, name in re.findall(r"^\| (\d+) \| `(\w+)`", table, re.MULTILINE)}


def test_what_follows_from_the_registry_follows():
    tree, folder = work / "tree", work / "built"
    shutil.copytree(root, tree, ignore=lambda path, names: [n for n in names if n in ("build", ".git")])
    add_entries(tree)
    # As the presets compile it, warnings are errors, but without optimisation.
    code, told = run("cmake", "-S", tree, "-B", folder, "-G", "Ninja", "-DMUD_BUILD_HOST=OFF", "-DMUD_BUILD_TESTS=OFF",
                     "-DMUD_WERROR=ON", f"-DMUD_PYTHON={sys.executable}",
                     "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_Fortran_FLAGS_DEBUG=-O0", "-DCMAKE_C_FLAGS_DEBUG=-O0")
    code, told = run("cmake", "--build", folder, "-j", "2") if code == 0 else (code, told)
    check("the library with both builds without a warning", code == 0, told[-3000:])

    def described(programs, what):
        return run(programs / "drivers/mud_describe", what)[1]

    for table, name, behind in (("statev", "trial", "isotropic_margin"), ("props", "trial_step", "rho_e")):
        before, now = places(described(build, table)), places(described(folder, table))
        check(f"{table} has it behind {behind}, and all else in its order",
              now.pop(name, 0) == before[behind] + 1 and list(now) == list(before), now)
    cards = [described(programs, "abaqus") for programs in (build, folder)]
    counts = [[int(n) for n in re.search(r"constants=(\d+)[^*]*\*Depvar\s+(\d+),", card).groups()] for card in cards]
    check("the card of Abaqus counts both and names the state variable",
          counts[1] == [n + 1 for n in counts[0]] and ", trial, " in cards[1], counts)
    check("OpenGeoSys is told the parameter by its name", "trial_step" in described(folder, "ogs"), "")

    case = root / "drivers/cases/undrained_e735_p100.nml"
    ends = []
    for programs in (build, folder):
        code, told = run(programs / "drivers/mud_triax", case, "--output", "rows.csv", "--quiet")
        ends.append(tables.numbers(work / "rows.csv")[-1] if code == 0 else {"told": told})
    # Another order of rounding: 1e-6 of the numbers, far below the tolerance of the integration.
    check("a case gives what it gave", all(abs(ends[0].get(name, 0) - ends[1].get(name, 1)) <= 1e-6*ends[0].get(name, 0)
                                           for name in ("p_eff", "q", "e")), ends)
    code, told = run(sys.executable, "-c", FROM_PYTHON, PYTHONPATH=str(tree / "python"), MUD_LIBRARY_DIR=str(folder))
    check("Python knows both: three updates of two are six, and ten is out of range",
          told.split("\n")[0] == "6.0" and "trial_step" in told and "9" in told, told)
