#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""What an effect of the host costs where it is off: instructions of a step, beside a build without its code.

    benchmarks/host_effects_off.py [--only EFFECT ...] [--folder build/host_effects_off] [--keep]

For every effect a copy of the sources in which the question whether it is on is answered beforehand is built, so that the
compiler removes its code, and where the effect is a term that is 0 when off, the term is taken out. Both builds run one
small elastic scene with the effect off, and their histories must be the same bytes. Needs valgrind; a minute of one core
an effect after the first build. --keep writes results/host_effects_off.csv.
"""
import os
import pathlib
import re
import shutil
import sys
import tempfile

from effects_off import build, command, measure, percent

STEPS = (20, 60)   # of the two runs whose difference is counted
DT = 1.0e-3        # [s]
COLUMNS = ("effect", "fields", "analysis", "off", "without_its_code", "difference_percent")
# Where a scene becomes a model: what is set there is not asked.
BUILDERS = ("host/scene/", "host/model/model_builder.f90", "host/model/region_builder.f90", "host/model/boundary_builder.f90",
            "host/model/contact_setup.f90", "host/model/idle_keys.f90", "host/effects/")
DRAINAGE = r"domain%regions\(domain%region_of\((?:e|element)\)\)%drainage|region%drainage"
NO_SUCTION = (
    (r"\b(?:model%)?(?:region|domain|m)%with_c\b", ".false."),
    (r"\n *if \(\.not\. with_c\) return\n.*", ""),
    (r" \+ \(1 - s\)\*mix%p_c$", ""), (r"mix%p_c = k%c0 .*", "mix%p_c = 0.0_wp"), (r" \+ mix%p_c\*mix%s_ev$", ""),
    (r" *tangent\(1:4, PC\) = .*\n *tangent\(1:3, PC\) = .*\n", ""),
    (r" *tangent\(U \+ 1:U \+ 2, PC\) = .*\n *tangent\(U \+ 1:U \+ 2, PW\) = .*\n", ""))

# Effect: scene in which it is off (fields, analysis, with a contact), and what is replaced in the sources of the host.
EFFECTS = {
    "inertia": ("u-p_w", "quasi_static", False, (
        (r"\b(scheme|stage)%kind == DYNAMIC\b", ".false."), (r"\bscheme%kind /= DYNAMIC\b", ".true."))),
    "relative_acceleration": ("u-p_w", "dynamic", False, ((r"\bdomain%seepage_inertia\b", ".false."),)),
    "p_w": ("u", "dynamic", False, NO_SUCTION + (
        (r"\b(?:model%)?(?:region|domain)%with_w\b", ".false."),
        (r"\n *if \(\.not\. with_w\) return\n.*", ""),
        (r"\bn_p > 0\b", ".false."), (r"\bdomain%n_carriers\(element\) == 0", ".true."),
        (r"\n *response\(1:3\) = response\(1:3\) - pressure", ""))),
    "p_c": ("u-p_w", "dynamic", False, NO_SUCTION),
    "gravity": ("u-p_w", "dynamic", False, (
        (r"\n *(?:accel|b)\(2\) = (?:accel|b)\(2\) \+ domain%gravity", ""), (r"domain%gravity \+ FLIGHT_SHARE", "FLIGHT_SHARE"),
        (r"\n *change\(U \+ 2\) = change\(U \+ 2\) - mixture_density.*", ""), (r"\n *work%gravity = work%gravity - .*", ""),
        (r" \+ \[0\.0_wp, f%rho_w\*domain%gravity\]", ""))),
    "contact": ("u-p_w", "dynamic", False, (
        (r"\ballocated\(drainage%(?:gives_way|released)\)", ".false."),
        (r"\ballocated\((?:run%)?(?:system%)?contacts%interfaces\)", ".false."), (r"\ballocated\(touched\)", ".false."))),
    "damping": ("u-p_w", "dynamic", False, (
        (r"\bregion%(?:stiffness_)?damping > 0\.0_wp", ".false."), (r" \+ region%damping\*k%speed", ""),
        (r" \+ region%damping\*scheme%c_v", ""), (r"\n *k\(g\)%speed = 0\.0_wp", ""))),
    "absorbing": ("u-p_w", "dynamic", False, (
        (r"\ballocated\((?:run%constraint%|constraint%|held%)dashpots\)", ".false."),)),
    "contact_drainage": ("u-p_w", "dynamic", True, (
        (r"\ballocated\(drainage%(?:gives_way|released)\)", ".false."),)),
    "contact_geometry": ("u-p_w", "dynamic", True, ((r"\ballocated\(fixed\)", ".false."), (r"\boptions%fixed\b", ".false."))),
    "drainage_of_regions": ("u-p_w", "dynamic", False, (
        (rf"(?:{DRAINAGE}) (?:== COUPLED|/= UNDRAINED)\b", ".true."), (rf"(?:{DRAINAGE}) /= COUPLED\b", ".false."),
        (r"\bdomain%center\(element\) > 0", ".false."), (r"\bdomain%n_carriers\((?:element|e)\)", "domain%n_p"))),
}


def scene(fields, analysis, contact, gravity, steps):
    """A block of 64 elements under a pressure, on smooth supports; with a contact a plate rests on it."""
    wet = fields != "u"
    text = f"""&scene name = 'block' geometry = 'plane_strain' fields = '{fields}' threads = 1 gravity = {gravity} /
