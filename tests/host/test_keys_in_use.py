# SPDX-License-Identifier: MIT
"""Every key of scenes and cases is used by a test, a page or a case: one without use has no proof that it works. The
orderings of the unknowns give one answer."""
import re
import subprocess

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

PLACES = ("tests", "verification", "drivers/cases", "benchmarks")
KINDS = {".nml", ".py", ".pf"}
files = [path for place in PLACES for path in (root / place).rglob("*")
         if path.suffix in KINDS]
# As `key = ` of a namelist, or as a word in quotes of a test that writes one.
USED = {name for path in files for pair in re.findall(r"\b(\w+)\s*=|[\"'](\w+)[\"']", path.read_text(encoding="utf-8"))
        for name in pair}
# Parameters of the library, which its registry and the tests of umat/ hold.
EXEMPT = {"mud_host": set(), "mud_triax": {"material"}}


def keys(program):
    """Pairs of group and key of a template."""
    text = subprocess.run([program, "--template"], capture_output=True, text=True).stdout
    group, found = "", []
    for line in text.splitlines():
        if line.startswith("&"):
            group = line[1:].split()[0]
        elif key := re.match(r"\s+!?\s*(\w+)\s*=", line):
            found.append((group, key[1]))
    return found


def test_every_key_of_template_is_used():
    for folder, name in (("host", "mud_host"), ("drivers", "mud_triax")):
        found = keys(build / folder / name)
        idle = [f"&{group} {key}" for group, key in found if group not in EXEMPT[name] and key not in USED]
        check(f"every key of {name} --template is used", len(found) > 10 and not idle, idle)


def test_ordering_gives_the_answer_of_amd():
    # The order of the unknowns is no part of the equations. Newton ends at 1e-10 of the forces; a solution by other
    # factors differs by rounding times the condition of the matrix, some 1e-16*1e6.
    answers = {}
    for ordering in ("amd", "auto", "metis", "best"):
        scene = work / f"{ordering}.nml"
        scene.write_text(f"""&scene name = 'column' geometry = 'plane_strain' fields = 'u-p_w' ordering = '{ordering}' /
&mesh r = 0, 0.1 r_cells = 2 z = 0, 1 z_cells = 12 /
&elastic name = 'soil' young = 1.0e4 poisson = 0.25 /
&permeability name = 'k' intrinsic = 1.0e-10 law = 'constant' /
&region material = 'soil' void_ratio = 0.8 permeability = 'k' /
&stage name = 'load' analysis = 'quasi_static' tolerance = 1.0e-10 duration = 0.1 dt = 0.01 rho_inf = 0 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&fix group = 'top' field = 'p_w' /
&load group = 'top' kind = 'pressure' value = 10 /
""")
        done = subprocess.run(
            [build / "host/mud_host", scene, "--output", work / ordering, "--quiet"],
            capture_output=True, text=True)
        answers[ordering] = tables.numbers(work / ordering / "nodes_load.csv") if done.returncode == 0 else []
    amd = answers["amd"]
    for ordering in ("auto", "metis", "best"):
        apart = [abs(a[name] - b[name])/max(abs(c[name]) for c in amd) for a, b in zip(amd, answers[ordering])
                 for name in ("u_z", "p_w")]
        check(f"ordering = '{ordering}' gives the answer of amd", apart and len(amd) == len(answers[ordering])
              and max(apart) <= 1e-9, f"{max(apart, default='no rows')}")
