# SPDX-License-Identifier: MIT
"""Effective stresses of a test, and p and q as the library has them: by what heads say and by what the test holds."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from ..errors import InputError

SHEAR = ("drained", "undrained")
MOVES = 0.02  # share of the radial stress that u changes at least, if that shall tell anything
STAYS = 0.25  # share of the change of u that the radial stress may change where it is held
HELD = 0.15  # share by which a radial stress that is held may leave its median
BETTER = 0.5  # share of the spread of the usual p and q that another meaning leaves at most
MEAN, HALF_SUM = "(sigma_1 + 2 sigma_3)/3", "(sigma_1 + sigma_3)/2"
DIFFERENCE, HALF_DIFFERENCE = "sigma_1 - sigma_3", "(sigma_1 - sigma_3)/2"
# Meanings of p and q: share of q by which p lies above sigma_3, what q must be multiplied with. The first is the library's.
MEANINGS = {
    (MEAN, DIFFERENCE): (1 / 3, 1.0),
    (HALF_SUM, DIFFERENCE): (1 / 2, 1.0),
    (HALF_SUM, HALF_DIFFERENCE): (1.0, 2.0),
    (MEAN, HALF_DIFFERENCE): (2 / 3, 2.0),
}
ASK = "write effective stresses with a prime, as sigma_3' or p', and total ones as sigma_3_total"


def pore_pressure(
    kind: str, given: Mapping[str, tuple[str, np.ndarray]]
) -> tuple[np.ndarray | None, str, list[tuple[str, str]]]:
    """(pore pressure or None, what must be known of it, what was understood).

    given : what its head says (nothing, back: back pressure, excess) -> head and values. A back pressure alone is the pore
    pressure where water can leave.
    """
    titles = {state: title for state, (title, _) in given.items()}
    told = [(titles[state], f"not used: {titles['']} is the whole pore pressure") for state in given if state and "" in given]
    if "" in given:
        return given[""][1], "", told
    if {"back", "excess"} <= set(given):
        told.append((f"{titles['back']}, {titles['excess']}", "the pore pressure, as their sum"))
        return given["back"][1] + given["excess"][1], "", told
    if "excess" in given:
        return given["excess"][1], ", the excess pore pressure, so that the stresses must count from the back pressure", told
    if "back" in given and kind != "undrained":
        return given["back"][1], "", told
    return None, "", [(title, "not read: of an undrained test it is not the pore pressure") for title in titles.values()]


def effective_stresses(
    where: str,
    kind: str,
    stresses: Mapping[tuple[str, str], tuple[str, np.ndarray]],
    columns: dict[str, np.ndarray],
    since: str = "",
) -> list[tuple[str, str]]:
    """Adds the effective stresses to the columns of a test; what was understood for that.

    stresses : (quantity, what its head says: effective, total or nothing) -> head and values. since : of ``pore_pressure``.
    A total stress without a pore pressure is left out.
    """
    told, u, taken = [], columns.get("u"), []
    unsaid = [quantity for quantity, state in stresses if not state and (quantity, "effective") not in stresses]
    state, reason = _unsaid(where, kind, stresses, unsaid, columns)
    for quantity in dict.fromkeys(quantity for quantity, _ in stresses):
        unsaid_is = state if quantity in unsaid else "total"
        found = {said or unsaid_is: given for (name, said), given in stresses.items() if name == quantity}
        best = next(said for said in ("effective", "total", "cell") if said in found)
        title, values = found.pop(best)
        kind_of = best.replace("cell", "total")
        told += [(other, f"not used: {title} is the {kind_of} one") for other, _ in found.values()]
        if best == "effective":
            columns[quantity] = values
        elif u is None:
            told.append((title, "not read: a total stress, and the table has no pore pressure"))
        else:
            columns[quantity] = values - u
            taken += [] if (quantity, "") in stresses else [title]
    off = f": u is taken off{since}" if state == "total" and u is not None else ""
    if reason:
        told.append((", ".join(stresses[quantity, ""][0] for quantity in unsaid), f"{state}, because {reason}{off}"))
    if taken:
        told.append((", ".join(taken), f"total: u is taken off{since}"))
    return told


def _unsaid(
    where: str,
    kind: str,
    stresses: Mapping[tuple[str, str], tuple[str, np.ndarray]],
    unsaid: list[str],
    columns: Mapping[str, np.ndarray],
) -> tuple[str, str]:
    """(effective or total, why) of stresses whose heads say neither; the reason is empty where none is needed."""
    said, u, q = {state for _, state in stresses} & {"effective", "total"}, columns.get("u"), columns.get("q")
    titles = ", ".join(stresses[quantity, ""][0] for quantity in unsaid)
    values = {quantity: stresses[quantity, ""][1] for quantity in unsaid}
    if not unsaid or not said and (u is None or not np.any(u)):
        return "effective", ""
    if len(said) == 2:
        raise InputError(f"{where}: {titles} beside effective and total stresses: which are they? {ASK}")
    if said:
        return ("total", "others are called effective") if "effective" in said else ("effective", "others are called total")
    if any(v[0] <= u[0] for v in values.values()):
        return "effective", "less than the pore pressure u"
    cell = stresses.get(("sigma_r", "cell"), ("", None))[1]
    moves = np.ptp(u) > MOVES * max(float(np.max(np.abs(v))) for v in values.values())
    if cell is not None and q is not None and "p" in values:
        total, effective = (min(_size(values["p"] + part - k * q - cell) for k, _ in MEANINGS.values()) for part in (0.0, u))
        return ("total" if total < effective else "effective"), "so p and q fit the cell pressure"
    if cell is not None:
        return "total", "beside a cell pressure"
    if moves and kind in SHEAR and ("sigma_r" in values or "p" in values and q is not None):
        radial = [values["sigma_r"]] if "sigma_r" in values else [values["p"] - k * q for k, _ in MEANINGS.values()]
        total, effective = (min(float(np.ptp(r + part)) for r in radial) for part in (0.0, u))
        what = "sigma_3" if "sigma_r" in values else "the radial stress of p and q"
        if total < STAYS * np.ptp(u) and total < effective:
            return "total", f"{what} stays while u changes"
        if effective < STAYS * np.ptp(u):
            return "effective", f"{what} + u, the cell pressure, stays"
    elif not moves or kind in ("oedometer", "isotropic", "stiffness"):
        return "total", "no head says effective and the table has a pore pressure u"
    raise InputError(
        f"{where}: are {titles} total or effective? The pore pressure u changes, and nothing in the table tells it; {ASK}"
    )


def _size(values: np.ndarray) -> float:
    return float(np.sqrt(np.mean(values**2)))


def usual_p_and_q(where: str, kind: str, columns: dict[str, np.ndarray]) -> list[tuple[str, str]]:
    """Brings p and q of a shear test to (sigma_1 + 2 sigma_3)/3 and sigma_1 - sigma_3; what was understood for that.

    Their meaning shows where the radial stress is given, or held: in a drained test the effective one, in an undrained test
    with a pore pressure the total one.
    """
    told: list[tuple[str, str]] = []
    if kind not in SHEAR or "q" not in columns:
        return told
    if {"sigma_a", "sigma_r"} <= set(columns):
        difference = columns["sigma_a"] - columns["sigma_r"]
        off = {factor: float(np.linalg.norm(factor * columns["q"] - difference)) for factor in (1.0, 2.0)}
        factor = min(off, key=off.get)
        if off[factor] > HELD * np.linalg.norm(difference):
            raise InputError(
                f"{where}: q is neither {DIFFERENCE} nor half of it; are both stresses effective, or both total?"
            )
        if factor == 2:
            columns["q"] = 2 * columns["q"]
            told.append(("q", f"{HALF_DIFFERENCE}, because both stresses are given: doubled"))
    if "p" not in columns:
        return told
    p, q = columns["p"], columns["q"]
    if "sigma_r" in columns:
        held, reason = columns["sigma_r"], "so says sigma_3"
    elif kind == "drained":
        held, reason = 0.0, "so the radial stress is held, as in a drained test"
    elif "u" in columns:
        held, reason = -columns["u"], "so the cell pressure, the radial stress + u, is held"
    else:
        return [*told, ("p, q", f"{MEAN} and {DIFFERENCE}, as no pore pressure or radial stress shows another meaning")]
    spread = {}
    for meaning, (share, _) in MEANINGS.items():
        rest = p - share * q - held
        spread[meaning] = _size(rest if "sigma_r" in columns else rest - np.mean(rest))
    usual, best = next(iter(MEANINGS)), min(spread, key=spread.get)
    middle = abs(float(np.median(p - MEANINGS[best][0] * q)))
    if "sigma_r" in columns and spread[best] > HELD * _size(columns["sigma_r"]):
        raise InputError(f"{where}: p, q and sigma_3 contradict each other; are p and sigma_3 both effective, or both total?")
    if best == usual or spread[best] > min(BETTER * spread[usual], HELD * middle) or spread[usual] < MOVES * middle:
        return told
    share, factor = MEANINGS[best]
    columns["q"] = factor * q
    columns["p"] = p - share * q + columns["q"] / 3
    told.append(("p, q", f"p = {best[0]} and q = {best[1]}, because {reason}: turned into {MEAN} and {DIFFERENCE}"))
    return told
