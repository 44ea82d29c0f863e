# SPDX-License-Identifier: MIT
"""A law of anybody, called through its door: a UMAT, or a user-defined soil model of PLAXIS.

Vectors here have the components 11, 22, 33, 12, 13, 23, tension positive, engineering shear; the law's own order is a
matter of this module. Every array that the law gets stands between guards, and what it must not change is compared.
"""

from __future__ import annotations

import ctypes
import multiprocessing
import os
import pathlib
import signal
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

#: Places of 11, 22, 33, 12, 13, 23 in the law's vectors.
ORDERS = {"abaqus": [0, 1, 2, 3, 4, 5], "kratos": [0, 1, 2, 3, 5, 4]}
SYMBOLS = {"umat": "umat_", "udsm": "user_mod_"}
NAME = b"LAW".ljust(80)
_GUARD = 64  # doubles before and behind every array
_MARK = -7.077e273
_INITIALISE, _STRESSES, _STIFFNESS, _HOW_MANY, _ATTRIBUTES = 1, 2, 3, 4, 5


@dataclass
class Answer:
    """What one call gave. ``refused``: PNEWDT below 1 or NaN (IABORT of a UDSM), or a stress that is not finite."""

    stress: np.ndarray
    state: np.ndarray
    tangent: np.ndarray
    pnewdt: float
    broken: tuple[str, ...] = ()  # what it changed and must not

    @property
    def cut(self) -> bool:
        return not self.pnewdt >= 1.0

    @property
    def finite(self) -> bool:
        return bool(np.isfinite(self.stress).all() and np.isfinite(self.state).all())

    @property
    def refused(self) -> bool:
        return self.cut or not self.finite


@dataclass(frozen=True)
class Told:
    """What a model of PLAXIS says of itself (IDTASK 4 and 5): 1 or 0, but for the number of state variables."""

    n_state: int
    non_symmetric: int
    tangent: int


class Guarded:
    """An array of doubles with guards on both sides."""

    def __init__(self, values: Any):
        values = np.atleast_1d(np.asarray(values, dtype=float))
        self._room = np.full(values.size + 2 * _GUARD, _MARK)
        self.values = self._room[_GUARD : _GUARD + values.size]
        self.values[:] = values.ravel()
        self.before = self.values.copy()

    @property
    def pointer(self) -> ctypes.c_void_p:
        return ctypes.c_void_p(self.values.ctypes.data)

    @property
    def intact(self) -> bool:
        return bool((self._room[:_GUARD] == _MARK).all() and (self._room[-_GUARD:] == _MARK).all())

    @property
    def changed(self) -> bool:
        return not np.array_equal(self.values, self.before, equal_nan=True)


MOST_PROPS = 50  # Of User_Mod.


