# SPDX-License-Identifier: MIT
"""A material: named parameters, checked once, and updates of points made of it."""

from __future__ import annotations

import ctypes
import os
import pathlib
import threading
from collections.abc import Mapping
from ctypes import byref, c_double

import numpy as np

from . import _native, namelist
from .errors import InputError, Unchangeable, fault_of
from .points import Points, need, tangent_kind
from .registry import parameters, states

_TENSION = ", tension: tension is positive here"
_SUCTION = states["suction"].index
_STATE, _SLOPES = slice(6, 6 + len(states)), slice(6 + len(states), None)
VOID_RATIOS = 0.01, 5.0  # void ratios that the library integrates at [-]
_BLOCKS = 50  # doubles of mud_blocks: 36, 6, 6, 1, 1
_REPORT = ctypes.sizeof(_native.Report)


class Response:
    """Answer of one update, in the library's convention: tension positive, components 11, 22, 33, 12, 13, 23.

    Blocks are None where no tangent was asked for.
    """

    __slots__ = ("_blocks", "_report", "statev", "stress")

    def __init__(self, stress: np.ndarray, statev: np.ndarray, blocks: np.ndarray | None, report: bytes):
        self.stress = stress  #: (6,) effective stress [kPa]
        self.statev = statev  #: (n_states,)
        self._blocks, self._report = blocks, report

    def _part(self, first: int, last: int) -> np.ndarray | None:
        return None if self._blocks is None else self._blocks[first:last]

    @property
    def dsig_deps(self) -> np.ndarray | None:
        """(6, 6), [i, j] = d sigma'_i / d (engineering strain j) [kPa]."""
        return None if self._blocks is None else self._blocks[:36].reshape(6, 6).T

    @property
    def dsig_dpc(self) -> np.ndarray | None:
        """(6,) d sigma' / d suction [-]."""
        return self._part(36, 42)

    @property
    def dsw_deps(self) -> np.ndarray | None:
        """(6,) d S_w / d strain [-]."""
        return self._part(42, 48)

    @property
    def dsw_dpc(self) -> float | None:
        """d S_w / d suction [1/kPa]."""
        return None if self._blocks is None else float(self._blocks[48])

    @property
    def report(self) -> object:
        """mud_report of mud.h: n_rate, n_substep, pnewdt, ..."""
        return _native.Report.from_buffer_copy(self._report)


class _Workspace(threading.local):
    """Arrays of one update, and their addresses; every thread has its own."""

    def __init__(self):
        n = len(states)
        start, end, report = np.zeros(12 + n), np.zeros(6 + n + _BLOCKS), (ctypes.c_char * _REPORT)()
        inputs, outputs = start.ctypes.data, end.ctypes.data
        places = (slice(0, 6), (6,), "stress"), (_STATE, (n,), "statev"), (slice(6 + n, None), (6,), "dstrain")
        before = (inputs, inputs + 48, n, inputs + 48 + 8 * n)
        after = (outputs, outputs + 48, outputs + 48 + 8 * n, ctypes.addressof(report))
        self.all = start, places, before, after, end, report


_workspace = _Workspace()
_mud_update = _native.mud.mud_update


def material_folders() -> list[pathlib.Path]:
    """Folders in which materials are looked for by name: MUD_MATERIALS alone, or those of the package and of the tree."""
    named = os.environ.get("MUD_MATERIALS")
    if named:
        return [pathlib.Path(named)]
    return [
        folder
        for folder in (_native.PACKAGE / "materials", _native.SOURCE_TREE / "drivers" / "materials")
        if folder.is_dir()
    ][:1]


def materials() -> list[str]:
    """Names of the materials of the library."""
    return sorted(path.stem for folder in material_folders() for path in folder.glob("*.nml"))


def material_file(name: str | os.PathLike) -> pathlib.Path:
    """File of a material: ``name`` itself if it has a slash or ends in .nml, otherwise NAME.nml of the library."""
    text = os.fspath(name)
    if "/" in text or text.endswith(".nml"):
        return pathlib.Path(text)
    for folder in material_folders():
        if (folder / f"{text}.nml").exists():
            return folder / f"{text}.nml"
    raise InputError(
        f"there is no material {text}; the library has {', '.join(materials()) or 'none'}, and a file is named "
        "with its .nml"
    )


#: Keys of a material file that are no parameters: void ratios and stresses of the tests behind it.
TESTED = ("tested_e_min", "tested_e_max", "tested_p_min", "tested_p_max")


def _tested(path: pathlib.Path, name: str, value: float | str) -> float:
    if isinstance(value, str) or not value >= 0:
        raise InputError(f"{path}: {name} = {value!r} is not one number of 0 or more")
    return value


