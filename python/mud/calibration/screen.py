# SPDX-License-Identifier: MIT
"""Tests that fail under every set of parameters: cut where they stop, or refused, before the fit."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence

import numpy as np

from ..errors import InputError, MudError
from ..material import Material
from .simulation import SETTINGS, simulate
from .tables import FEWEST_ROWS
from .task import Item, Task
from .variables import parameters_of

LEAST_SHARE = 0.3  # of the rows that must be left of a test that is cut


@dataclasses.dataclass
class Screened:
    """What is left of a task, and what was done to its tests."""

    task: Task
    notes: list[str]


def screen(task: Task, sets: Sequence[Mapping[str, float]]) -> Screened:
    """Runs every fitted test under a few sets of variables until one brings it to its end. A test that no set brings there is
    cut behind the last row that one reached, or refused where too little is left.

    Raises ``InputError`` if no test is left.
    """
    materials = []
    for values in sets:
        try:
            parameters = parameters_of({**task.fixed_variables, **values}, task.base)
            materials.append(Material(**{**parameters, **SETTINGS}))
        except MudError:  # the set is refused: the others tell
            continue
    items, notes = [], []
    for item in task.items:
        kept, note = (item, "") if item.test.held_out else _screened(item, materials)
        items += [kept] if kept else []
        notes += [note] if note else []
    if not any(not item.test.held_out for item in items):
        raise InputError("no test can be fitted. " + " ".join(notes))
    if not notes:
        return Screened(task, notes)
    return Screened(dataclasses.replace(task, items=items), notes)


def _screened(item: Item, materials: Sequence[Material]) -> tuple[Item | None, str]:
    """The test as it may be fitted, and what was done to it."""
    rows, furthest, reason = item.use.rows, 0, "no set of parameters is allowed"
    for material in materials:
        answer = simulate(material, item.test, item.use)
        good = np.all([np.isfinite(answer.columns[q]) for q in item.use.scatter], axis=0)
        reached = len(rows) if good.all() else int(np.argmin(good))
        if reached == len(rows):
            return item, ""
        if reached >= furthest:
            furthest, reason = reached, answer.stopped
    name = item.test.name
    if furthest >= max(FEWEST_ROWS[item.test.kind], LEAST_SHARE * len(rows)):
        use = dataclasses.replace(item.use, rows=rows[:furthest])
        return (
            dataclasses.replace(item, use=use),
            f"{name} is cut behind row {furthest} of {len(rows)}: no set of parameters that was tried comes further ({reason}).",
        )
    return None, (
        f"{name} is left out: under every set of parameters that was tried it stops after {furthest} of {len(rows)} rows "
        f"({reason}). `first` and `last` of its table choose the rows that count."
    )
