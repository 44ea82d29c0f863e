# SPDX-License-Identifier: MIT
"""Laboratory tables: sheets of tests, read and checked; errors name file, line and remedy.

A column is a quantity with its unit behind it: ``eps_a_percent``, ``q_kPa``, ``e``. ``#`` begins a comment. Compression is
positive. Inside, strains are fractions and stresses kPa.
"""

from __future__ import annotations

import dataclasses
import difflib
import os
import pathlib

import numpy as np

from ..errors import InputError
from .sheets import UNITS, read_sheet

STRAINS, STRESSES = ("eps_a", "eps_v", "gamma"), ("q", "p", "sigma_a", "sigma_r", "suction", "u", "p_0", "amplitude", "G_max")
NUMBERS = ("e", "e_0", "S_w", "stress_ratio", "cycle", "r_u", "G_ratio", "damping", "csr", "N")
TEXTS = ("test", "control", "cycle_by")
# Other names of the same.
ALIASES = {
    "eps_1": "eps_a",
    "sigma_1": "sigma_a",
    "sigma_3": "sigma_r",
    "sigma3": "sigma_r",
    "sigma1": "sigma_a",
    "e0": "e_0",
    "sr": "stress_ratio",
    "s_w": "S_w",
    "s_r": "S_w",
    "p_eff": "p",
    "epsv": "eps_v",
    "epsa": "eps_a",
    "p0": "p_0",
    "p_c": "suction",
}
SATURATION = {"sr": "S_w"}  # of a retention table: there it is no stress ratio
# What a kind of test needs; a tuple: one of these.
NEEDS = {
    "drained": ("eps_a", ("q", "stress_ratio"), ("eps_v", "e"), ("e", "e_0")),
    "undrained": ("eps_a", "q", "p", ("e", "e_0")),
    "oedometer": ("sigma_a", ("e", "eps_a")),
    "isotropic": ("p", ("e", "eps_v")),
    "cyclic": ("control", "cycle_by", "amplitude", "cycle", "p_0", "e_0", ("eps_v", "r_u")),
    "retention": ("suction", "S_w"),
    "stiffness": ("p", "e", "G_max"),
    "modulus": ("gamma", ("G_ratio", "damping"), "p_0", "e_0"),
    "liquefaction": ("csr", "N", "p_0", "e_0"),
}
FEWEST_ROWS = {"drained": 3, "undrained": 3, "oedometer": 3, "isotropic": 3, "retention": 3}
FEWEST_ROWS |= {"cyclic": 1, "stiffness": 1, "modulus": 1, "liquefaction": 1}
# A strain in fractions cannot be larger: more means per cent. Volume: from the densest to the loosest sand is 0.3.
LARGEST_FRACTION = {"eps_a": 0.9, "eps_v": 0.3, "gamma": 1.5}
SMALLEST_PERCENT = 0.6  # a shear test in per cent goes further: less means fractions
SMALLEST_VOLUME = 1e-3  # a drained test to eps_a of 0.05 or more changes its volume by more
TOO_SMALL, TOO_LARGE = 2.0, 1.0e5  # [kPa]; a largest stress outside means another unit
HELD = 0.15  # share by which p - q/3 may leave its median where the radial stress is held
TOTAL = 0.02  # share of p at the start by which p - q/3 moves at least in an undrained test that is sheared
RETURN = 1e-9  # a strain that steps back by less is rounding
SLOPE_MISFIT = 0.5  # share of eps_v by which e may contradict it before the signs are doubted
DILATES = 1e-3  # volumetric strain below its negative is dilatancy, not scatter