class Material(Points, Mapping):
    """Parameters of MUD by name; those not given have the library's default.

    >>> sand = Material("toyoura", e_0=0.735, memory_rule="classic")
    >>> sand["G_0"]
    125.0

    source : name of a material of the library, or a file ``*.nml``; None: the library's defaults.
    values : parameters by name, in the units of ``mud.parameters``; a word where the parameter has options.

    Raises ``InputError`` with the library's sentence for a value out of range, ``UnknownName`` with the nearest name for an
    unknown parameter.
    """

    _OWN = ("props", "title", "tested", "_storage", "_address", "_unused")

    def __init__(self, source: str | os.PathLike | None = None, /, **values: float | str):
        self.props = np.empty(len(parameters))  #: (n_parameters,) PROPS
        self.title = "defaults of the library"
        #: range of the tests behind the material, tested_e_min to tested_p_max [-, unit of p_atm], if its file has it
        self.tested: dict[str, float] = {}
        _native.mud.mud_default_props(self.props.ctypes.data, len(self.props))
        if source is not None:
            path = material_file(source)
            entries = namelist.read_material(path)
            self.title = str(entries.pop("name", path.stem))
            entries.pop("reference", None)
            self.tested = {name: _tested(path, name, entries.pop(name)) for name in TESTED if name in entries}
            try:
                self._set(entries)
            except InputError as problem:
                raise type(problem)(f"{path}: {problem}") from None
        self._set(values)
        self.props.flags.writeable = False
        self._storage = np.zeros((1, _native.mud.mud_prepared_size()))
        code, sentence = _native.text_of(
            _native.mud.mud_prepare,
            self.props.ctypes.data,
            len(self.props),
            self._storage.ctypes.data,
            self._storage.size,
        )
        if code != 0:
            raise fault_of(code, sentence)
        self._address = self._storage.ctypes.data
        # numbers of STATEV that no point of this material has, in the outputs of an update
        self._unused = slice(6 + _native.mud.mud_prepared_statev(self._address), 6 + len(states))

    def __setstate__(self, state: dict) -> None:
        self.__dict__.update(state)
        self._address = self._storage.ctypes.data  # of this copy

    def _set(self, values: Mapping[str, float | str]) -> None:
        for name, value in values.items():
            entry = parameters[name]
            if isinstance(value, str):
                if value.lower() not in entry.options:
                    allowed = ", ".join(entry.options) or "numbers"
                    raise InputError(f"{entry.name} = '{value}': {entry.meaning}; allowed: {allowed}")
                value = entry.options[value.lower()]
            elif value is not None and np.ndim(value) > 0:
                raise InputError(f"{entry.name} = {value!r} is not one number: {entry.meaning}")
            self.props[entry.index] = value

    def __setattr__(self, name: str, value: object) -> None:
        if name not in self._OWN:
            raise Unchangeable(
                f"a material does not change: sand.changed({name}={value!r}) gives another one"
                if name in parameters
                else f"a material has no attribute {name}; parameters are given as in sand.changed(G_0=50.0)"
            )
        super().__setattr__(name, value)

    def __setitem__(self, name: str, value: object) -> None:
        raise Unchangeable(f"a material does not change: sand.changed({parameters[name].name}={value!r}) gives another one")

    def __getattr__(self, name: str) -> float:
        if name in parameters:
            raise Unchangeable(f"parameters are read by their name in brackets: sand['{parameters[name].name}']")
        raise AttributeError(f"a material has no attribute {name}")

    def __getitem__(self, name: str) -> float:
        return float(self.props[parameters[name].index])

    def __iter__(self):
        return iter(parameters)

    def __len__(self) -> int:
        return len(parameters)

    def __repr__(self) -> str:
        told = ", ".join(f"{n}={v:g}" for n, v in self.items() if v != parameters[n].default)
        return f"Material({self.title!r}{', ' if told else ''}{told})"

    def changed(self, **values: float | str) -> Material:
        """The same material with other values of some parameters."""
        other = Material(**{**dict(self.items()), **values})
        other.title, other.tested = self.title, dict(self.tested)
        return other

    def group(self) -> str:
        """The material as a ``&material`` group of a case file: every parameter that is not the default."""
        lines = [f"   {name} = {value!r}" for name, value in self.tested.items()]
        lines += [f"   {name} = {value!r}" for name, value in self.items() if value != parameters[name].default]
        return "\n".join(["&material", f"   name = {namelist.quoted(self.title, namelist.LONGEST)}", *lines, "/", ""])

    def converted(self, factor: float) -> Material:
        """The same material in another unit of stress, ``factor`` of which make one of the present unit (0.001: MPa of kPa)."""
        if isinstance(factor, str) or not 0 < factor < np.inf:
            raise InputError(f"factor = {factor!r}: it is a number above 0, as 0.001 from kPa to MPa")
        props = self.props.copy()
        code = _native.mud.mud_convert_props(props.ctypes.data, len(props), factor)
        if code != 0:
            raise fault_of(code)
        other = Material(**dict(zip(parameters, props)))
        other.title = self.title
        other.tested = {name: value * (factor if "_p_" in name else 1) for name, value in self.tested.items()}
        return other

    def initial_state(
        self,
        stress: np.ndarray,
        suction: float = 0.0,
        void_ratio: float | None = None,
        saturation: float | None = None,
    ) -> tuple[np.ndarray, np.ndarray]:
        """Stress (6,) and STATEV (n_states,) of a point that begins.

        stress : (6,) effective stress [kPa], tension positive; a mean within p_atm/100 of zero is lifted to p_min, more
            tension is refused. What else is doubtful about a start (umat/README.md) is told on standard error.
        suction : p_a - p_w [kPa].
        void_ratio : [-]; None: e_0 of the material.
        saturation : [-], with hysteresis; None: on the main drying curve.
        """
        start = np.array(stress, dtype=float)
        need(start, (6,), "stress")
        statev = np.zeros(len(states))
        code, sentence = _native.text_of(
            _native.mud.mud_init,
            self._address,
            start.ctypes.data,
            suction,
            0.0 if void_ratio is None else void_ratio,
            0.0 if saturation is None else saturation,
            statev.ctypes.data,
            len(statev),
        )
        if code != 0:
            raise fault_of(code, sentence)
        if _TENSION in sentence:  # the library only warns
            raise InputError(sentence.removeprefix("warning: "))
        return start, statev

    def update(
        self,
        stress: np.ndarray,
        statev: np.ndarray,
        dstrain: np.ndarray,
        suction: float | None = None,
        tangent: str | None = None,
    ) -> Response:
        """Integrates one increment of strain and suction; the arguments are not changed.

        stress : (6,) [kPa]; statev : (n_states,); dstrain : (6,) engineering strain [-]; all tension positive.
        suction : at the end [kPa], where it begins statev tells; None: it does not change.
        tangent : None, "elastic", "continuum" or "consistent".

        Raises ``InputError`` or ``IncrementError``.
        """
        kind = tangent_kind(tangent)
        start, places, before, after, end, report = _workspace.all
        for given, (place, shape, name) in zip((stress, statev, dstrain), places):
            if (given.shape if type(given) is np.ndarray else np.shape(given)) != shape:
                raise InputError(f"{name} has the shape {np.shape(given)}, needed is {shape}")
            start[place] = given
        if suction is None:
            suction = start[6 + _SUCTION]
        code = _mud_update(self._address, *before, suction, kind, *after)
        if code != 0:
            raise fault_of(code, report=_native.Report.from_buffer_copy(report))
        end = end.copy()
        end[self._unused] = 0.0
        return Response(end[:6], end[_STATE], end[_SLOPES] if kind else None, bytes(report))

    def save_increment(
        self,
        path: str | os.PathLike,
        stress: np.ndarray,
        statev: np.ndarray,
        dstrain: np.ndarray,
        suction: float | None = None,
        tangent: str | None = "consistent",
        origin: str = "",
    ) -> None:
        """Writes an increment, the arguments of ``update``, to a new file: a case that mud_triax repeats bit by bit."""
        arrays = [np.ascontiguousarray(a, dtype=float) for a in (stress, statev, dstrain)]
        for array, shape, name in zip(arrays, ((6,), (len(states),), (6,)), ("stress", "statev", "dstrain")):
            need(array, shape, name)
        code, sentence = _native.text_of(
            _native.mud.mud_save_increment,
            os.fsencode(path),
            origin.encode(),
            self._address,
            arrays[0].ctypes.data,
            arrays[1].ctypes.data,
            len(states),
            arrays[2].ctypes.data,
            arrays[1][_SUCTION] if suction is None else suction,
            tangent_kind(tangent),
        )
        if code != 0:
            raise fault_of(code, sentence)

    def saturation(self, suction: np.ndarray | float, void_ratio: np.ndarray | float) -> np.ndarray:
        """Degree of saturation [-] at suctions [kPa] and void ratios [-]; the shapes are broadcast together."""
        suctions, ratios = np.broadcast_arrays(np.asarray(suction, dtype=float), np.asarray(void_ratio, dtype=float))
        lower, upper = VOID_RATIOS
        wrong = ratios[~((ratios >= lower) & (ratios <= upper))]
        if wrong.size:
            raise InputError(f"void_ratio is {wrong[0]:g}, allowed {lower:g} to {upper:g}; it is no per cent")
        answer, value = np.empty(suctions.shape), c_double()
        for place in np.ndindex(suctions.shape):
            code = _native.mud.mud_saturation(
                self._address, suctions[place], ratios[place], byref(value), None, None
            )
            if code != 0:
                raise fault_of(code)
            answer[place] = value.value
        return answer