@dataclass
class Law:
    """A law: where it is and how it is called. It is loaded by the first call, in the process that makes it."""

    library: str
    kind: str = "umat"
    props: Sequence[float] = ()
    n_state: int = 0
    symbol: str = ""
    shear_order: str = "abaqus"
    tensor_shear: bool = False  # strains 12, 13, 23 are half the engineering ones
    components: int = 6
    suction: float = 0.0
    start_state: Sequence[float] | None = None
    _function: Any = field(default=None, repr=False, compare=False)

    def __post_init__(self) -> None:
        if self.kind not in SYMBOLS:
            raise ValueError(f"kind is {self.kind!r}; allowed are umat and udsm")
        if self.kind == "udsm":
            if len(self.props) > MOST_PROPS:
                raise ValueError(f"props has {len(self.props)} values; User_Mod passes at most {MOST_PROPS}")
            if self.components != 6:
                raise ValueError(f"components is {self.components}; User_Mod has 6")
            self.shear_order = "kratos"
        self.symbol = self.symbol or SYMBOLS[self.kind]
        if "/" in self.library or pathlib.Path(self.library).exists():
            self.library = str(pathlib.Path(self.library).resolve())

    def like(self, **changes: Any) -> Law:
        """The same law with other attributes."""
        own = {k: v for k, v in self.__dict__.items() if k != "_function"}
        return Law(**{**own, **changes})

    def begin(self) -> np.ndarray:
        """State variables before the first call."""
        return np.zeros(self.n_state) if self.start_state is None else np.array(self.start_state, dtype=float)

    def load(self) -> Any:
        if self._function is None:
            library = ctypes.CDLL(self.library)
            self._function = getattr(library, self.symbol)
            self._function.restype = None
        return self._function

    def call(
        self,
        stress: np.ndarray,
        state: np.ndarray,
        d_strain: np.ndarray,
        strain: np.ndarray | None = None,
        rotation: np.ndarray | None = None,
        dt: float = 1.0,
        time: float = 0.0,
    ) -> Answer:
        """One increment. The stress is that before it; what is returned are new arrays."""
        law = self._call_umat if self.kind == "umat" else self._call_udsm
        strain = np.zeros(6) if strain is None else strain
        return law(stress, state, d_strain, strain, np.eye(3) if rotation is None else rotation, dt, time)

    def _places(self) -> list[int]:
        return ORDERS[self.shear_order][: self.components]

    def _to_law(self, vector: np.ndarray, strain: bool) -> np.ndarray:
        own = np.array(vector, dtype=float)[self._places()]
        if strain and self.tensor_shear:
            own[3:] *= 0.5
        return own

    def _from_law(self, vector: np.ndarray, start: np.ndarray) -> np.ndarray:
        out = np.array(start, dtype=float)
        out[self._places()] = vector
        return out

    def _tangent(self, values: np.ndarray) -> np.ndarray:
        n = len(self._places())
        own = values.reshape(n, n, order="F").copy()
        if self.tensor_shear:
            own[:, 3:] *= 0.5
        full = np.zeros((6, 6))
        full[np.ix_(self._places(), self._places())] = own
        return full

    def _call_umat(self, stress, state, d_strain, strain, rotation, dt, time) -> Answer:
        n = self.components
        arrays = {
            "STRESS": Guarded(self._to_law(stress, False)),
            "STATEV": Guarded(state if len(state) else [0.0]),
            "DDSDDE": Guarded(np.zeros(n * n)),
            "energies": Guarded(np.zeros(4)),
            "DDSDDT": Guarded(np.zeros(n)),
            "DRPLDE": Guarded(np.zeros(n)),
            "DRPLDT": Guarded([0.0]),
            "PNEWDT": Guarded([1.0]),
        }
        kept = {
            "STRAN": Guarded(self._to_law(strain, True)),
            "DSTRAN": Guarded(self._to_law(d_strain, True)),
            "TIME": Guarded([time, time]),
            "DTIME": Guarded([dt]),
            "TEMP": Guarded([0.0]),
            "DTEMP": Guarded([0.0]),
            "PREDEF": Guarded([self.suction]),
            "DPRED": Guarded([0.0]),
            "PROPS": Guarded(self.props if len(self.props) else [0.0]),
            "COORDS": Guarded(np.zeros(3)),
            "DROT": Guarded(np.asarray(rotation).ravel(order="F")),
            "CELENT": Guarded([1.0]),
            "DFGRD0": Guarded(np.eye(3)),
            "DFGRD1": Guarded(np.eye(3)),
        }
        a, k = arrays, kept
        energies = a["energies"].values.ctypes.data
        one = [ctypes.c_int(i) for i in (3, n - 3, n, self.n_state, len(self.props), 1, 1, 1, 1, 1)]
        steps = (ctypes.c_int * 4)(1, 1, 1, 1)
        by = [ctypes.byref(i) for i in one]
        self.load()(
            a["STRESS"].pointer,
            a["STATEV"].pointer,
            a["DDSDDE"].pointer,
            *[ctypes.c_void_p(energies + 8 * i) for i in range(4)],
            a["DDSDDT"].pointer,
            a["DRPLDE"].pointer,
            a["DRPLDT"].pointer,
            *[k[x].pointer for x in ("STRAN", "DSTRAN", "TIME", "DTIME", "TEMP", "DTEMP", "PREDEF", "DPRED")],
            ctypes.c_char_p(NAME),
            *by[:4],
            k["PROPS"].pointer,
            by[4],
            k["COORDS"].pointer,
            k["DROT"].pointer,
            a["PNEWDT"].pointer,
            *[k[x].pointer for x in ("CELENT", "DFGRD0", "DFGRD1")],
            *by[5:9],
            steps,
            by[9],
            ctypes.c_size_t(80),
        )
        broken = [f"{name} beyond its end" for name, x in {**arrays, **kept}.items() if not x.intact]
        broken += [name for name, x in kept.items() if x.changed]
        if not self.n_state and arrays["STATEV"].changed:
            broken.append("STATEV beyond its end")
        return Answer(
            self._from_law(arrays["STRESS"].values, stress),
            arrays["STATEV"].values[: self.n_state].copy(),
            self._tangent(arrays["DDSDDE"].values),
            float(arrays["PNEWDT"].values[0]),
            tuple(broken),
        )

    def _call_udsm(self, stress, state, d_strain, strain, rotation, dt, time) -> Answer:
        sig0 = np.zeros(20)
        sig0[:6] = self._to_law(stress, False)
        d_eps = np.zeros(12)
        d_eps[:6], d_eps[6:] = self._to_law(d_strain, True), self._to_law(strain, True)
        door = _PlaxisDoor(self, sig0, state, d_eps, dt, time)
        if not np.any(np.asarray(state) != 0.0):
            door.ask(_INITIALISE)
        door.ask(_STRESSES)
        door.ask(_STIFFNESS)
        return Answer(
            self._from_law(door.free["Sig"].values, stress),
            door.free["StVar"].values[: self.n_state].copy(),
            self._tangent(door.free["D"].values),
            0.5 if door.aborted else 1.0,
            door.broken,
        )

    def told(self) -> Told | None:
        """What a model of PLAXIS says of itself; None of a UMAT."""
        if self.kind != "udsm":
            return None
        door = _PlaxisDoor(self, np.zeros(20), np.zeros(max(self.n_state, 1)), np.zeros(12), 0.0, 0.0)
        door.ask(_HOW_MANY)
        n_state = door.numbers[1].value
        door.ask(_ATTRIBUTES)
        return Told(n_state, door.numbers[2].value, door.numbers[5].value)