@dataclasses.dataclass
class LaboratoryTest:
    """One test. Columns are arrays (rows,): strains linear [-], stresses kPa, compression positive."""

    name: str
    kind: str  #: key of NEEDS
    columns: dict[str, np.ndarray]
    source: str  #: file it comes from
    lines: np.ndarray  #: line of each row in it
    control: str = ""  #: cyclic tests: of mud_triax
    cycle_by: str = ""
    held_out: bool = False
    understood: list[tuple[str, str]] = dataclasses.field(default_factory=list)  #: (what the table says, what it means)
    unknown_e_0: bool = False  #: the table has no void ratio of it

    def __contains__(self, name: str) -> bool:
        return name in self.columns

    def __getitem__(self, name: str) -> np.ndarray:
        return self.columns[name]

    @property
    def e_0(self) -> float:
        """Void ratio at the start [-]."""
        return float(self.columns["e_0"][0] if "e_0" in self.columns else self.columns["e"][0])

    def set_void_ratio(self, e_0: float) -> None:
        """Gives a shear test the void ratio at the start, and with it that of every row."""
        self.columns["e_0"] = np.full(len(self.lines), e_0)
        change = self.columns["eps_v"] if self.kind == "drained" else 0.0
        self.columns["e"] = self.columns["e_0"] - (1 + e_0) * change

    def with_void_ratio(self, e_0: float) -> LaboratoryTest:
        """The same test with another void ratio at the start."""
        other = dataclasses.replace(self, columns=dict(self.columns))
        other.set_void_ratio(e_0)
        return other

    @property
    def suction(self) -> float:
        """Suction at the start [kPa]."""
        return float(self.columns["suction"][0]) if "suction" in self.columns else 0.0

    @property
    def sigma_r(self) -> float:
        """Effective radial stress of a drained test [kPa], held: the median of what was measured, or the given one."""
        if "sigma_r" in self.columns:
            return float(np.median(self["sigma_r"]))
        return float(np.median(self["p"] - self["q"] / 3))


def _head(cells: list[str], path: pathlib.Path, line: int, kind: str) -> list[tuple[str, float | None]]:
    """(quantity, factor) of every column; the factor is None where no unit stands behind the name."""
    known = {*STRAINS, *STRESSES, *NUMBERS, *TEXTS}
    shares = ("S_w", "r_u", "damping")  # numbers that may be given in per cent
    found: list[tuple[str, float | None]] = []
    for cell in cells:
        name, factor = cell.strip().removesuffix("_derived").removesuffix("_initial"), None
        stem, _, last = name.rpartition("_")
        if stem and last in UNITS:
            name, factor = stem, UNITS[last]
        name = (SATURATION if kind == "retention" else {}).get(name, ALIASES.get(name, name))
        if (
            name in STRESSES
            and name != "amplitude"
            and factor == 0.01
            or name in STRAINS
            and factor not in (None, 0.01)
            or name in NUMBERS
            and factor is not None
            and not (name in shares and factor == 0.01)
        ):
            raise InputError(f"{path}:{line}: the column {cell} has a unit that {name} cannot have")
        found.append((name, factor))
    double = next(
        (name for i, (name, _) in enumerate(found) if name in known and name in [n for n, _ in found[:i]]), None
    )
    if double:
        raise InputError(f"{path}:{line}: two columns are called {double} (units behind the name do not count)")
    return found


def read_table(path: str | os.PathLike, kind: str) -> list[LaboratoryTest]:
    """The tests of a sheet, checked: a file with commas, semicolons or tabs between cells, or the first sheet of a workbook.

    kind : drained, undrained, oedometer, isotropic, cyclic, retention, stiffness, modulus or liquefaction; ``NEEDS`` lists the
        columns each one needs. A table without a column ``test`` holds one test, called as the file. Where no cell of a test has
        a void ratio it is unknown: ``unknown_e_0``.

    Raises ``InputError``: file, line, what is wrong, and what to do.
    """
    path = pathlib.Path(path)
    if kind not in NEEDS:
        raise InputError(f"there is no kind of test {kind}; there are {', '.join(NEEDS)}")
    sheet = read_sheet(path, frozenset({*STRAINS, *STRESSES, *NUMBERS, *TEXTS, *ALIASES}))
    rows = sheet.rows
    if len(rows) < 2:
        raise InputError(f"{path} has no rows of numbers below its line of names")
    head = _head(rows[0][1], path, rows[0][0], kind)
    names = [name for name, _ in head]
    both = {"sigma_a", "sigma_r"} <= set(names) and kind in ("drained", "undrained")
    _need_columns(path, rows[0], kind, [*names, *(("q", "p") if both else ())])
    unread = [name for name in names if name and name not in (*STRAINS, *STRESSES, *NUMBERS, *TEXTS)]
    groups: dict[str, list[tuple[int, list[str]]]] = {}
    name = ""
    for number, cells in rows[1:]:
        if len(cells) != len(head):
            raise InputError(f"{path}:{number}: {len(cells)} cells, the line of names has {len(head)}")
        name = (cells[names.index("test")].strip() or name) if "test" in names else path.stem
        groups.setdefault(name, []).append((number, cells))
    tests = [_test(path, kind, name, head, rows[0][1], mine) for name, mine in groups.items()]
    for test in tests:
        test.understood = [*sheet.understood, *((word, "not read") for word in unread), *test.understood]
    _guess_void_ratios(path, tests)
    return tests


