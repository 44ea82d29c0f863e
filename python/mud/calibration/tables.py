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
from collections.abc import Sequence

import numpy as np

from ..errors import InputError
from ..material import VOID_RATIOS
from .effective import SHEAR, effective_stresses, pore_pressure, usual_p_and_q
from .heads import STRESSES, UNITS, Head
from .sheets import Sheet, read_sheets
from .steps import noise_of, without_noise

STRAINS = ("eps_a", "eps_v", "gamma")
TEXTS = ("test", "control", "cycle_by")
# What a kind of test needs; a tuple: one of these.
NEEDS = {
    "drained": ("eps_a", ("q", "stress_ratio"), ("e", "e_0")),
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
NO_PRESSURE, VACUUM = 5.0, 100.0  # [kPa] by which the zero of a pore pressure may be off; by which it may lie below
TOO_LARGE = 1.0e5  # [kPa]; a largest stress above means another unit
# And one below: of p_0 (also at 1 g), and of the other stresses of a test together, where no name has a unit and where one has.
SMALLEST = {("p_0",): (0.5, 0.0), ("q", "p", "sigma_a", "sigma_r"): (20.0, 2.0)}
LARGEST_AMPLITUDE = 0.03  # of a strain under a name without unit: more means per cent
# What has one value in a test, and the share by which a record of it may scatter; each row of ROWS_APART is a test of its own.
STEADY = 0.1
ONE, ROWS_APART = {"e_0": 0.01, "p_0": STEADY, "amplitude": STEADY}, ("stiffness", "modulus", "liquefaction")
HELD = 0.15  # share by which a suction, or p - q/3 where the radial stress is held, may leave its median
TOTAL = 0.02  # share of p at the start by which p - q/3 moves at least in an undrained test that is sheared
# Where a shear test begins: share of the radial stress from which on q means anisotropic consolidation or a sample that has been
# sheared; axial strain up to which it has not moved; strains that an unsheared sample has at most.
ANISOTROPIC, STRAINLESS, UNSHEARED = 0.15, 1e-4, 2.5e-3
# What leads the path of a test, and whether by its logarithm.
LEADS = {"drained": ("eps_a", False), "undrained": ("eps_a", False), "oedometer": ("sigma_a", True)}
LEADS |= {"isotropic": ("p", True), "retention": ("suction", True), "cyclic": ("cycle", False)}
# What a quantity of soil can be, measured, and what a number below or above may mean.
RANGES = (
    ("e", *VOID_RATIOS, "", " (a void ratio in per cent?)"),
    ("e_0", *VOID_RATIOS, "", " (a void ratio in per cent?)"),
    ("S_w", -0.05, 1.05, "", " (S_w in per cent? Call the column S_w_percent)"),
    ("suction", 0.0, 1e7, " (a matric potential? Suction is positive)", " (in Pa? Call the column suction_Pa)"),
    ("r_u", -10.0, 2.0, "", " (r_u in per cent? Call the column r_u_percent)"),
    ("damping", -0.02, 1.0, "", " (damping in per cent? Call the column damping_percent)"),
    ("G_ratio", 0.0, 1.5, "", " (it is G over G_max, as a fraction)"),
    ("csr", 0.0, 3.0, "", " (csr in per cent? It is q/(2 p_0), as a fraction)"),
    ("G_max", 0.0, 1e7, "", " (in Pa call the column G_max_Pa, in kPa G_max_kPa)"),
)
# Sizes that are doubted where the head has no unit.
SOFTEST = 1e3  # [kPa]; sand has a larger G_max: less means MPa
DRAINS = 0.3  # [kPa], 3 cm of water: a retention test goes further
SHEARED, STILL, NARROW = 1e-2, 0.7, 0.04  # at this shear strain soil has less of G_max left, and more damping
# Fractions under a head in per cent.
SMALL, LOST = 2e-5, 0.5  # up to this shear strain soil keeps more of G_max
DAMPED, LEAST = 1e-3, 5e-3  # at this one it has more damping
COMPRESSES = 4e-5  # [kPa^-1/2] strain of compression over the growth of stress^(1/2); stiffer by ten than dense sand is
WEAK, FALLEN = 0.75, 0.15  # shares of the strength, and of the fall of eps_v that has happened by then: see _check_volume
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

    def start_of_shear(self) -> tuple[float, float]:
        """Effective radial and deviator stress [kPa] from which a shear test starts: the latter is that of the first row where
        it is large before the sample has moved, for then consolidation was anisotropic; else 0."""
        q = float(self["q"][0])
        radial = self.sigma_r if self.kind == "drained" else float(self["p"][0] - q / 3)
        return radial, q if abs(self["eps_a"][0]) <= STRAINLESS and abs(q) > ANISOTROPIC * radial else 0.0


def read_table(path: str | os.PathLike, kind: str) -> list[LaboratoryTest]:
    """The tests of a file, checked: cells between commas, semicolons, tabs or blanks, or the sheets of a workbook.

    kind : drained, undrained, oedometer, isotropic, cyclic, retention, stiffness, modulus or liquefaction; ``NEEDS`` lists the
        columns each one needs. A table without a column ``test`` holds one test, called as the file, or as its sheet where
        several sheets hold tests. Where no cell of a test has a void ratio it is unknown: ``unknown_e_0``.

    Raises ``InputError``: file, line, what is wrong, and what to do.
    """
    path = pathlib.Path(path)
    if kind not in NEEDS:
        raise InputError(f"there is no kind of test {kind}; there are {', '.join(NEEDS)}")
    sheets = read_sheets(path, kind)
    lacks = {sheet.title: " or ".join(_lack(kind, sheet.heads)) for sheet in sheets}
    used = [sheet for sheet in sheets if not lacks[sheet.title]] or sheets[:1]
    if not used or not used[0].rows:
        raise InputError(f"{path} has no rows of numbers below its line of names")
    if len(sheets) > 1:
        left = ", ".join(f"{sheet.title} (no {lacks[sheet.title]})" for sheet in sheets if sheet not in used)
        titles = f"the sheet{'s' * (len(used) > 1)} {', '.join(sheet.title for sheet in used)}"
        told = ("the table" if len(used) == 1 else "a table each") + f"; not read: {left}" * bool(left)
        used[0].understood.append((titles, told))
    tests = [test for sheet in used for test in _tests_of(path, kind, sheet, sheet.title if len(used) > 1 else "")]
    _guess_void_ratios(path, tests)
    return tests


def _tests_of(path: pathlib.Path, kind: str, sheet: Sheet, title: str) -> list[LaboratoryTest]:
    """The tests of a sheet. title : how it is called, where several sheets hold tests."""
    place = f"{path}, sheet {title}" if title else f"{path}"
    good = {(head.quantity, head.state) for head in sheet.heads if not head.wrong_unit()}
    # Without a unit that is known beside a column of the same quantity with one: a column of something else.
    heads = [Head(h.title) if h.strange and (h.quantity, h.state) in good else h for h in sheet.heads]
    _check_heads(f"{place}:{sheet.line}", kind, heads)
    sheet.understood += [(head.title, head.told()) for head in heads if head.quantity and not head.is_plain()]
    names = [head.quantity for head in heads]
    groups: dict[str, list[tuple[int, list[str]]]] = {}
    name = ""
    for number, cells in sheet.rows:
        if len(cells) != len(heads):
            raise InputError(f"{place}:{number}: {len(cells)} cells, the line of names has {len(heads)}")
        name = (cells[names.index("test")].strip() or name) if "test" in names else title or path.stem
        groups.setdefault(name, []).append((number, cells))
    noise: list[tuple[int, float]] = []
    tests = [_test(place, path.name, kind, name, heads, mine, noise) for name, mine in groups.items()]
    if noise:
        rows, back = f"{len(noise)} row{'s' * (len(noise) > 1)}", max(size for _, size in noise)
        step = f" or behind it by at most {100 * back:.2g} %{' of its value' * LEADS[kind][1]}" if back else ""
        told = f"noise of the record: {rows} dropped, the first in line {min(line for line, _ in noise)}"
        sheet.understood.append((f"a row equal to the one before{step}", told))
    unread = [(head.title, "not read") for head in heads if head.title and not head.quantity]
    for test in tests:
        test.understood = [*sheet.understood, *unread, *test.understood]
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


def _lack(kind: str, heads: Sequence[Head]) -> tuple[str, ...]:
    """The first need of a kind of test that the heads do not meet; nothing if they meet all."""
    names = {head.quantity for head in heads}
    if kind in SHEAR and {"sigma_a", "sigma_r"} <= names:
        names |= {"q", "p"}
    if kind in SHEAR and {"q", "sigma_r"} <= names:
        names |= {"p"}
    for need in NEEDS[kind]:
        choices = need if isinstance(need, tuple) else (need,)
        if not names & set(choices):
            return choices
    return ("sigma_r", "p beside q") if kind == "drained" and "sigma_r" not in names and not {"p", "q"} <= names else ()


def _check_heads(where: str, kind: str, heads: Sequence[Head]) -> None:
    """Refuses units that cannot be, two columns of one name, and columns that are missing."""
    titles = [head.title for head in heads]
    for head in heads:
        if head.quantity and head.wrong_unit():
            raise InputError(f"{where}: {head.wrong_unit()}")
    known = [(head.quantity, head.state) for head in heads if head.quantity]
    double = next((name for i, (name, state) in enumerate(known) if (name, state) in known[:i]), None)
    if double:
        told = ", ".join(head.title for head in heads if head.quantity == double)
        raise InputError(f"{where}: two columns are called {double} (units behind the name do not count): {told}")
    choices = _lack(kind, heads)
    wanted = (*choices, *(("u",) if "u" not in [head.quantity for head in heads] else ()))
    for head in heads:  # sigma_1_furlong: the column is there, and its unit is not known
        if head.near in wanted:
            raise InputError(f"{where}: {head.wrong_unit()}")
    if choices:
        near = difflib.get_close_matches(choices[0], titles, 1, 0.5)
        hint = f"; is {near[0]} meant?" if near else "."
        raise InputError(
            f"{where}: a table of {kind} tests needs the column {' or '.join(choices)}; it has "
            f"{', '.join(titles)}{hint} Name a column by its quantity with the unit behind it, as eps_a_percent, q_kPa, e_0: "
            "calibration/README.md, section Tables"
        )


def _test(
    place: str,
    source: str,
    kind: str,
    name: str,
    heads: Sequence[Head],
    rows: list[tuple[int, list[str]]],
    noise: list[tuple[int, float]],
) -> LaboratoryTest:
    """A test of its rows. noise : gets the line of every row that is dropped, and how far it lies behind."""
    where = f"{place}, test {name}"
    columns: dict[str, np.ndarray] = {}
    stresses: dict[tuple[str, str], tuple[str, np.ndarray]] = {}
    pressures: dict[str, tuple[str, np.ndarray]] = {}
    words = {"control": "", "cycle_by": ""}
    understood: list[tuple[str, str]] = []
    sizes: list[tuple[float, Head]] = []
    numbers = np.array([number for number, _ in rows])
    for at, head in enumerate(heads):
        cells = [cells[at].strip() for _, cells in rows]
        if head.quantity in words:
            words[head.quantity] = cells[0]
            if len({cell for cell in cells if cell}) > 1:
                raise InputError(f"{where}: {head.title} changes; what has another {head.quantity} is a test of its own")
        if head.quantity in ("", *TEXTS):
            continue
        if head.quantity in ("e", "e_0") and not any(cells) and kind in SHEAR:
            continue
        if head.quantity in _stays(kind) and cells[0] and cells[1:] and not any(cells[1:]):
            understood.append((f"{head.title} in the first row of a test alone", "the same in its other rows"))
            cells = cells[:1] * len(cells)
        given = _values(place, head.title, cells, numbers)
        if head.quantity in STRAINS:
            _check_percent(place, name, kind, head, given, numbers)
        values = head.inside(given)
        sizes.append((float(np.max(np.abs(values))), head))
        if head.quantity in ONE and kind not in ROWS_APART and np.ptp(values) > ONE[head.quantity] * np.max(np.abs(values)):
            raise InputError(
                f"{where}: {head.title} goes from {np.min(given):g} to {np.max(given):g}; a test has one, which may stand in its "
                "first row alone. What has another is a test of its own"
                + ", and a void ratio of every row is called e" * (head.quantity == "e_0")
            )
        if head.quantity in STRESSES:
            stresses[head.quantity, head.state] = head.title, values
        elif head.quantity == "u":
            pressures[head.state] = head.title, values
        else:
            columns[head.quantity] = values
    _check_stress_units(where, sizes)
    pressure, since, told = pore_pressure(kind, pressures)
    if pressure is not None:
        columns["u"] = pressure
        if pressure[0] < -VACUUM:
            raise InputError(
                f"{where}: the pore pressure begins at {pressure[0]:g} kPa, below a vacuum; it is positive in compression, and "
                "suction is a column of its own"
            )
        if pressure[0] < -NO_PRESSURE:
            below = f"a pore pressure that begins at {pressure[0]:.4g} kPa in test {name}"
            told.append((below, "a vacuum in pores without air or without water; where they hold both it is suction"))
    amplitude = next((head for head in heads if head.quantity == "amplitude"), None)
    if amplitude:
        _check_amplitude(where, words["cycle_by"], amplitude, columns["amplitude"])
    understood += [*told, *effective_stresses(where, kind, stresses, columns, since)]
    understood += usual_p_and_q(where, kind, columns)
    test = LaboratoryTest(name, kind, columns, source, numbers, understood=understood, **words)
    _derive_stresses(test, "u" in columns)
    lack = _lack(kind, [head for head in heads if head.quantity not in STRESSES] + [Head(name, name) for name in columns])
    if lack:
        raise InputError(
            f"{where}: {' or '.join(lack)} is missing, because a total stress alone says nothing of the effective one; give "
            "the pore pressure, u_kPa (zeros where there is none), or the effective stress, as sigma_3'"
        )
    if kind in SHEAR:
        test.unknown_e_0 = "e" not in test and "e_0" not in test
        if kind == "drained" and test.unknown_e_0 and "eps_v" not in test:
            raise InputError(f"{where}: neither a void ratio nor a volumetric strain is given")
    measured = {"oedometer": "eps_a", "isotropic": "eps_v"}.get(kind, "") in columns  # else it may be rounded
    if (kind == "drained" or measured) and "e" in columns and not np.ptp(columns["e"]):
        columns.setdefault("e_0", columns.pop("e"))
        test.understood.append((f"one e in every row of test {name}", "the void ratio at the start, e_0"))
    _void_ratio_of_compression(where, test)
    if kind in LEADS:
        _drop_noise(place, test, noise)
    if len(test.lines) < FEWEST_ROWS[kind]:
        raise InputError(f"{where}: {len(test.lines)} rows; a {kind} test needs at least {FEWEST_ROWS[kind]}")
    _check_values(place, test)
    _check_sizes(where, test, {head.quantity: head.unit for head in heads})
    if kind == "liquefaction":
        test.columns["log_N"] = np.log10(test["N"])
    if kind == "drained":
        _complete_drained(test)
    elif kind == "undrained" and "e" not in test and "e_0" in test:
        test.columns["e"] = test["e_0"].copy()  # the volume is held
    if kind in SHEAR:
        _check_start(place, test)
    if kind == "cyclic" and "eps_v" in test and test["eps_v"][-1] < -DILATES:
        told = "dilation, because compression is positive: sand contracts by cycles"
        test.understood.append((f"eps_v = {test['eps_v'][-1]:.3g} at the end of test {name}", told))
    return test


def _check_start(place: str, test: LaboratoryTest) -> None:
    """Refuses strains with another zero than the start of shearing; tells where the model starts other than may be expected."""
    strain, q = test["eps_a"], test["q"]
    radial, q_0 = test.start_of_shear()
    unsheared = abs(q[0]) <= ANISOTROPIC * radial or abs(strain[0]) <= STRAINLESS
    for name in ("eps_a", "eps_v"):
        if unsheared and name in test and abs(test[name][0]) > UNSHEARED:
            raise InputError(
                f"{place}:{test.lines[0]}: test {test.name}: {name} begins at {test[name][0]:g}, before the sample is sheared: "
                "strains count from the start of shearing, and e_0 is the void ratio there. Take the first value off the others"
            )
    if np.median(q) < 0:
        test.understood.append((f"a negative q in test {test.name}", "extension, because compression is positive"))
    if q_0:
        told = "the start of the model, of a sample that was consolidated anisotropically"
        test.understood.append((f"q = {q_0:.4g} kPa without axial strain in test {test.name}", told))
    if test.suction > 0:
        told = "Bishop's effective stress: net stresses must be raised by S_w times the suction"
        test.understood.append((f"a stress at a suction of {test.suction:g} kPa in test {test.name}", told))


def _drop_noise(place: str, test: LaboratoryTest, noise: list[tuple[int, float]]) -> None:
    """Leaves out the rows that are equal to the one before or step back within the noise of the record. Points of a retention
    curve at one suction stay: each of them counts."""
    lead, by_stress = LEADS[test.kind]
    if by_stress and np.median(test[lead]) <= 0:
        return  # a sign that is swapped, which is told below
    kept, turns, back = without_noise(test[lead], by_stress, test.kind == "retention")
    if test.kind in SHEAR and len(turns):
        at, strain = int(turns[0]), test[lead]
        low = at + 1 + int(np.argmax(np.abs(strain[at + 1 :] - strain[at]) > noise_of(strain)))
        raise InputError(
            f"{place}:{test.lines[low]}: test {test.name}: {lead} goes from {strain[at]:g} to {strain[low]:g}, more than the "
            f"noise of the record ({noise_of(strain):.2g}); in a {test.kind} test it moves one way. A test with reversals is "
            "cyclic; an unloading at the end must go"
        )
    dropped = np.setdiff1d(np.arange(len(test.lines)), kept)
    noise += [(int(test.lines[row]), back) for row in dropped]
    test.columns = {name: values[kept] for name, values in test.columns.items()}
    test.lines = test.lines[kept]


def _stays(kind: str) -> tuple[str, ...]:
    """Quantities that belong to a whole test: sheets with merged cells give them in its first row."""
    return ("e_0", "p_0", "amplitude", *(("sigma_r", "u") if kind == "drained" else ()))


def _values(place: str, title: str, cells: list[str], numbers: np.ndarray) -> np.ndarray:
    values = np.empty(len(cells))
    for i, cell in enumerate(cells):
        try:
            values[i] = float(cell)
        except ValueError:
            values[i] = np.nan
        if not np.isfinite(values[i]):
            raise InputError(f"{place}:{numbers[i]}: {title} = '{cell}' is not a number")
    return values


def _check_stress_units(where: str, sizes: Sequence[tuple[float, Head]]) -> None:
    """Refuses stresses of a size that no test of soil has. One of several may be small, as q of a loose sample is."""
    for quantities, least in SMALLEST.items():
        mine = [given for given in sizes if given[1].quantity in quantities]
        if not mine:
            continue
        size, head = max(mine, key=lambda given: given[0])
        units = any(given[1].unit for given in mine)
        if not least[units] <= size <= TOO_LARGE:
            raise InputError(
                f"{where}: the largest stress is {size:g} kPa, of {head.title}, and a test of soil reaches between {least[units]:g} "
                f"kPa and 100 MPa. Give the unit in the name of the column, as {head.quantity}_{'Pa' if size > TOO_LARGE else 'MPa'}"
                + f", or {head.quantity}_kPa if it is kPa" * (not units and size < least[0])
            )


def _check_percent(place: str, name: str, kind: str, head: Head, values: np.ndarray, numbers: np.ndarray) -> None:
    """A strain whose size contradicts its unit."""
    at = int(np.argmax(np.abs(values)))
    largest = abs(values[at])
    limit = LARGEST_FRACTION["eps_v" if kind == "oedometer" else head.quantity]
    if head.worth == 1 and largest > limit:
        raise InputError(
            f"{place}:{numbers[at]}: test {name}: {head.title} reaches {values[at]:g}, too much for a strain as a "
            f"fraction; if it is in per cent call the column {head.quantity}_percent"
        )
    if head.unit == "percent" and head.quantity == "eps_a" and kind in SHEAR and largest < SMALLEST_PERCENT:
        raise InputError(
            f"{place}:{numbers[at]}: test {name}: {head.title} ends at {values[at]:g} per cent, too little for a shear "
            f"test; if it is a fraction call the column {head.quantity}"
        )


def _check_amplitude(where: str, by: str, head: Head, values: np.ndarray) -> None:
    """The amplitude of a strain or of a stress, by its unit and its size."""
    measure, wanted = UNITS[head.unit][0] if head.unit else "", "share" if by in STRAINS else "stress"
    if measure and measure != wanted:
        raise InputError(f"{where}: an amplitude of {by} is a {'strain' if by in STRAINS else 'stress'}; {head.title} is none")
    if not head.unit and by in STRAINS and np.max(np.abs(values)) > LARGEST_AMPLITUDE:
        raise InputError(
            f"{where}: an amplitude of {by} of {np.max(np.abs(values)):g}, and the name has no unit: in per cent call the column "
            "amplitude_percent, as a fraction amplitude_fraction"
        )


def _check_values(place: str, test: LaboratoryTest) -> None:
    where = f"{place}, test {test.name}"

    def first(bad: np.ndarray) -> str:
        return f"{place}:{test.lines[int(np.argmax(bad))]}: test {test.name}"

    for quantity, low, high, below, above in RANGES:
        if quantity in test:
            bad = (test[quantity] < low) | (test[quantity] > high)
            if bad.any():
                value = test[quantity][int(np.argmax(bad))]
                hint = below if value < low else above
                raise InputError(f"{first(bad)}: {quantity} = {value:g}, allowed {low:g} to {high:g}{hint}")
    if test.kind in ("drained", "undrained"):
        strain, q = test["eps_a"], test["q"] if "q" in test else test["stress_ratio"] - 1
        way = np.sign(strain[-1] - strain[0])
        late = slice(len(q) // 2, None)
        if way * np.median(q[late]) < 0 and way * (np.median(q[late]) - q[0]) < 0:  # it may come from K0
            raise InputError(
                f"{where}: q is {'negative' if way > 0 else 'positive'} while eps_a "
                f"{'grows' if way > 0 else 'falls'}: one of the two has its sign swapped; compression is positive, "
                "and q = sigma_a - sigma_r"
            )
    if "suction" in test and test.kind != "retention":
        suction = test["suction"]
        if test.kind in ROWS_APART and np.any(suction > 0):
            raise InputError(f"{where}: {suction.max():g} kPa of suction; a {test.kind} test is computed saturated")
        if np.max(np.abs(suction - np.median(suction))) > HELD * np.median(suction):
            raise InputError(
                f"{where}: suction goes from {suction.min():g} to {suction.max():g} kPa; a test is computed at a constant one"
            )
    if test.kind == "cyclic":
        bad = test["cycle"] != np.round(test["cycle"])
        if bad.any():
            raise InputError(
                f"{first(bad)}: cycle = {test['cycle'][int(np.argmax(bad))]:g}; a row stands at the end of a whole cycle"
            )
    for quantity in ("gamma", "csr", "N", "p_0", "G_max", "G_ratio"):
        if test.kind in ("stiffness", "modulus", "liquefaction") and quantity in test and np.any(test[quantity] <= 0):
            raise InputError(f"{first(test[quantity] <= 0)}: {quantity} must be above zero")
    for quantity in ("p", "sigma_a", "sigma_r"):
        if quantity in test and np.median(test[quantity]) <= 0:
            raise InputError(f"{where}: {quantity} is negative: compression is positive")
    _check_stress(where, test)
    _check_volume(where, test)


def _check_sizes(where: str, test: LaboratoryTest, units: dict[str, str]) -> None:
    """Sizes that no soil has, by which another unit shows. units : of the table's heads; one that is written is doubted only
    where it is per cent."""
    if test.kind == "stiffness" and not units["G_max"] and np.max(test["G_max"]) < SOFTEST:
        raise InputError(
            f"{where}: the largest G_max is {np.max(test['G_max']):g}, and the name has no unit: in MPa call the column G_max_MPa, "
            "in kPa G_max_kPa"
        )
    if test.kind == "retention" and not units["suction"] and np.max(test["suction"]) < DRAINS:
        raise InputError(
            f"{where}: the largest suction is {np.max(test['suction']):g}, and the name has no unit: call the column suction_MPa, "
            "suction_bar or suction_m, and in kPa suction_kPa"
        )
    if test.kind == "modulus":
        _check_modulus(where, test, units)
    if test.kind in ("oedometer", "isotropic") and "e" not in units:  # rounded void ratios tell nothing
        stress = test["sigma_a" if test.kind == "oedometer" else "p"]
        first, last = int(np.argmin(stress[: int(np.argmax(stress)) + 1])), int(np.argmax(stress))
        strain = (test["e"][first] - test["e"][last]) / (1 + test["e_0"][first])
        if stress[last] >= 4 * stress[first] and strain < COMPRESSES * (np.sqrt(stress[last]) - np.sqrt(stress[first])):
            raise InputError(
                f"{where}: from {stress[first]:g} to {stress[last]:g} kPa it is compressed by {100 * strain:.2g} per cent, ten "
                "times less than dense sand: are strains fractions (call the column eps_a, eps_v), or stresses in Pa (sigma_a_Pa)?"
            )


def _check_modulus(where: str, test: LaboratoryTest, units: dict[str, str]) -> None:
    """Shear strain against the modulus that is left, or against damping where the modulus is not given."""
    gamma = test["gamma"]
    if "damping" in test and units["damping"] == "percent" and np.max(gamma) >= DAMPED and np.max(test["damping"]) < LEAST:
        raise InputError(
            f"{where}: damping stays below {100 * LEAST:g} per cent though gamma reaches {np.max(gamma):g}: if damping is a "
            "fraction call its column damping; if gamma is in per cent call it gamma_percent"
        )
    stiff = test["G_ratio"] > STILL if "G_ratio" in test else test["damping"] < NARROW
    bad = (gamma >= SHEARED) & stiff
    if bad.any() and not units["gamma"]:
        said = f"more than {STILL:g} of G_max is left" if "G_ratio" in test else f"damping is below {NARROW:g}"
        raise InputError(
            f"{where}: gamma is {gamma[int(np.argmax(bad))]:g} where {said}, and the name has no unit: in per cent call the column "
            "gamma_percent, as a fraction gamma_fraction"
        )
    lost = (gamma <= SMALL) & (test["G_ratio"] < LOST) if "G_ratio" in test else np.array([False])
    if lost.any() and units["gamma"] == "percent":
        raise InputError(
            f"{where}: half of G_max is lost at gamma = {gamma[int(np.argmax(lost))]:g}, as a fraction: if the table gives "
            "fractions call the column gamma"
        )


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
                f"{where}: p - q/3 stays at {middle:g} kPa while q grows. Is p the total mean stress? An undrained test needs "
                "the effective one, or the pore pressure u beside the total one. Or is it a drained test?"
            )
    if test.kind in ("oedometer", "isotropic"):
        stress = test["sigma_a" if test.kind == "oedometer" else "p"]
        first, last = int(np.argmin(stress[: int(np.argmax(stress)) + 1])), int(np.argmax(stress))
        if last > first and test["e"][last] > test["e"][first]:
            raise InputError(
                f"{where}: e grows from {test['e'][first]:g} to {test['e'][last]:g} while the stress grows from "
                f"{stress[first]:g} to {stress[last]:g} kPa: are the rows in the order of the test, and is e the void ratio?"
            )
        compressed, swells = test["e"][first] - test["e"][last], test["e"][-1] - test["e"][last]
        if stress[-1] >= stress[first] and swells > 2 * compressed:
            raise InputError(
                f"{where}: e falls by {compressed:.3g} from {stress[first]:g} to {stress[last]:g} kPa and grows by {swells:.3g}, "
                f"more than twice as much, until it is unloaded to {stress[-1]:g} kPa. Are the rows in the order of the test?"
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
    name = "eps_a" if test.kind == "oedometer" else "eps_v"
    if name not in test or test.kind in ("cyclic", "undrained"):
        return
    change = test[name] - test[name][0]
    if "e" in test:
        told = (test["e"][0] - test["e"]) / (1 + test["e"][0])
        size = float(told @ told)
        ratio = float(change @ told) / size if size > 0 else 1.0
        if test.kind != "drained":
            if abs(ratio - 1) > SLOPE_MISFIT:
                meant = f"not used beside e; it is {ratio:.3g} times what e tells, (e_0 - e)/(1 + e_0)"
                test.understood.append((f"{name} of test {test.name}", meant))
            return
        if abs(ratio + 1) < SLOPE_MISFIT:
            raise InputError(
                f"{where}: {name} and e contradict each other: where the void ratio grows {name} must fall. The sign of "
                f"{name} is swapped; compression is positive"
            )
        if abs(ratio - 1) > SLOPE_MISFIT:
            raise InputError(
                f"{where}: {name} is {ratio:.3g} times what e tells, (e_0 - e)/(1 + e_0). A hundred times: per cent, call the "
                f"column {name}_percent; a hundredth: fractions, call it {name}"
            )
    if test.kind != "drained":
        return
    if abs(test["eps_a"][-1]) >= 0.05 and np.max(np.abs(change)) < SMALLEST_VOLUME:
        raise InputError(
            f"{where}: eps_v stays within {100 * np.max(np.abs(change)):.2g} per cent over a whole drained test; if it is a "
            "fraction call the column eps_v"
        )
    # Dense sand dilates fastest near its peak; a loose sample whose sign is swapped falls fastest where it begins.
    strain, q = test["eps_a"] - test["eps_a"][0], test["q"] if "q" in test else test["stress_ratio"] - 1
    peak = int(np.argmax(q))
    half = int(np.argmax(q >= 0.5 * q[peak]))
    large = change[half] < min(-DILATES, FALLEN * np.min(change))
    if strain[-1] > 0 and q[half] <= WEAK * q[peak] and large and change[half] * strain[peak] < change[peak] * strain[half]:
        raise InputError(
            f"{where}: eps_v has fallen by {-change[half]:.3g} where q has come to half of its largest value, and falls more "
            "slowly from there on: sand contracts before it dilates, so the sign of eps_v is swapped; compression is positive"
        )
    lowest, highest = int(np.argmin(change)), int(np.argmax(change))
    if change[lowest] < -DILATES and change[highest] > DILATES and lowest < highest and test["eps_a"][-1] > 0:
        raise InputError(
            f"{where}: eps_v falls to {change[lowest]:.3g} and rises to {change[highest]:.3g} later: sand contracts before it "
            "dilates, so the sign of eps_v is swapped; compression is positive"
        )


def _derive_stresses(test: LaboratoryTest, pore_pressure: bool) -> None:
    """q and p of a shear test of effective sigma_1 and sigma_3 where they are not given."""
    columns, told = test.columns, []
    if test.kind not in SHEAR or "sigma_r" not in columns:
        return
    if "q" not in columns and "sigma_a" in columns:
        columns["q"] = columns["sigma_a"] - columns["sigma_r"]
        told.append("q = sigma_1 - sigma_3")
    if "p" not in columns and "q" in columns:
        columns["p"] = columns["sigma_r"] + columns["q"] / 3
        told.append("p' = (sigma_1 + 2 sigma_3)/3")
    if told and "sigma_a" in columns:
        since = "" if pore_pressure else ", taken as effective stresses: the table has no pore pressure u"
        test.understood.append(("sigma_1, sigma_3", ", ".join(told) + since))


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
    if "eps_v" not in columns and "e" in columns:
        columns["eps_v"] = (columns["e"][0] - columns["e"]) / (1 + columns["e"][0])
    if "eps_v" not in columns:
        test.understood.append(("no volumetric strain", "not measured: q alone is compared"))
    elif "e" not in columns and "e_0" in columns:
        columns["e"] = columns["e_0"] - (1 + columns["e_0"]) * columns["eps_v"]
    if "p" not in columns:
        columns["p"] = columns["sigma_r"] + columns["q"] / 3
