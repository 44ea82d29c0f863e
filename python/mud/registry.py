# SPDX-License-Identifier: MIT
"""Parameters and state variables by name, as the library's registry lists them."""

from __future__ import annotations

import dataclasses
import difflib
from collections.abc import Iterator, Mapping
from ctypes import byref, c_double

import numpy as np

from . import _native
from ._native import CONSTANTS as C
from .errors import UnknownName


@dataclasses.dataclass(frozen=True)
class Parameter:
    """A material parameter (entry of PROPS). Bounds and default in ``unit``, for p_atm = 101.325 kPa."""

    index: int  #: place in PROPS, from 0
    name: str
    symbol: str
    unit: str  #: "1" if it has none
    lower: float
    upper: float
    default: float
    origin: str  #: paper, mended, rebuilt, numerical or ours
    meaning: str
    options: Mapping[str, float]  #: words that stand for a value; empty if the parameter takes numbers


@dataclasses.dataclass(frozen=True)
class StateVariable:
    """A state variable (entry of STATEV)."""

    index: int  #: place in STATEV, from 0
    name: str
    symbol: str
    unit: str
    origin: str
    meaning: str


class Registry(Mapping):
    """A list of the library: entries by name, in the library's order; upper and lower case do not matter."""

    def __init__(self, what: str, entries: list):
        self._what, self._entries = what, {entry.name: entry for entry in entries}
        self._lower = {name.lower(): name for name in self._entries}

    def __getitem__(self, name: str):
        if name.lower() not in self._lower:
            near = difflib.get_close_matches(name.lower(), self._lower, 1, 0.0)
            raise UnknownName(f"there is no {self._what} {name}; the nearest is {self._lower[near[0]]}")
        return self._entries[self._lower[name.lower()]]

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and name.lower() in self._lower

    def __iter__(self) -> Iterator[str]:
        return iter(self._entries)

    def __len__(self) -> int:
        return len(self._entries)

    def table(self) -> str:
        """The list as lines of text: name, unit, meaning."""
        width = max(map(len, self._entries))
        return "\n".join(f"{e.name:{width}}  [{e.unit}]  {e.meaning}" for e in self._entries.values())


def _texts(which: int, index: int, *fields: str) -> list[str]:
    return [_native.text_of(_native.mud.mud_text, which, index, C[field])[1] for field in fields]


def _options(index: int) -> dict[str, float]:
    words, value = {}, c_double()
    while True:
        code, word = _native.text_of(_native.mud.mud_option, index, len(words), byref(value))
        if code != 0:
            return words
        words[word] = value.value


def _parameters() -> Registry:
    entries, numbers = [], [c_double() for _ in range(3)]
    for i in range(_native.mud.mud_count(C["MUD_PROPS"])):
        name, symbol, unit, origin, meaning = _texts(
            C["MUD_PROPS"], i, "MUD_NAME", "MUD_SYMBOL", "MUD_UNIT", "MUD_ORIGIN", "MUD_MEANING"
        )
        _native.mud.mud_bounds(C["MUD_PROPS"], i, *map(byref, numbers))
        entries.append(Parameter(i, name, symbol, unit, *(n.value for n in numbers), origin, meaning, _options(i)))
    return Registry("parameter", entries)


def _states() -> Registry:
    fields = ("MUD_NAME", "MUD_SYMBOL", "MUD_UNIT", "MUD_ORIGIN", "MUD_MEANING")
    return Registry(
        "state variable",
        [StateVariable(i, *_texts(C["MUD_STATEV"], i, *fields)) for i in range(_native.mud.mud_count(C["MUD_STATEV"]))],
    )


#: Material parameters by name.
parameters: Registry = _parameters()
#: State variables by name.
states: Registry = _states()


def state(statev: np.ndarray, name: str) -> np.ndarray:
    """A view of a state variable in STATEV of shape (..., n_states): shape (...), or (..., 6) for a tensor.

    ``name`` is that of an entry ("void_ratio", "fabric_11") or of a tensor ("fabric": components 11, 22, 33, 12, 13, 23).
    """
    if name in states:
        return statev[..., states[name].index]
    if f"{name}_11" in states:
        first = states[f"{name}_11"].index
        return statev[..., first : first + 6]
    return statev[..., states[name].index]  # raises with the nearest name
