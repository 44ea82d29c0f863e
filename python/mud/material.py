# SPDX-License-Identifier: MIT
"""A material: named parameters, checked once, and updates of points made of it."""

from __future__ import annotations

import dataclasses
import os
import pathlib
from collections.abc import Mapping
from ctypes import byref, c_double

import numpy as np

from . import _native, namelist
from ._native import CONSTANTS as C
from .errors import InputError, fault_of
from .registry import parameters, states

TANGENTS = {
    None: "MUD_TANGENT_NONE",
    "elastic": "MUD_TANGENT_ELASTIC",
    "continuum": "MUD_TANGENT_CONTINUUM",
    "consistent": "MUD_TANGENT_CONSISTENT",
}


@dataclasses.dataclass
class Response:
    """Answer of one update, in the library's convention: tension positive, components 11, 22, 33, 12, 13, 23.

    Blocks are None where no tangent was asked for.
    """

    stress: np.ndarray  #: (6,) effective stress [kPa]
    statev: np.ndarray  #: (n_states,)
    dsig_deps: np.ndarray | None  #: (6, 6), [i, j] = d sigma'_i / d (engineering strain j) [kPa]
    dsig_dpc: np.ndarray | None  #: (6,) d sigma' / d suction [-]
    dsw_deps: np.ndarray | None  #: (6,) d S_w / d strain [-]
    dsw_dpc: float | None  #: d S_w / d suction [1/kPa]
    report: object  #: mud_report of mud.h: n_rate, n_substep, pnewdt, ...


@dataclasses.dataclass
class BatchResponse:
    """Answer of many updates; n points."""

    stress: np.ndarray  #: (n, 6) [kPa]
    statev: np.ndarray  #: (n, n_states)
    status: np.ndarray  #: (n,) status codes, 0: done; a point that failed keeps its outputs as they were
    failed: int  #: number of points that failed
    dsig_deps: np.ndarray | None  #: (n, 6, 6), [k, j, i] = d sigma'_i / d strain j: columns as the library writes them
    dsig_dpc: np.ndarray | None  #: (n, 6)
    dsw_deps: np.ndarray | None  #: (n, 6)
    dsw_dpc: np.ndarray | None  #: (n,)

    def sentence(self, point: int) -> str:
        """The message of the library about a point."""
        return _native.text_of(_native.mud.mud_status_text, int(self.status[point]))[1]


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


