# SPDX-License-Identifier: MIT
"""What is fitted: variables with physical bounds, in groups, and how parameters of the library follow from them."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from ..errors import InputError
from ..registry import parameters

P_CRITICAL = (
    100.0  # [kPa] where the critical state line is pinned: N_c alone is nearly the same as lambda and alpha_csl
)
P_COMPRESSION = 1.0e4  # [kPa] the same of the compression line


@dataclasses.dataclass(frozen=True)
class Variable:
    """A quantity that the fit moves between physical bounds; with ``log`` its logarithm is moved."""

    name: str
    group: str
    lower: float
    upper: float
    log: bool
    unit: str = "1"
    meaning: str = ""

    def value(self, share: float) -> float:
        """Its value at a place between 0 (lower) and 1 (upper bound)."""
        if self.log:
            return float(self.lower * (self.upper / self.lower) ** share)
        return float(self.lower + (self.upper - self.lower) * share)

    def share(self, value: float) -> float:
        """The place of a value, within 0 and 1."""
        inside = min(max(value, self.lower), self.upper)
        place = (
            np.log(inside / self.lower) / np.log(self.upper / self.lower)
            if self.log
            else (inside - self.lower) / (self.upper - self.lower)
        )
        return float(min(max(place, 0.0), 1.0))


POISSON = (0.05, 0.4)  # elastic Poisson's ratio of sand
POISSON_STATES = [(e, p) for e in (0.6, 1.0) for p in (50.0, 500.0)]  # void ratio, p' [kPa] where it is looked at
POISSON_WEIGHT = (
    30.0  # of a ratio outside, beside residuals in standard deviations: 0.03 counts as one curve off by one
)
LEAST_HARDENING = 0.05  # 1 - c_h e of the loosest fitted sample: at zero the hardening law ends

GROUPS = (
    "critical state",
    "elasticity and compression",
    "peak and dilatancy",
    "hardening",
    "cycles",
    "retention",
    "bonding",
    "preloading",
)
# Group -> kinds of tests that depend on it.
SPEAKS = {
    "critical state": {"drained", "undrained"},
    "elasticity and compression": {"oedometer", "isotropic", "drained", "stiffness", "modulus"},
    "peak and dilatancy": {"drained", "undrained"},
    "hardening": {"drained", "undrained", "modulus", "liquefaction"},
    "cycles": {"cyclic", "liquefaction"},
    "retention": {"retention"},
    "bonding": set(),
    "preloading": {"cyclic", "liquefaction"},
}
# Bounds: what is known of sands, narrower than what the library can compute with. G_0 and K_0: Hardin's formula gives sands
# about 60 to 250 in these units; a factor of two beyond is allowed.
VARIABLES = {
    v.name: v
    for v in (
        Variable("M_c", GROUPS[0], 0.9, 1.7, False),
        Variable(
            "e_c100",
            GROUPS[0],
            0.4,
            1.3,
            False,
            "1",
            "critical void ratio at p' = 100 kPa, N_c (100 + alpha_csl)^-lambda",
        ),
        Variable("lambda", GROUPS[0], 0.02, 0.8, True),
        Variable("alpha_csl", GROUPS[0], 10.0, 2.0e4, True, "kPa"),
        Variable("G_0", GROUPS[1], 30.0, 400.0, True),
        Variable("K_0", GROUPS[1], 30.0, 400.0, True),
        Variable(
            "e_l10",
            GROUPS[1],
            0.3,
            3.0,
            True,
            "1",
            "void ratio of the compression line at p' = 10 MPa, N_l 10000^-lambda",
        ),
        Variable("theta", GROUPS[1], 0.02, 5.0, True),
        Variable("n_b", GROUPS[2], 0.1, 8.0, True),
        Variable("n_d", GROUPS[2], 0.1, 10.0, True),
        Variable("A_0", GROUPS[2], 0.05, 4.0, True),
        Variable("h_0", GROUPS[3], 0.2, 200.0, True),
        Variable("c_h", GROUPS[3], 0.0, 1.2, False),
        Variable("c_z", GROUPS[4], 10.0, 5.0e3, True),
        Variable("z_max", GROUPS[4], 0.1, 50.0, True),
        Variable("P_a", GROUPS[5], 0.01, 1.0e3, True, "kPa"),
        Variable("n_x", GROUPS[5], 1.0, 20.0, True),
        Variable("m_x", GROUPS[5], 0.05, 10.0, True),
        Variable("S_min", GROUPS[5], 0.0, 0.4, False),
        Variable("S_max", GROUPS[5], 0.7, 1.0, False),
        Variable("P_aw_ratio", GROUPS[5], 0.05, 1.0, True, "1", "P_aw/P_a of the main wetting and drying curves"),
        Variable("n_w_share", GROUPS[5], 0.02, 1.0, True, "1", "(n_w - 1)/(n_x - 1) of the two main curves"),
        Variable("m_w_ratio", GROUPS[5], 1.0, 10.0, True, "1", "m_w/m_x of the two main curves"),
        Variable("b_d", GROUPS[5], 0.05, 50.0, True),
        Variable("b_w", GROUPS[5], 1.001, 50.0, True),
        Variable("b_1", GROUPS[6], 0.0, 3.0, False),
        Variable("b_2", GROUPS[6], 0.0, 3.0, False),
        Variable("c_chi", GROUPS[7], 0.03, 1.0, True),
        Variable("zeta_chi", GROUPS[7], 1000.0, 3.0e4, True),
        Variable("s_chi", GROUPS[7], 0.0, 0.5, False),
    )
}
#: What the name of an unknown void ratio begins with; behind it comes the name of the test.
UNKNOWN = "e_0 of "
#: Parameters of the library that are pinned by a variable of another name.
PINNED = {"N_c": "e_c100", "N_l": "e_l10", "P_aw": "P_aw_ratio", "n_w": "n_w_share", "m_w": "m_w_ratio"}
#: With these a pinned parameter is known, so that its variable is.
PINNED_WITH = {"N_c": ("lambda", "alpha_csl"), "N_l": ("lambda",), "P_aw": ("P_a",), "n_w": ("n_x",), "m_w": ("m_x",)}
#: Variables that act with hydraulic hysteresis alone.
WETTING = ("P_aw_ratio", "n_w_share", "m_w_ratio", "b_d", "b_w")


def meaning_of(name: str) -> str:
    """What a variable means."""
    if name.startswith(UNKNOWN):
        return "void ratio at the start, which the table does not have"
    return VARIABLES[name].meaning or parameters[name].meaning


def parameters_of(values: Mapping[str, float], base: Mapping[str, float]) -> dict[str, float]:
    """Parameters of the library: ``base`` with the values of variables; N_c and N_l of their pins, which hold if lambda moves,
    and with hysteresis the main wetting curve, which stays where it lies beside the drying curve."""
    answer = {**base, **{k: v for k, v in values.items() if k not in PINNED.values()}}
    pins = {**pins_of(base), **{k: v for k, v in values.items() if k in PINNED.values()}}
    answer["N_c"] = pins["e_c100"] * (P_CRITICAL + answer["alpha_csl"]) ** answer["lambda"]
    answer["N_l"] = pins["e_l10"] * P_COMPRESSION ** answer["lambda"]
    if answer["hysteresis"]:
        answer["P_aw"] = pins["P_aw_ratio"] * answer["P_a"]
        answer["n_w"] = 1 + pins["n_w_share"] * (answer["n_x"] - 1)
        answer["m_w"] = pins["m_w_ratio"] * answer["m_x"]
    return {k: v for k, v in answer.items() if not k.startswith(UNKNOWN)}


def pins_of(base: Mapping[str, float]) -> dict[str, float]:
    """Void ratios that the two lines have at their pins, and where the main wetting curve lies beside the drying curve (0 of
    P_aw, n_w and m_w: half of P_a, n_x, m_x)."""
    return {
        "e_c100": base["N_c"] * (P_CRITICAL + base["alpha_csl"]) ** -base["lambda"],
        "e_l10": base["N_l"] * P_COMPRESSION ** -base["lambda"],
        "P_aw_ratio": base["P_aw"] / base["P_a"] or 0.5,
        "n_w_share": (base["n_w"] - 1) / (base["n_x"] - 1) if base["n_w"] and base["n_x"] > 1 else 1.0,
        "m_w_ratio": base["m_w"] / base["m_x"] or 1.0,
    }


def poisson_ratio(values: Mapping[str, float], e: np.ndarray | float, p: np.ndarray | float) -> np.ndarray | float:
    """Elastic Poisson's ratio of eqs (2), (3) at a void ratio and a mean stress [kPa]."""
    bulk = values["K_0"] * (1 + e) / e * (p / values["p_atm"]) ** (2 / 3)
    shear = values["G_0"] * (2.97 - e) ** 2 / (1 + e) * np.sqrt(p / values["p_atm"])
    return (3 * bulk - 2 * shear) / (2 * (3 * bulk + shear))