def _guess_void_ratios(path: pathlib.Path, tests: list[LaboratoryTest]) -> None:
    """The prior of an unknown void ratio: the mean of the other tests'."""
    known = [test.e_0 for test in tests if not test.unknown_e_0 and ("e" in test or "e_0" in test)]
    for test in tests:
        if test.unknown_e_0:
            if not known:
                raise InputError(f"{path}, test {test.name}: no test of the table has a void ratio; give one at least")
            test.set_void_ratio(float(np.mean(known)))
            test.understood.append(
                (f"no void ratio in test {test.name}", f"an unknown of the fit, its prior {test.e_0:.3f}, the others' mean")
            )


def _need_columns(path: pathlib.Path, head: tuple[int, list[str]], kind: str, names: list[str]) -> None:
    for need in NEEDS[kind]:
        choices = need if isinstance(need, tuple) else (need,)
        if any(choice in names for choice in choices):
            continue
        near = difflib.get_close_matches(choices[0], head[1], 1, 0.5)
        hint = f"; is {near[0]} meant?" if near else "."
        raise InputError(
            f"{path}:{head[0]}: a table of {kind} tests needs the column {' or '.join(choices)}; it has "
            f"{', '.join(head[1])}{hint} Name a column by its quantity with the unit behind it, as eps_a_percent, q_kPa, e_0: "
            "calibration/README.md, section Tables"
        )
    if kind == "drained" and "sigma_r" not in names and not {"p", "q"} <= set(names):
        raise InputError(
            f"{path}:{head[0]}: a table of drained tests needs p beside q, or sigma_r: which radial stress was held?"
        )


