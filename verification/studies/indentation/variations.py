# SPDX-License-Identifier: MIT
"""The variations of the indentation: what the paper leaves open or states, one change of the scene each."""
from collections.abc import Callable
from typing import NamedTuple

from analysis import DT, change

SUCTIONS = (0, 30, 100, 1000)
BOTH = ("remedy", "as_published")
FIELDS = "u-p_w-p_c"
OPEN, STATED = True, False


def keys(where, **values):
    """Sets keys of a group."""
    return lambda groups: change(groups, where, **values)


def without_weight(groups):
    # A plate that just touches is held by nothing in a static stage.
    change(groups, "plate", weight="'no'")
    next(k for g, k in groups if g == "fix" and k["group"] == "'plate'")["stages"] = "'geostatic', 'seat'"


def drained_by_state(groups):
    change(groups, "contact", drainage="'state'")
    for name, k in groups:
        if name == "fix" and k["group"] == "'top_2'":
            k["group"] = "'top'"


def default_floor(groups):
    """1e-4 is the key's default."""
    change(groups, "permeability", floor=None)


FINE = keys("mesh", r_cells="12, 16", r_ratio=f"1, {1.35**0.5:.8g}", z_cells="14, 14",
            z_ratio=f"{0.76**0.5:.8g}, {0.9**0.5:.8g}")


class Variation(NamedTuple):
    name: str
    what: str
    known: str       # What is known of it, and what the series uses.
    adapt: Callable  # Makes a scene of it.
    series: tuple    # That it means something for.
    open: bool       # The paper leaves it open: only such a one can be a reason for a difference from the paper.