&mesh r = 0, 1 r_cells = 4 z = 0, 2 z_cells = 8 /
&elastic name = 'soil' young = 1e4 poisson = 0.3 /
"""
    if wet:
        text += "&permeability name = 'k' intrinsic = 1e-10 law = 'constant' /\n"
    text += "&region material = 'soil' void_ratio = 0.8 rho_s = 2.7" + (" permeability = 'k'" if wet else "") + " /\n"
    text += f"""&stage name = 'run' analysis = '{analysis}' duration = {steps * DT} dt = {DT} steps = 'given' every = 10 /
&fix group = 'left' field = 'u_r' /
&fix group = 'right' field = 'u_r' /
&fix group = 'bottom' field = 'u_z' /
&point name = 'middle' r = 0.5 z = 1 /
"""
    if wet:
        text += "&fix group = 'top' field = 'p_w' /\n"
    if contact:
        return text + """&plate name = 'plate' r = -0.1, 1.1 z = 2 mass = 1 /
&contact name = 'interface' slave = 'top' master = 'plate' penalty = 1e7 gap = 'nodal' /
&history name = 'down' times = 0, 10 values = 0, -1 /
&fix group = 'plate' field = 'u_z' value = 1e-1 history = 'down' /
"""
    return text + "&load group = 'top' kind = 'pressure' value = 10 /\n"


def make(source):
    return build(source, "host/mud_host", "-DMUD_BUILD_HOST=ON")


def run(program, folder, effect):
    """Instructions of a step, and the histories of the longer run."""
    fields, analysis, contact, _ = EFFECTS[effect]
    counts = []
    for steps in STEPS:
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / "scene.nml").write_text(scene(fields, analysis, contact, 0 if effect == "gravity" else 9.81, steps),
                                          encoding="utf-8")
        said = command("valgrind", "--tool=callgrind", "--callgrind-out-file=/dev/null", program, folder / "scene.nml",
                       "--output", folder / "out", "--quiet", env=os.environ | {"OMP_NUM_THREADS": "1"})
        counts.append(int(re.search(r"Collected : (\d+)", said)[1]))
    return (counts[1] - counts[0]) / (STEPS[1] - STEPS[0]), (folder / "out/histories.csv").read_bytes()


def count(effect, whole, without):
    fields, analysis, _, _ = EFFECTS[effect]
    with tempfile.TemporaryDirectory() as folder:
        bare, bare_said = run(without, pathlib.Path(folder) / "run", effect)
        off, said = run(whole, pathlib.Path(folder) / "run", effect)
    if said != bare_said:
        sys.exit(f"{effect}: the build without its code answers otherwise")
    yield effect, fields, analysis, *percent(off, bare)


if __name__ == "__main__":
    measure(__doc__, {effect: (changes, "host", BUILDERS) for effect, (_, _, _, changes) in EFFECTS.items()}, COLUMNS,
            "host_effects_off", ("host",), make, count)