def _test(
    path: pathlib.Path,
    kind: str,
    name: str,
    head: list[tuple[str, float | None]],
    titles: list[str],
    rows: list[tuple[int, list[str]]],
) -> LaboratoryTest:
    columns: dict[str, np.ndarray] = {}
    words = {"control": "", "cycle_by": ""}
    understood: list[tuple[str, str]] = []
    numbers = np.array([number for number, _ in rows])
    for place, (quantity, factor) in enumerate(head):
        cells = [cells[place].strip() for _, cells in rows]
        if quantity in words:
            words[quantity] = cells[0]
        if quantity not in (*STRAINS, *STRESSES, *NUMBERS):
            continue
        if quantity in ("e", "e_0") and not any(cells) and kind in ("drained", "undrained"):
            continue
        if quantity in _stays(kind) and cells[0] and cells[1:] and not any(cells[1:]):
            understood.append((f"{titles[place]} in the first row of a test alone", "the same in its other rows"))
            cells = cells[:1] * len(cells)
        values = _values(path, titles[place], cells, numbers)
        if quantity in STRAINS:
            _check_percent(path, name, kind, quantity, titles[place], values, factor, numbers)
        largest = np.max(np.abs(values))
        if quantity in ("q", "p", "sigma_a", "sigma_r") and not TOO_SMALL <= largest * (factor or 1.0) <= TOO_LARGE:
            raise InputError(
                f"{path}, test {name}: the largest {titles[place]} is {largest:g}; stresses are in kPa unless the "
                "name says _MPa or _Pa, and a test of soil reaches between 2 kPa and 100 MPa"
            )
        if quantity == "amplitude" and words["cycle_by"] in ("eps_a", "gamma") and factor not in (None, 0.01):
            raise InputError(f"{path}, test {name}: an amplitude of {words['cycle_by']} is a strain, not a stress")
        columns[quantity] = values * (1.0 if factor is None else factor)
    test = LaboratoryTest(name, kind, columns, path.name, numbers, understood=understood, **words)
    if kind in ("drained", "undrained"):
        _stresses(test)
        test.unknown_e_0 = "e" not in test and "e_0" not in test and "eps_v" in test or (
            kind == "undrained" and "e" not in test and "e_0" not in test
        )
        if kind == "drained" and "e" not in test and "e_0" not in test and "eps_v" not in test:
            raise InputError(f"{path}, test {name}: neither a void ratio nor a volumetric strain is given")
    _void_ratio_of_compression(f"{path}, test {name}", test)
    if len(rows) < FEWEST_ROWS[kind]:
        raise InputError(f"{path}, test {name}: {len(rows)} rows; a {kind} test needs at least {FEWEST_ROWS[kind]}")
    _check_values(path, test)
    if kind == "liquefaction":
        test.columns["log_N"] = np.log10(test["N"])
    if kind == "drained":
        _complete_drained(test)
    elif kind == "undrained" and "e" not in test and "e_0" in test:
        test.columns["e"] = test["e_0"].copy()  # the volume is held
    return test


def _stays(kind: str) -> tuple[str, ...]:
    """Quantities that belong to a whole test: sheets with merged cells give them in its first row."""
    return ("e_0", "p_0", "amplitude", *(("sigma_r",) if kind == "drained" else ()))


def _values(path: pathlib.Path, title: str, cells: list[str], numbers: np.ndarray) -> np.ndarray:
    values = np.empty(len(cells))
    for i, cell in enumerate(cells):
        try:
            values[i] = float(cell)
        except ValueError:
            values[i] = np.nan
        if not np.isfinite(values[i]):
            raise InputError(f"{path}:{numbers[i]}: {title} = '{cell}' is not a number")
    return values


def _check_percent(
    path: pathlib.Path,
    name: str,
    kind: str,
    quantity: str,
    title: str,
    values: np.ndarray,
    factor: float | None,
    numbers: np.ndarray,
) -> None:
    """A strain whose size contradicts its unit."""
    at = int(np.argmax(np.abs(values)))
    largest = abs(values[at])
    limit = LARGEST_FRACTION["eps_v" if kind == "oedometer" else quantity]
    if factor is None and largest > limit:
        raise InputError(
            f"{path}:{numbers[at]}: test {name}: {title} reaches {values[at]:g}, too much for a strain as a "
            f"fraction; if it is in per cent call the column {quantity}_percent"
        )
    if factor is not None and quantity == "eps_a" and kind in ("drained", "undrained") and largest < SMALLEST_PERCENT:
        raise InputError(
            f"{path}:{numbers[at]}: test {name}: {title} ends at {values[at]:g} per cent, too little for a shear "
            f"test; if it is a fraction call the column {quantity}"
        )


