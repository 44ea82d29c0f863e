# SPDX-License-Identifier: MIT
"""What a hard case is, the settings it is run with, and how it is judged.

Every case is run as it is, with its first stress multiplied by 1 + 1e-9, and with scheme 3 and a tolerance of 1e-8. It passes if it comes
to its end, if its own criterion holds, if the nudge stays below the third digit, and if the answer is that of the tight
tolerance to one per cent.
"""
import math
import pathlib
import sys
from dataclasses import dataclass, replace
from typing import Callable

VERIFICATION = pathlib.Path(__file__).parents[2]
sys.path[:0] = [str(VERIFICATION / "material"), str(VERIFICATION)]
from point_steps import distance, last  # noqa: E402
from point_walk import RULES, Path, Soil  # noqa: E402
from tools.bench import AS_PUBLISHED  # noqa: E402

NUDGE = 1e-9
CONTINUITY = 0.1        # % of the stress: the third digit
INTEGRATION = 1.0       # % of the stress between the tolerance of the setting and 1e-8
TIGHT = 1e-8
P_MIN = 0.101325        # kPa: the default of the tension cut-off, 1e-3 p_atm


@dataclass(frozen=True)
class Setting:
    """A memory rule, a scheme and a tolerance; None: the library's default."""
    name: str
    rule: str = None
    rho_e: float = None
    scheme: int = None
    tolerance: float = None
    nudge: float = 0.0
    keys: tuple = ()         # further (name, value) of the material
    converges: bool = True   # whether there is an answer at the tolerance 1e-8 to hold its own against

    def start(self, e, p=100.0, stress=None, suction=0.0, **properties):
        """A path that begins at an isotropic effective stress p or at six components [kPa]."""
        chosen = {name: value for name, value in (("scheme", self.scheme), ("tolerance", self.tolerance)) if value is not None}
        soil = Soil(None if self.rule is None else RULES[self.rule], self.rho_e).having(**{**chosen, **dict(self.keys), **properties})
        stress = tuple(s * (1 + self.nudge) for s in (stress or (p, p, p, 0.0, 0.0, 0.0)))
        return Path(soil, e, stress=stress, suction=suction)

    def nudged(self):
        return replace(self, nudge=NUDGE)

    def tight(self):
        return replace(self, scheme=3, tolerance=TIGHT)


SETTINGS = (
    Setting("default"),
    Setting("classic", rule="classic", rho_e=0.0, keys=(("isotropic", 1),)),
    Setting("paper's remedy", rule="threshold", rho_e=0.0, keys=(("isotropic", 1),)),
    Setting("repositioning", rule="repositioning", rho_e=0.0),
    Setting("return point, no elastic domain", rule="return_point", rho_e=0.0),
    Setting("no isotropic memory", keys=(("isotropic", 1),)),
    Setting("cyclic preloading", keys=(("c_chi", 0.26),)),
    Setting("fluidity", keys=(("c_ell", 200.0),)),
    Setting("all memories", keys=(("c_chi", 0.26), ("c_ell", 200.0), ("hysteresis", 1))),
    Setting("scheme 2", scheme=2),
    Setting("scheme 3", scheme=3),
    Setting("loose", tolerance=1e-3),
    Setting("tight", tolerance=1e-7),
    # Without the guards a reversal begins with an infinite slope: substeps of the smallest size, accepted; tighter tolerances do not end.
    Setting("as published", keys=tuple(AS_PUBLISHED.items()), converges=False),
)


@dataclass(frozen=True)
class Case:
    """`paths(setting)` gives {label: path}; `judge({label: rows})` a number that has to stay at or below `allowed`."""
    name: str
    group: str
    hard: str          # what makes it hard
    criterion: str     # what is judged, with its unit
    allowed: float
    paths: Callable
    judge: Callable
    limit: str = ""    # why the case is not passed with the defaults: what the model itself does not do
    proof: tuple = ()  # what shows that it is the model: (what is judged, judge, allowed)


@dataclass(frozen=True)
class Outcome:
    case: str
    setting: str
    finished: bool
    value: float
    allowed: float
    continuity: float    # % of the stress
    integration: float   # % of the stress
    rates: int
    cuts: int
    passed: bool


def worst_distance(runs, others):
    """The largest distance of the last stresses [% of the stress]; infinite where a path did not end."""
    off = [distance(runs[label], others[label]) for label in runs]
    return max((math.inf if math.isnan(x) else x) for x in off)


def finished(runs):
    return all(not row["failed"] and all(map(math.isfinite, row["stress"])) for rows in runs.values() for row in rows)


def evaluate(walker, case, setting, integration=True):
    """The outcome of a case; without `integration` nothing is run with the tight tolerance. What did not end is neither nudged nor run tightly."""
    runs = walker.run_all(case.paths(setting))
    done = finished(runs)
    value = case.judge(runs) if done else math.inf
    continuity = worst_distance(runs, walker.run_all(case.paths(setting.nudged()))) if done else math.nan
    off = worst_distance(runs, walker.run_all(case.paths(setting.tight()))) if done and integration and setting.converges else math.nan
    good = done and value <= case.allowed and continuity <= CONTINUITY and not off > INTEGRATION
    ends = [rows[-1] for rows in runs.values()]
    return Outcome(case.name, setting.name, done, value, case.allowed, continuity, off, sum(row["rates"] for row in ends),
                   sum(row["cuts"] for row in ends), good)


def overshoot(runs, clean="clean"):
    """By how much the last q of any path exceeds that of the uninterrupted one [%]."""
    reference = last(runs[clean]).q
    return max(100 * (last(rows).q / reference - 1) for label, rows in runs.items() if label != clean)


def off_the_clean(runs, clean="clean"):
    """Largest distance of the last stress from that of the uninterrupted path [%]."""
    return max(distance(rows, runs[clean]) for label, rows in runs.items() if label != clean)