VARIATIONS = {v[0]: Variation(*v) for v in (
    ("mass_15", "plate of 15 kg", "not stated; 11.1 kg", keys("plate", mass=0.015), BOTH, OPEN),
    ("mass_5.6", "plate of 5.6 kg", "not stated; 11.1 kg", keys("plate", mass=0.0056), BOTH, OPEN),
    ("weightless", "plate without weight", "not stated; with", without_weight, BOTH, OPEN),
    ("peak_12", "peak of the load at 12 ms", "not stated; 14 ms", keys("history", times="2, 2.012, 2.028"), BOTH, OPEN),
    ("mualem", "Mualem-van Genuchten permeabilities", "not stated; Corey", keys("permeability", law="'mualem'"), BOTH,
     OPEN),
    ("floor_1e-2", "least relative permeability 1e-2", "not stated; 1e-4 (1e-2 at suction 0)",
     keys("permeability", floor=1e-2), BOTH, OPEN),
    ("floor_1e-3", "least relative permeability 1e-3", "not stated; 1e-4 (1e-2 at suction 0)",
     keys("permeability", floor=1e-3), BOTH, OPEN),
    ("floor_1e-4", "least relative permeability 1e-4", "not stated; 1e-4 (1e-2 at suction 0)", default_floor, BOTH,
     OPEN),
    ("rate_suction", "saturation changes by suction alone", "dS_w/de not stated; with",
     keys("scene", saturation_rate="'suction'"), BOTH, OPEN),
    ("seepage_inertia", "inertia in Darcy's law", "eqs (20), (21) have it; without",
     keys("scene", seepage_inertia="'yes'"), BOTH, OPEN),
    ("flow_drains", "initial flow not subtracted", "not stated; subtracted", keys("scene", initial_flow="'drain'"),
     BOTH, OPEN),
    ("drainage_state", "drainage follows the contact", "stated in words; footprint impervious", drained_by_state, BOTH,
     OPEN),
    ("e_0.75", "void ratio 0.75", "0.8 stated", keys("region", void_ratio=0.75), BOTH, STATED),
    ("e_0.85", "void ratio 0.85", "0.8 stated", keys("region", void_ratio=0.85), BOTH, STATED),
    ("theta_0.1", "theta 0.1", "missing in Table 2; 0.2", keys("mud", theta=0.1), BOTH, OPEN),
    ("theta_0.3", "theta 0.3", "missing in Table 2; 0.2", keys("mud", theta=0.3), BOTH, OPEN),
    ("k0_effective", "K_0 of the effective stress", "not stated; of the net stress",
     keys("initial", k_0_of="'effective'"), BOTH, OPEN),
    ("eps_hat_1e-5", "threshold of the remedy 1e-5", "not stated; 1e-4", keys("mud", eps_hat=1e-5), ("remedy",), OPEN),
    ("eps_hat_1e-3", "threshold of the remedy 1e-3", "not stated; 1e-4", keys("mud", eps_hat=1e-3), ("remedy",), OPEN),
    ("damping_10", "damping 10 /s", "matrices of it are named; none (10 /s: 4.5 % of critical at the load's 112 rad/s)",
     keys("region", damping=10), BOTH, OPEN),
    ("rho_1", "rho_inf 1 (no damping)", "not stated; 0.8", keys("stage:impact", rho_inf=1, created_energy=1e9), BOTH,
     OPEN),
    ("rho_0.5", "rho_inf 0.5", "not stated; 0.8", keys("stage:impact", rho_inf=0.5), BOTH, OPEN),
    ("rho_0", "rho_inf 0", "not stated; 0.8", keys("stage:impact", rho_inf=0), BOTH, OPEN),
    ("dt_half", "half the time step", "3e-5 s stated", keys("stage:impact", dt=DT / 2), BOTH, STATED),
    ("dt_tenth", "a tenth of the time step", "3e-5 s stated", keys("stage:impact", dt=DT / 10), BOTH, STATED),
    ("mesh_half", "half the size of the elements (1568)", "410 elements stated; 392", FINE, BOTH, STATED),
    ("taylor_hood", "linear pressures", "not stated; quadratic", keys("scene", pressures="'linear'"), BOTH, OPEN),
    ("quadrature_3", "3 points an element", "not stated; 6", keys("scene", quadrature=3), BOTH, OPEN),
    ("quadrature_7", "7 points an element", "not stated; 6", keys("scene", quadrature=7), BOTH, OPEN),
    ("quadrature_12", "12 points an element", "not stated; 6", keys("scene", quadrature=12), BOTH, OPEN),
    ("stress_1e-4", "stress tolerance 1e-4", "1e-5 stated", keys("mud", tolerance=1e-4), BOTH, STATED),
    ("stress_1e-6", "stress tolerance 1e-6", "1e-5 stated", keys("mud", tolerance=1e-6), BOTH, STATED),
    ("newton_1e-2", "Newton tolerance 1e-2", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-2), BOTH, OPEN),
    ("newton_1e-4", "Newton tolerance 1e-4", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-4), BOTH, OPEN),
    ("newton_1e-5", "Newton tolerance 1e-5", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-5), BOTH, OPEN),
    ("newton_1e-6", "Newton tolerance 1e-6", "1e-3 stated, of an unstated measure",
     keys("stage:impact", tolerance=1e-6), BOTH, OPEN),
    ("norm_residual", "Newton: |R|/|R_0| below 1e-3", "not stated; error of every field",
     keys("stage:impact", measure="'residual'"), BOTH, OPEN),
    ("norm_correction", "Newton: |dx|/|x| below 1e-3", "not stated; error of every field",
     keys("stage:impact", measure="'correction'"), BOTH, OPEN),
    ("predictor_none", "iteration starts from the old values", "not stated; constant rates",
     keys("stage:impact", predictor="'none'"), BOTH, OPEN),
    ("fresh_factors", "every matrix factorised anew", "not stated; factors serve on", keys("scene", factors="'fresh'"),
     BOTH, OPEN),
    ("tangent_1", "elastic tangent", "not stated; continuum", keys("mud", tangent=1), BOTH, OPEN),
    ("tangent_3", "consistent tangent", "not stated; continuum", keys("mud", tangent=3), BOTH, OPEN),
    ("penalty_1e7", "penalty 1e7 kN/m3", "1e8 stated", keys("contact", penalty=1e7), BOTH, STATED),
    ("penalty_1e9", "penalty 1e9 kN/m3", "1e8 stated", keys("contact", penalty=1e9), BOTH, STATED),
    ("gap_pointwise", "gap penalised point by point", "eq. (18); nodal", keys("contact", gap="'pointwise'"), BOTH,
     OPEN),
)}


CONTROL = "classic"   # Guards as with the remedy, no remedy.
TIGHT = "newton_1e-5"   # Runs with the series.
EXACT = "fresh_factors"   # The same equations; what it changes is the residual of linear solutions by reused factors.
# What runs unless --only names others: what fits into a night with the other pages, the most telling first.
STANDARD = ("mesh_half", EXACT, "peak_12", "drainage_state", "e_0.75", "k0_effective", "eps_hat_1e-5", "eps_hat_1e-3")
NIGHTLY = (30,)   # Suctions, unless --suction names others.
