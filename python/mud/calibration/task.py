# SPDX-License-Identifier: MIT
"""The task of a calibration: tables, known values, held-out tests; from Python or from a TOML file."""

from __future__ import annotations

import dataclasses
import os
import pathlib
import tomllib
from collections.abc import Mapping, Sequence

import numpy as np

from .._texts import text_of_bytes
from ..errors import InputError
from ..material import Material
from .simulation import SCATTER, Use, use_of
from .tables import LaboratoryTest, read_table
from .variables import GROUPS, LEAST_HARDENING, UNKNOWN, VARIABLES, Variable, chosen, known_parameters, meaning_of

KEYS = ("name", "title", "reference", "start", "seed", "known", "tables", "held_out", "groups", "bounds", "notes")
TABLE_KEYS = ("file", "kind", "first", "last", "scatter", "branch", "weight", "only", "name")


UNIT = (50.0, 200.0)  # [kPa] between them an atmosphere is in kPa
FRACTIONS = ("eps_v", "e", "S_w", "r_u", "G_ratio", "damping")
LARGEST_SCATTER = 0.2  # of one of these: more means per cent
HEAVIEST = 1e6  # weight of a table
LOOSER = 0.1  # [-] by which an unknown void ratio may lie beyond those of the other tests


@dataclasses.dataclass
class Item:
    """A test with what counts of it."""

    test: LaboratoryTest
    use: Use
    weight: float = 1.0

    def under(self, values: Mapping[str, float]) -> Item:
        """The same with the void ratio that a set of variables gives it, if the table has none."""
        name = UNKNOWN + self.test.name
        if not self.test.unknown_e_0 or name not in values:
            return self
        return dataclasses.replace(self, test=self.test.with_void_ratio(values[name]))


@dataclasses.dataclass
class Task:
    """A calibration. ``calibrate(task)`` runs it."""

    name: str  #: of the material, and of its file
    items: list[Item]
    title: str = ""
    reference: str = ""  #: where the tests come from
    start: str | pathlib.Path | None = None  #: material whose values are the start, and stay where nothing is fitted
    known: dict[str, float] = dataclasses.field(default_factory=dict)
    groups: list[str] | None = None  #: groups that are fitted; None: those that the tests depend on
    bounds: dict[str, tuple[float, float]] = dataclasses.field(default_factory=dict)  #: in place of the usual ones
    seed: int = 1
    notes: list[str] = dataclasses.field(default_factory=list)  #: sentences for the report

    def __post_init__(self):
        if isinstance(self.groups, str):
            self.groups = [self.groups]
        if not isinstance(self.seed, (int, np.integer)) or self.seed < 0:
            raise InputError(f"seed = {self.seed!r} is not a whole number from 0 on")
        self.base = dict(in_kpa(Material(self.start)).items())
        values, self.origins = known_parameters(self.known, self.base)
        self.base.update({k: v for k, v in values.items() if k in self.base})
        turning = [item.test.name for item in self.fitted() if item.test.kind == "retention" and item.use.turning]
        if turning and "hysteresis" not in values:
            self.base["hysteresis"] = 1.0
            self.origins["hysteresis"] = f"the suction of {', '.join(turning)} turns"
        self.base.update({UNKNOWN + i.test.name: i.test.e_0 for i in self.items if i.test.unknown_e_0})
        self.fixed_variables = {k: v for k, v in values.items() if k not in self.base}
        for name, pair in self.bounds.items():
            if name not in VARIABLES:
                raise InputError(f"bounds: {name} is not fitted; there are {', '.join(VARIABLES)}")
            if np.shape(pair) != (2,):
                raise InputError(f"bounds: {name} = {pair!r}: give a lower and an upper bound, as (0.5, 20)")
            low, high = pair
            if name in self.origins:
                raise InputError(f"bounds: {name} has no effect, because it is known ({self.origins[name]}); remove one of the two")
            if not low < high < np.inf or not low > (0 if VARIABLES[name].log else -np.inf):
                above = ", above zero" * VARIABLES[name].log
                raise InputError(f"bounds: {name} from {low:g} to {high:g}; a lower and then an upper bound{above}")

    def fitted(self) -> list[Item]:
        """Tests that are not held out."""
        return [item for item in self.items if not item.test.held_out]

    def variables(self) -> list[Variable]:
        """What is fitted, with the bounds of this task."""
        kinds = {item.test.kind for item in self.fitted()}
        unsaturated = any(item.test.suction > 0 for item in self.fitted() if item.test.kind != "retention")
        bounds = dict(self.bounds)
        loosest = max((item.test["e"][item.use.rows].max() for item in self.fitted() if "e" in item.test), default=0.0)
        if loosest > 0 and "c_h" not in bounds:
            c_h = VARIABLES["c_h"]
            bounds["c_h"] = (c_h.lower, min(c_h.upper, (1 - LEAST_HARDENING) / float(loosest)))
        ratios = [item.test.e_0 for item in self.fitted() if "e_0" in item.test or "e" in item.test]
        unknown = [
            Variable(
                UNKNOWN + item.test.name, GROUPS[0], min(ratios) - LOOSER, max(ratios) + LOOSER, False, "1", meaning_of(UNKNOWN)
            )
            for item in self.fitted()
            if item.test.unknown_e_0
        ]
        return [
            dataclasses.replace(v, lower=bounds[v.name][0], upper=bounds[v.name][1]) if v.name in bounds else v
            for v in [*chosen(kinds, unsaturated, self.base["hysteresis"] != 0, [*self.origins], self.groups), *unknown]
        ]


