# SPDX-License-Identifier: MIT
"""Strain of Karlsruhe fine sand in many drained triaxial cycles: of the model, and of the high-cycle accumulation (HCA) model.

HCA: Niemunis, Wichtmann & Triantafyllidis (2005), Computers and Geotechnics 32(4), 245-263, doi 10.1016/j.compgeo.2005.03.002, an
empirical model of drained tests of up to 1e5 cycles and more. Its constants of this sand are those of the manual of numgeo (J. Machacek
and P. Staubach), triaxial test with the HCA model: https://j-machacek.github.io/numgeo, tutorials, element tests. The reference void ratio
is e_max 1.054 of Wichtmann & Triantafyllidis (2016), as its authors take it.
"""
import math

from point_walk import Path, Soil
from tools.bench import ROOT, parameters

C_AMPL, C_E, C_P, C_Y, C_N1, C_N2, C_N3 = 1.33, 0.60, 0.23, 1.68, 2.95e-4, 0.41, 1.9e-5
E_REF, AMPL_REF, P_REF, FRICTION = 1.054, 1e-4, 100.0, math.radians(33.1)
VOIDS, P = 0.80, 200.0   # of every test; mean stress [kPa]

SET = ROOT / "drivers/materials/karlsruhe_cyclic.nml"
SETS = {"isotropic 1 and c_chi 0": {"c_chi": 0.0, "isotropic": 1.0}, "isotropic 1": {"isotropic": 1.0}, "as shipped": {},
        "s_chi 0.25": {"s_chi": 0.25}}
CASES = ((0.0, 20.0), (0.0, 40.0), (150.0, 40.0))   # q at the centre, amplitude [kPa]
MARKS = (1, 3, 10, 30, 100, 300, 1000)
TOLD = (10, 100, 1000)
AMPLITUDE_OF = 10   # the cycle; HCA takes its amplitude as constant
PARTS = 10   # increments of a quarter of a cycle


def accumulated(amplitude, q, cycles, p=P, e=VOIDS):
    """Norm of the strain that `cycles` of the strain amplitude (norm) leave at constant amplitude and void ratio [-]."""
    y_c = (9 - math.sin(FRICTION)**2) / (1 - math.sin(FRICTION)**2)
    eta = q / p
    y = 27 * (3 + eta) / ((3 + 2 * eta) * (3 - eta))   # I1 I2/I3 of a triaxial stress
    factors = ((amplitude / AMPL_REF)**C_AMPL, (C_E - e)**2 / (1 + e) * (1 + E_REF) / (C_E - E_REF)**2, math.exp(-C_P * (p / P_REF - 1)),
               math.exp(C_Y * (y - 9) / (y_c - 9)))
    return math.prod(factors) * C_N1 * (math.log(1 + C_N2 * cycles) + C_N3 * cycles)


def soil(changes):
    return Soil(properties=tuple({**parameters(SET), **changes}.items()))


def path(changes, q, amplitude, marks):
    """Cycles led by the axial stress; rows at the end of the first cycle, which HCA leaves out, and at crest, trough and end of marked ones."""
    def axial(change):
        return (change, 0, 0, 0, 0, 0)

    made = Path(soil(changes), VOIDS, p=P - q / 3).lead("ssseee")
    if q:
        made.go(60, axial(q))
    for i in range(max(marks) + 1):
        for name, parts in (("crest", 1), ("trough", -2), ("end", 1)):
            made.go(PARTS * abs(parts), axial(parts * amplitude))
            if i in marks or (i == 0 and name == "end"):
                made.row(f"{name}_{i}")
    return made


def norm(a, b):
    return math.sqrt(sum((x - y)**2 for x, y in zip(a[:3], b[:3])))


def found(rows, q):
    """cycle -> (amplitude of cycle 10, strain that is left, volume that is lost, strain that HCA leaves at that amplitude) [-]."""
    strain = {row["label"]: row["strain"] for row in rows if not row["failed"]}
    marks = [int(label.partition("_")[2]) for label in strain if label.startswith("end_") and label != "end_0"]
    amplitude = norm(strain[f"crest_{AMPLITUDE_OF}"], strain[f"trough_{AMPLITUDE_OF}"]) / 2
    return {i: (amplitude, norm(strain[f"end_{i}"], strain["end_0"]), sum(strain[f"end_{i}"][:3]) - sum(strain["end_0"][:3]),
                accumulated(amplitude, q, i)) for i in marks}