class Material(Mapping):
    """Parameters of MUD by name; those not given have the library's default.

    >>> sand = Material("toyoura", e_0=0.735, memory_rule="classic")
    >>> sand["G_0"]
    125.0

    source : name of a material of the library, or a file ``*.nml``; None: the library's defaults.
    values : parameters by name, in the units of ``mud.parameters``; a word where the parameter has options.

    Raises ``InputError`` with the library's sentence for a value out of range, ``UnknownName`` with the nearest name for an
    unknown parameter.
    """

    def __init__(self, source: str | os.PathLike | None = None, /, **values: float | str):
        self.props = np.empty(len(parameters))  #: (n_parameters,) PROPS
        self.title = "defaults of the library"
        _native.mud.mud_default_props(self.props.ctypes.data, len(self.props))
        if source is not None:
            path = material_file(source)
            entries = namelist.read_material(path)
            self.title = str(entries.pop("name", path.stem))
            entries.pop("reference", None)
            self._set(entries)
        self._set(values)
        self.props.flags.writeable = False
        self._prepared = np.empty(_native.mud.mud_prepared_size())
        code, sentence = _native.text_of(
            _native.mud.mud_prepare,
            self.props.ctypes.data,
            len(self.props),
            self._prepared.ctypes.data,
            len(self._prepared),
        )
        if code != 0:
            raise fault_of(code, sentence)

    def _set(self, values: Mapping[str, float | str]) -> None:
        for name, value in values.items():
            entry = parameters[name]
            if isinstance(value, str):
                if value not in entry.options:
                    allowed = ", ".join(entry.options) or "numbers"
                    raise InputError(f"{entry.name} = '{value}': {entry.meaning}; allowed: {allowed}")
                value = entry.options[value]
            self.props[entry.index] = value

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
        other.title = self.title
        return other

    def group(self) -> str:
        """The material as a ``&material`` group of a case file: every parameter that is not the default."""
        lines = [f"   {name} = {value!r}" for name, value in self.items() if value != parameters[name].default]
        return "\n".join(["&material", f"   name = '{self.title}'", *lines, "/", ""])

    def initial_state(
        self, stress: np.ndarray, suction: float = 0.0, void_ratio: float | None = None
    ) -> tuple[np.ndarray, np.ndarray]:
        """Stress (6,) and STATEV (n_states,) of a point that begins.

        stress : (6,) effective stress [kPa], tension positive; lifted to p_min where its mean is below.
        suction : p_a - p_w [kPa].
        void_ratio : [-]; None: e_0 of the material.
        """
        start = np.array(stress, dtype=float)
        _need(start, (6,), "stress")
        statev = np.zeros(len(states))
        code, sentence = _native.text_of(
            _native.mud.mud_init_state,
            self.props.ctypes.data,
            len(self.props),
            start.ctypes.data,
            suction,
            0.0 if void_ratio is None else void_ratio,
            statev.ctypes.data,
            len(statev),
        )
        if code != 0:
            raise fault_of(code, sentence)
        return start, statev

    def update(
        self,
        stress: np.ndarray,
        statev: np.ndarray,
        dstrain: np.ndarray,
        suction: float = 0.0,
        dsuction: float = 0.0,
        tangent: str | None = None,
    ) -> Response:
        """Integrates one increment of strain and suction; the arguments are not changed.

        stress : (6,) [kPa]; statev : (n_states,); dstrain : (6,) engineering strain [-]; all tension positive.
        suction, dsuction : at the start, and its change [kPa].
        tangent : None, "elastic", "continuum" or "consistent".

        Raises ``InputError`` or ``IncrementError``.
        """
        kind = _tangent(tangent)
        arrays = [np.ascontiguousarray(a, dtype=float) for a in (stress, statev, dstrain)]
        for array, shape, name in zip(arrays, ((6,), (len(states),), (6,)), ("stress", "statev", "dstrain")):
            _need(array, shape, name)
        new_stress, new_statev = np.empty(6), np.empty(len(states))
        blocks = [np.empty(36), np.empty(6), np.empty(6), np.empty(1)] if tangent else [None] * 4
        report = _native.Report()
        code = _native.mud.mud_update_prepared(
            self._prepared.ctypes.data,
            arrays[0].ctypes.data,
            arrays[1].ctypes.data,
            len(states),
            arrays[2].ctypes.data,
            suction,
            dsuction,
            kind,
            new_stress.ctypes.data,
            new_statev.ctypes.data,
            *(None if b is None else b.ctypes.data for b in blocks),
            byref(report),
        )
        if code != 0:
            raise fault_of(code, report=report)
        if not tangent:
            return Response(new_stress, new_statev, None, None, None, None, report)
        return Response(
            new_stress, new_statev, blocks[0].reshape(6, 6).T, blocks[1], blocks[2], float(blocks[3][0]), report
        )

    def update_batch(
        self,
        stress: np.ndarray,
        statev: np.ndarray,
        dstrain: np.ndarray,
        suction: np.ndarray | None = None,
        dsuction: np.ndarray | None = None,
        tangent: str | None = None,
        threads: int = 0,
        out: tuple[np.ndarray, np.ndarray] | None = None,
    ) -> BatchResponse:
        """Integrates one increment of n points. Nothing is copied: the library reads and writes the arrays themselves.

        stress : (n, 6) [kPa]; statev : (n, n_states); dstrain : (n, 6); suction, dsuction : (n,) [kPa] or None.
        tangent : as in ``update``. threads : 0 takes as many as OpenMP would.
        out : (stress, statev) to write to, may be the inputs themselves; None: new arrays.

        Every array must be of float64 and contiguous (C order); any other is refused, never copied.
        A point that fails leaves its outputs as they were: see ``status`` of the answer.
        """
        kind, n = _tangent(tangent), len(stress)
        new_stress, new_statev = (np.empty((n, 6)), np.empty((n, len(states)))) if out is None else out
        if out is None:  # a point that fails keeps what it had
            new_stress[:], new_statev[:] = stress, statev
        for array, shape, name in (
            (stress, (n, 6), "stress"),
            (statev, (n, len(states)), "statev"),
            (dstrain, (n, 6), "dstrain"),
            (suction, (n,), "suction"),
            (dsuction, (n,), "dsuction"),
            (new_stress, (n, 6), "out[0]"),
            (new_statev, (n, len(states)), "out[1]"),
        ):
            if array is not None:
                _need(array, shape, name)
        blocks = [np.zeros((n, 6, 6)), np.zeros((n, 6)), np.zeros((n, 6)), np.zeros(n)] if tangent else [None] * 4
        status = np.zeros(n, dtype=np.intc)
        failed = _native.mud.mud_update_batch_prepared(
            self._prepared.ctypes.data,
            n,
            *map(_place, (stress, statev)),
            len(states),
            *map(_place, (dstrain, suction, dsuction)),
            kind,
            threads,
            *map(_place, (new_stress, new_statev, *blocks)),
            status.ctypes.data,
            None,
        )
        if failed < 0:
            raise fault_of(failed)
        return BatchResponse(new_stress, new_statev, status, failed, *blocks)

    def saturation(self, suction: np.ndarray | float, void_ratio: np.ndarray | float) -> np.ndarray:
        """Degree of saturation [-] at suctions [kPa] and void ratios [-]; the shapes are broadcast together."""
        suctions, ratios = np.broadcast_arrays(np.asarray(suction, dtype=float), np.asarray(void_ratio, dtype=float))
        answer, value = np.empty(suctions.shape), c_double()
        for place in np.ndindex(suctions.shape):
            code = _native.mud.mud_saturation(
                self._prepared.ctypes.data, suctions[place], ratios[place], byref(value), None, None
            )
            if code != 0:
                raise fault_of(code)
            answer[place] = value.value
        return answer


def _tangent(kind: str | None) -> int:
    if kind not in TANGENTS:
        raise InputError(f"tangent = {kind!r}: allowed are {', '.join(repr(k) for k in TANGENTS)}")
    return C[TANGENTS[kind]]


def _need(array: np.ndarray, shape: tuple[int, ...], name: str) -> None:
    if not isinstance(array, np.ndarray) or array.dtype != np.float64 or not array.flags.c_contiguous:
        raise InputError(
            f"{name} must be a contiguous numpy array of float64 (C order); make it one with "
            "numpy.ascontiguousarray(..., dtype=float)"
        )
    if array.shape != shape:
        raise InputError(f"{name} has the shape {array.shape}, needed is {shape}")


def _place(array: np.ndarray | None):
    return None if array is None else array.ctypes.data