def in_kpa(material: Material) -> Material:
    """The material, if it is in the unit of the tests."""
    if not UNIT[0] < material["p_atm"] < UNIT[1]:
        raise InputError(
            f"a material has p_atm = {material['p_atm']:g}, and the tests are in kPa; give it in kPa: Material.converted(factor)"
        )
    return material


def make_task(
    name: str, tables: Sequence[Mapping], held_out: Sequence[str] = (), folder: str | os.PathLike = ".", **others: object
) -> Task:
    """A task of tables: each a mapping of ``file`` and ``kind``, and if wanted ``first``, ``last`` (range of the leading
    quantity: strain as a fraction, stress in kPa), ``scatter`` ({"q": [3.0, 0.05]}: kPa or fraction, and share of the value),
    ``branch`` (of retention), ``only`` (names of tests), ``weight`` and ``name`` (of the one test of a table). held_out : names of tests, chosen before the fit.
    folder : of the files of the tables and, if it is a file, of ``start``.
    """
    items: list[Item] = []
    held_out = [held_out] if isinstance(held_out, str) else held_out
    for table in [tables] if isinstance(tables, Mapping) else tables:
        strange = [key for key in table if key not in TABLE_KEYS]
        if strange or not {"file", "kind"} <= set(table):
            raise InputError(
                f"a table has file and kind, and may have {', '.join(TABLE_KEYS[2:])}"
                + (f"; there is no {strange[0]}" if strange else "")
            )
        tests = read_table(pathlib.Path(folder) / table["file"], table["kind"])
        if "name" in table:
            if len(tests) != 1:
                raise InputError(f"{table['file']}: {len(tests)} tests cannot all be called {table['name']}")
            tests[0].name = table["name"]
        for quantity, pair in table.get("scatter", {}).items():
            if np.shape(pair) != (2,):
                raise InputError(f"scatter: {quantity} = {pair!r}: give two numbers, absolute and as a share, as (3, 0.05)")
        scatter = {q: tuple(float(x) for x in s) for q, s in table.get("scatter", {}).items()}
        for quantity in scatter:
            if quantity not in SCATTER[table["kind"]]:
                raise InputError(
                    f"scatter: a {table['kind']} test compares {', '.join(SCATTER[table['kind']])}, not {quantity}"
                )
        if any(len(s) != 2 or not (0 <= min(s) and 0 < max(s) < np.inf) for s in scatter.values()):
            raise InputError("scatter: a deviation has two numbers, absolute and as a share, from 0 on and not both of them 0")
        for quantity, (absolute, share) in scatter.items():
            if share > 1 or quantity in FRACTIONS and absolute > LARGEST_SCATTER:
                raise InputError(
                    f"scatter: {quantity} = {absolute:g}, {share:g}: shares and deviations of {', '.join(FRACTIONS)} are "
                    f"fractions, not per cent, up to 1 and {LARGEST_SCATTER:g}"
                )
        weight = table.get("weight", 1.0)
        if isinstance(weight, str) or not 0 <= weight <= HEAVIEST:
            raise InputError(f"weight = {weight!r}: it must be a number from 0 to {HEAVIEST:g}")
        there = [test.name for test in tests]
        only = table.get("only", there)
        only = [only] if isinstance(only, str) else only
        strange = [one for one in only if one not in there]
        if strange:
            raise InputError(f"only: there is no test {strange[0]} in {table['file']}; there are {', '.join(there)}")
        for test in tests:
            if test.name in only:
                use = use_of(test, table.get("first"), table.get("last"), scatter, table.get("branch", "all"))
                items.append(Item(test, use, float(weight)))
    names = [item.test.name for item in items]
    for held in held_out:
        if held not in names:
            raise InputError(f"held_out: there is no test {held}; there are {', '.join(names)}")
    for item in items:
        item.test.held_out = item.test.name in held_out
    double = next((n for i, n in enumerate(names) if n in names[:i]), None)
    if double:
        raise InputError(
            f"two tests are called {double}; rename one of them, because held-out tests are chosen by name"
        )
    if others.get("start"):
        file = pathlib.Path(folder) / str(others["start"])
        others["start"] = file if file.is_file() else others["start"]
    return Task(name=name, items=items, **others)


def read_task(path: str | os.PathLike) -> Task:
    """The task of a TOML file; paths in it begin in its folder. Keys: those of ``make_task`` and of ``Task``."""
    path = pathlib.Path(path)
    try:
        content = tomllib.loads(text_of_bytes(path.read_bytes())[0])
    except OSError as problem:
        raise InputError(f"{path} cannot be read: {problem.strerror}") from problem
    except tomllib.TOMLDecodeError as problem:
        raise InputError(f"{path}: {problem}") from problem
    for key in content:
        if key not in KEYS:
            raise InputError(f"{path}: there is no key {key}; there are {', '.join(KEYS)}")
    if "tables" not in content:
        raise InputError(f"{path}: there is no [[tables]]")
    content.setdefault("name", path.stem)
    return make_task(tables=content.pop("tables"), folder=path.parent, **content)