def poisson_residual(values: Mapping[str, float]) -> np.ndarray:
    """Residuals that keep G_0 and K_0 in keeping: shear and compression tests alone let them drift apart."""
    ratios = np.array([poisson_ratio(values, e, p) for e, p in POISSON_STATES])
    return POISSON_WEIGHT * (np.minimum(ratios - POISSON[0], 0) + np.maximum(ratios - POISSON[1], 0))


def start_of(name: str, base: Mapping[str, float]) -> float:
    """Value of a variable in a set of parameters."""
    return pins_of(base)[name] if name in PINNED.values() else base[name]


ANGLES = (15.0, 50.0)  # [degrees] critical friction angles of soils
STIFFNESS = (5.0, 2000.0)  # G_0 of soils, widely
# Ranges of what is known and is no parameter of the library: beyond them a value has another unit.
KNOWN_RANGES = {"G_max_p": (1.0, 5e4), "G_max_e": (0.1, 2.5), "e_c100": (0.1, 5.0), "e_l10": (0.01, 5.0)}
KNOWN_STATES = {"G_max_p": "mean stress at which G_max is known [kPa]", "G_max_e": "void ratio at which G_max is known"}


def known_parameters(known: Mapping[str, float], base: Mapping[str, float]) -> tuple[dict[str, float], dict[str, str]]:
    """(values, origins) of what is known: parameters and variables by name, and

    phi_c : critical friction angle [degrees], gives M_c;
    G_max, G_max_p, G_max_e : small-strain shear modulus [kPa] at a mean stress [kPa] and a void ratio, gives G_0.
    """
    values, origins = {}, {}
    rest = {parameters[name].name if name in parameters else name: value for name, value in known.items()}
    for name, value in rest.items():
        if isinstance(value, (str, bytes)) or np.ndim(value) > 0 or value is None or not np.isfinite(value):
            raise InputError(f"known: {name} = {value!r} is not one number")
        if name in parameters or name in KNOWN_RANGES:
            entry = parameters[name] if name in parameters else None
            low, high = (entry.lower, entry.upper) if entry else KNOWN_RANGES[name]
            if not low <= value <= high:
                meaning = entry.meaning if entry else KNOWN_STATES.get(name) or meaning_of(name)
                raise InputError(f"known: {name} = {value:g} is outside its range (from {low:g} to {high:g}: {meaning})")
    if "phi_c" in rest:
        angle = float(rest.pop("phi_c"))
        if not ANGLES[0] <= angle <= ANGLES[1]:
            hint = f"; {np.degrees(angle):.1f} if it is in radians" if 0 < angle < np.pi / 2 else ""
            raise InputError(f"known: phi_c = {angle:g} degrees; soils have {ANGLES[0]:g} to {ANGLES[1]:g}{hint}")
        sine = np.sin(np.radians(angle))
        values["M_c"] = float(6 * sine / (3 - sine))
        origins["M_c"] = f"known: critical friction angle {known['phi_c']:g} degrees"
    measured = [rest.pop(name, None) for name in ("G_max", "G_max_p", "G_max_e")]
    if any(m is not None for m in measured):
        if any(m is None for m in measured):
            raise InputError("G_max [kPa] is known at a state: give G_max_p [kPa] and G_max_e with it")
        modulus, p, e = measured
        values["G_0"] = float(modulus / (base["p_atm"] * (2.97 - e) ** 2 / (1 + e) * np.sqrt(p / base["p_atm"])))
        if not STIFFNESS[0] <= values["G_0"] <= STIFFNESS[1]:
            raise InputError(
                f"known: G_max = {modulus:g} kPa at {p:g} kPa and e = {e:g} means G_0 = {values['G_0']:.3g}; soils have "
                f"{STIFFNESS[0]:g} to {STIFFNESS[1]:g}. Is it in kPa?"
            )
        origins["G_0"] = f"known: G = {modulus:g} kPa at p' = {p:g} kPa, e = {e:g}"
    for name, value in rest.items():
        if name not in VARIABLES and name not in parameters:
            raise InputError(
                f"known: {name} is neither a parameter of the library nor one of phi_c, G_max, G_max_p, G_max_e, "
                f"{', '.join(PINNED.values())}"
            )
        if name in values:
            raise InputError(f"known: {name} is given twice, by itself and by {'phi_c' if name == 'M_c' else 'G_max'}")
        values[name], origins[name] = float(value), "known"
    for position, pin in PINNED.items():
        if position not in values:
            continue
        if pin in values:
            raise InputError(f"known: {position} and {pin} say the same; give one of them")
        for name in PINNED_WITH[position]:
            if name not in values:
                raise InputError(
                    f"known: {position} acts together with {' and '.join(PINNED_WITH[position])}: give that too, or {pin} "
                    f"({meaning_of(pin)}) in its place"
                )
        values[pin], origins[pin] = pins_of({**base, **values})[pin], "known"
    return values, origins


def chosen(
    kinds: set[str], unsaturated: bool, hysteresis: bool, known: Sequence[str], groups: Sequence[str] | None = None
) -> list[Variable]:
    """Variables that are fitted: of groups that the tests depend on, without what is known; cyclic preloading, an option, where
    it is asked for by name."""
    if groups is not None:
        for group in groups:
            if group not in GROUPS:
                raise InputError(f"there is no group {group}; there are {', '.join(GROUPS)}")
    return [
        v
        for v in VARIABLES.values()
        if v.name not in known
        and (v.group != "preloading" if groups is None else v.group in groups)
        and (hysteresis or v.name not in WETTING)
        and (SPEAKS[v.group] & kinds or v.group == "bonding" and unsaturated)
    ]