class _PlaxisDoor:
    """The arguments of User_Mod for one point."""

    def __init__(self, law: Law, sig0: np.ndarray, state: np.ndarray, d_eps: np.ndarray, dt: float, time: float):
        n = len(law.props)
        self.law = law
        self.kept = {
            "Props": Guarded(np.pad(np.asarray(law.props, dtype=float), (0, MOST_PROPS - n))),
            "Sig0": Guarded(sig0),
            "dEps": Guarded(d_eps),
        }
        self.free = {
            "StVar0": Guarded(state if len(state) else [0.0]),
            "D": Guarded(np.zeros(36)),
            "Sig": Guarded(np.zeros(6)),
            "StVar": Guarded(np.zeros(max(law.n_state, 1))),
        }
        self._scalars = [Guarded([x]) for x in (0.0, 0.0, 0.0, time, dt)]
        self._water = [Guarded([0.0]) for _ in range(3)]  # pressure before, bulk modulus, pressure after
        # ipl, nStat, NonSym, iStrsDep, iTimeDep, iTang, iPrjDir, iPrjLen, iAbort
        self.numbers = [ctypes.c_int(x) for x in (0, law.n_state, 0, 0, 0, 0, 0, 0, 0)]
        self.aborted = False

    def ask(self, task: int) -> None:
        before = [ctypes.c_int(x) for x in (task, 1, 0, 1, 1, 1, 1)]
        kept, free, (swp0, bulk, swp) = self.kept, self.free, self._water
        self.law.load()(
            *[ctypes.byref(x) for x in before],
            *[x.pointer for x in self._scalars],
            kept["Props"].pointer,
            kept["Sig0"].pointer,
            swp0.pointer,
            free["StVar0"].pointer,
            kept["dEps"].pointer,
            free["D"].pointer,
            bulk.pointer,
            free["Sig"].pointer,
            swp.pointer,
            free["StVar"].pointer,
            *[ctypes.byref(x) for x in self.numbers],
        )
        self.aborted = self.aborted or self.numbers[-1].value != 0

    @property
    def broken(self) -> tuple[str, ...]:
        beyond = [f"{name} beyond its end" for name, x in {**self.kept, **self.free}.items() if not x.intact]
        if not self.law.n_state and self.free["StVar"].changed:
            beyond.append("StVar beyond its end")
        return (*beyond, *[name for name, x in self.kept.items() if x.changed])


class Ended(Exception):
    """The process of a call ended without an answer; the text says how."""


def apart(function: Callable[..., Any], *arguments: Any, seconds: float = 120.0) -> Any:
    """What a function returns, run in a process of its own: a law that keeps something between calls, stops or crashes
    touches nobody else. Raises Ended where it does not come back."""
    context = multiprocessing.get_context("fork")
    here, there = context.Pipe(duplex=False)

    def work() -> None:
        try:
            silence = os.open(os.devnull, os.O_WRONLY)
            os.dup2(silence, 1)
            os.dup2(silence, 2)
            there.send((True, function(*arguments)))
        except Exception as problem:  # the parent raises it again
            there.send((False, problem))
        there.close()
        os._exit(0)

    child = context.Process(target=work)
    child.start()
    there.close()
    try:
        if not here.poll(seconds):
            raise Ended(f"no answer within {seconds:g} s")
        good, value = here.recv()
    except EOFError:
        child.join()
        code = child.exitcode or 0
        how = f"signal {signal.Signals(-code).name}" if code < 0 else f"it stopped the process (exit code {code})"
        raise Ended(how) from None
    finally:
        if child.is_alive():
            child.kill()
        child.join()
    if not good:
        raise value
    return value