def _check_values(path: pathlib.Path, test: LaboratoryTest) -> None:
    where = f"{path}, test {test.name}"

    def first(bad: np.ndarray) -> str:
        return f"{path}:{test.lines[int(np.argmax(bad))]}: test {test.name}"

    for quantity, low, high in (("e", 0.01, 5.0), ("e_0", 0.01, 5.0), ("S_w", 0.0, 1.0 + 1e-9), ("suction", 0.0, 1e7)):
        if quantity in test:
            bad = (test[quantity] < low) | (test[quantity] > high)
            if bad.any():
                value = test[quantity][int(np.argmax(bad))]
                hint = " (a void ratio or S_w in per cent?)" if quantity in ("e", "e_0", "S_w") and value > high else ""
                raise InputError(f"{first(bad)}: {quantity} = {value:g}, allowed {low:g} to {high:g}{hint}")
    if test.kind in ("drained", "undrained"):
        strain, q = test["eps_a"], test["q"] if "q" in test else test["stress_ratio"] - 1
        way = np.sign(strain[-1] - strain[0])
        back = np.diff(strain) * way < RETURN * abs(strain[-1])
        if back.any():
            at = int(np.argmax(back)) + 1
            raise InputError(
                f"{path}:{test.lines[at]}: test {test.name}: eps_a goes from {strain[at - 1]:g} to {strain[at]:g}; "
                f"in a {test.kind} test it moves one way. A test with reversals is cyclic; a row that is there "
                "twice must go"
            )
        late = slice(len(q) // 2, None)
        if way * np.median(q[late]) < 0:
            raise InputError(
                f"{where}: q is {'negative' if way > 0 else 'positive'} while eps_a "
                f"{'grows' if way > 0 else 'falls'}: one of the two has its sign swapped; compression is positive, "
                "and q = sigma_a - sigma_r"
            )
    for quantity in ("gamma", "csr", "N", "p_0", "G_max", "G_ratio"):
        if test.kind in ("stiffness", "modulus", "liquefaction") and quantity in test and np.any(test[quantity] <= 0):
            raise InputError(f"{first(test[quantity] <= 0)}: {quantity} must be above zero")
    for quantity in ("p", "sigma_a", "sigma_r"):
        if quantity in test and np.median(test[quantity]) <= 0:
            raise InputError(f"{where}: {quantity} is negative: compression is positive")
    _check_stress(where, test)
    _check_volume(where, test)


def _check_stress(where: str, test: LaboratoryTest) -> None:
    """The stress path that the kind of test prescribes, and where the curves must lead."""
    if test.kind in ("drained", "undrained") and {"p", "q"} <= set(test.columns):
        radial = test["p"] - test["q"] / 3
        middle = float(np.median(radial))
        if test.kind == "drained" and "sigma_r" not in test and np.max(np.abs(radial - middle)) > HELD * abs(middle):
            raise InputError(
                f"{where}: p - q/3 goes from {radial.min():g} to {radial.max():g} kPa; in a drained test it is the radial "
                "stress, which is held. Are p and q exchanged, or is p not effective?"
            )
        start = float(test["p"][0])
        if test.kind == "undrained" and np.ptp(radial) < TOTAL * start and np.ptp(test["q"]) > 0.5 * start:
            raise InputError(
                f"{where}: p - q/3 stays at {middle:g} kPa: p seems to be the total mean stress; an undrained test needs the "
                "effective one"
            )
    if test.kind in ("oedometer", "isotropic"):
        stress = test["sigma_a" if test.kind == "oedometer" else "p"]
        first, last = int(np.argmin(stress[: int(np.argmax(stress)) + 1])), int(np.argmax(stress))
        if last > first and test["e"][last] > test["e"][first]:
            raise InputError(
                f"{where}: e grows from {test['e'][first]:g} to {test['e'][last]:g} while the stress grows from "
                f"{stress[first]:g} to {stress[last]:g} kPa: are the rows in the order of the test, and is e the void ratio?"
            )
    if test.kind == "retention":
        driest, wettest = int(np.argmax(test["suction"])), int(np.argmin(test["suction"]))
        if test["S_w"][driest] > test["S_w"][wettest]:
            raise InputError(
                f"{where}: S_w is {test['S_w'][driest]:g} at the largest suction and {test['S_w'][wettest]:g} at the smallest; "
                "it must fall. Suction is positive; S_w is 1 where the pores are full"
            )


def _check_volume(where: str, test: LaboratoryTest) -> None:
    """Volumetric strain against e and against what sand does: it contracts before it dilates."""
    if "eps_v" not in test or test.kind == "cyclic":
        return
    change = test["eps_v"] - test["eps_v"][0]
    if "e" in test:
        told = (test["e"][0] - test["e"]) / (1 + test["e"][0])
        size = float(told @ told)
        ratio = float(change @ told) / size if size > 0 else 1.0
        if abs(ratio + 1) < SLOPE_MISFIT:
            raise InputError(
                f"{where}: eps_v and e contradict each other: where the void ratio grows eps_v must fall. The sign of "
                "eps_v is swapped; compression is positive"
            )
        if abs(ratio - 1) > SLOPE_MISFIT:
            raise InputError(
                f"{where}: eps_v is {ratio:.3g} times what e tells, (e_0 - e)/(1 + e_0). A hundred times: per cent, call the "
                "column eps_v_percent; a hundredth: fractions, call it eps_v"
            )
    if test.kind != "drained":
        return
    if abs(test["eps_a"][-1]) >= 0.05 and np.max(np.abs(change)) < SMALLEST_VOLUME:
        raise InputError(
            f"{where}: eps_v stays within {100 * np.max(np.abs(change)):.2g} per cent over a whole drained test; if it is a "
            "fraction call the column eps_v"
        )
    lowest, highest = int(np.argmin(change)), int(np.argmax(change))
    if change[lowest] < -DILATES and change[highest] > DILATES and lowest < highest and test["eps_a"][-1] > 0:
        raise InputError(
            f"{where}: eps_v falls to {change[lowest]:.3g} and rises to {change[highest]:.3g} later: sand contracts before it "
            "dilates, so the sign of eps_v is swapped; compression is positive"
        )


def _stresses(test: LaboratoryTest) -> None:
    """q and p of sigma_1 and sigma_3 where they are not given; total stresses less the pore pressure."""
    columns = test.columns
    if not {"sigma_a", "sigma_r"} <= set(columns):
        return
    if test.kind == "undrained" and "u" in columns and "p" not in columns:
        if np.ptp(columns["sigma_r"]) < TOTAL * np.max(columns["sigma_r"]) < np.ptp(columns["u"]):
            for name in ("sigma_a", "sigma_r"):
                columns[name] = columns[name] - columns["u"]
            test.understood.append(("sigma_3 that stays while u changes", "total stresses; u is taken off"))
    told = []
    if "q" not in columns:
        columns["q"] = columns["sigma_a"] - columns["sigma_r"]
        told.append("q = sigma_1 - sigma_3")
    if "p" not in columns:
        columns["p"] = (columns["sigma_a"] + 2 * columns["sigma_r"]) / 3
        told.append("p' = (sigma_1 + 2 sigma_3)/3")
    if told:
        test.understood.append(("sigma_1, sigma_3", ", ".join(told) + ", effective stresses"))


def _void_ratio_of_compression(where: str, test: LaboratoryTest) -> None:
    """The void ratio of a compression test whose strain is given."""
    strain = {"oedometer": "eps_a", "isotropic": "eps_v"}.get(test.kind, "e")
    if "e" in test or strain not in test:
        return
    if "e_0" not in test:
        raise InputError(f"{where}: {strain} alone says nothing of the void ratio; give e_0 too")
    test.columns["e"] = test["e_0"] - (1 + test["e_0"]) * test[strain]
    test.understood.append((f"{strain} and e_0", f"e = e_0 - (1 + e_0) {strain}"))


def _complete_drained(test: LaboratoryTest) -> None:
    """q of a stress ratio, eps_v of e, e of eps_v."""
    columns = test.columns
    if "q" not in columns:
        columns["q"] = (columns["stress_ratio"] - 1) * columns["sigma_r"]
    if "eps_v" not in columns:
        columns["eps_v"] = (columns["e"][0] - columns["e"]) / (1 + columns["e"][0])
    if "e" not in columns and "e_0" in columns:
        columns["e"] = columns["e_0"] - (1 + columns["e_0"]) * columns["eps_v"]
    if "p" not in columns:
        columns["p"] = columns["sigma_r"] + columns["q"] / 3
