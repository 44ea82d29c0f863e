# SPDX-License-Identifier: MIT
"""Many points of one or several materials over NumPy arrays that nothing copies."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from ctypes import byref
from typing import TYPE_CHECKING

import numpy as np

from . import _native
from ._native import CONSTANTS as C
from .errors import InputError, MudError, fault_of
from .registry import states

if TYPE_CHECKING:
    from .material import Material

TANGENTS = {
    None: C["MUD_TANGENT_NONE"],
    "elastic": C["MUD_TANGENT_ELASTIC"],
    "continuum": C["MUD_TANGENT_CONTINUUM"],
    "consistent": C["MUD_TANGENT_CONSISTENT"],
}
NEAR = 0.05  # p_atm this close to each other are of one unit: 100 and 101.325 kPa
_SHAPES = {
    "stress0": (6,),
    "statev0": (len(states),),
    "dstrain": (6,),
    "stress1": (6,),
    "statev1": (len(states),),
    "dsig_deps": (6, 6),
    "dsig_dpc": (6,),
    "dsw_deps": (6,),
}


@dataclasses.dataclass
class BatchResponse:
    """Arrays of n points, and what became of them. As ``out=`` its arrays are written to; those that are None are not wanted.

    A point that fails, or that the list leaves out, keeps what its arrays held.
    """

    stress: np.ndarray | None = None  #: (n, 6) [kPa]
    statev: np.ndarray | None = None  #: (n, n_states)
    columns: np.ndarray | None = None  #: (n, 6, 6) of the tangent: [k, j, i] = d sigma'_i / d strain j, as it lies in memory
    dsig_dpc: np.ndarray | None = None  #: (n, 6) d sigma' / d suction [-]
    dsw_deps: np.ndarray | None = None  #: (n, 6) d S_w / d strain [-]
    dsw_dpc: np.ndarray | None = None  #: (n,) d S_w / d suction [1/kPa]
    s_w: np.ndarray | None = None  #: (n,) degree of saturation [-]
    status: np.ndarray | None = None  #: (n,) status codes, 0: done
    failed: int = 0  #: number of points that failed
    worst: int = -1  #: the failed point that got least far; -1: none failed
    pnewdt: float = 1.0  #: smallest suggested factor on the increment, 1 if no point failed
    n_open: int = 0  #: points held by the tension cut-off
    n_tensile: int = 0  #: points with a tensile principal stress
    n_lifted: int = 0  #: points that began with a mean stress below p_min
    n_rate: int = 0  #: rate evaluations of all points
    n_substep: int = 0  #: substeps of all points
    report: object = None  #: mud_report of the worst point

    @property
    def dsig_deps(self) -> np.ndarray | None:
        """(n, 6, 6) tangent, [k, i, j] = d sigma'_i / d strain j as in ``Response``: a view of ``columns``."""
        return None if self.columns is None else self.columns.transpose(0, 2, 1)

    def fault(self) -> MudError | None:
        """The exception of the worst point, which names it, to raise or to send to other ranks; None if no point failed."""
        if not self.failed:
            return None
        sentence = _native.text_of(_native.mud.mud_message, self.report)[1]
        return fault_of(self.report.status, f"point {self.worst}: {sentence}", self.report)

    def sentence(self, point: int | None = None) -> str:
        """The message of the library about the worst point, or what the status of another one means."""
        if point is None or point == self.worst:
            return _native.text_of(_native.mud.mud_message, self.report)[1]
        return _native.text_of(_native.mud.mud_status_text, int(self.status[point]))[1]


class Points:
    """What one material and a list of materials do with arrays of points.

    Every array must be of float64 (numbers of points and materials: int32) and contiguous (C order); any other is refused,
    never copied. Common to all methods:

    points : (m,) numbers of the points that the call treats, each once; None: all.
    material : (n,) number of the material of every point; None: the first.
    total_stress : stresses and their slopes are those of total stress less air pressure, sigma + p_a I.
    lanes : up to eight points side by side, in less time, where processor and material allow it; numbers differ by
        rounding.
    threads : 0 takes as many as OpenMP would; any other number is cut to one a point and to 1024.
    out : a ``BatchResponse`` whose arrays are written to; None: new arrays.
    """

    _storage: np.ndarray  #: (materials, doubles) prepared ones

    def init_batch(
        self,
        stress: np.ndarray,
        suction: np.ndarray | None = None,
        void_ratio: np.ndarray | None = None,
        saturation: np.ndarray | None = None,
        *,
        points: np.ndarray | None = None,
        material: np.ndarray | None = None,
        total_stress: bool = False,
        out: BatchResponse | None = None,
    ) -> BatchResponse:
        """Begins points: ``stress`` and ``statev`` of the answer.

        stress : (n, 6) [kPa]; a mean effective stress below p_min is lifted, see ``n_lifted``.
        suction : (n,) [kPa]; None: 0. void_ratio : (n,); None: e_0 of the material.
        saturation : (n,) with hysteresis; None: on the main drying curve.
        """
        n = len(stress)
        answer = out or BatchResponse(stress.copy(), np.zeros((n, len(states))))
        given = {"stress0": stress, "suction": suction, "void_ratio": void_ratio, "saturation": saturation}
        return self._run(_native.mud.mud_init_points, n, given, answer, 0, total_stress, points, material, 1)

    def update_batch(
        self,
        stress: np.ndarray,
        statev: np.ndarray,
        dstrain: np.ndarray,
        suction: np.ndarray | None = None,
        tangent: str | None = None,
        *,
        points: np.ndarray | None = None,
        material: np.ndarray | None = None,
        total_stress: bool = False,
        lanes: bool = False,
        threads: int = 0,
        out: BatchResponse | None = None,
    ) -> BatchResponse:
        """Integrates one increment of n points; ``out.stress`` and ``out.statev`` may be the inputs themselves.

        stress : (n, 6) [kPa]; statev : (n, n_states); dstrain : (n, 6) engineering strain [-].
        suction : (n,) at the end [kPa], where it begins statev tells; None: it does not change.
        tangent : None, "elastic", "continuum" or "consistent".

        A point that fails keeps its outputs: see ``failed``, ``worst``, ``pnewdt``, ``status`` and ``fault()`` of the answer.
        """
        kind, n = tangent_kind(tangent) + (C["MUD_LANES"] if lanes else 0), len(stress)
        if out is None:  # a point that fails keeps what it had
            out = BatchResponse(np.array(stress, dtype=float), np.array(statev, dtype=float))
            if tangent:
                _new_blocks(out, n)
        given = {"stress0": stress, "statev0": statev, "dstrain": dstrain, "suction": suction}
        return self._run(_native.mud.mud_update_points, n, given, out, kind, total_stress, points, material, threads)

    def tangent_batch(
        self,
        stress: np.ndarray,
        statev: np.ndarray,
        direction: np.ndarray | None = None,
        suction: np.ndarray | None = None,
        *,
        points: np.ndarray | None = None,
        material: np.ndarray | None = None,
        total_stress: bool = False,
        threads: int = 0,
        out: BatchResponse | None = None,
    ) -> BatchResponse:
        """Slopes with which the present states go on, for the first iteration of a step; nothing is updated.

        direction : (n, 6) strain that is expected, of any length; None or zero: as the point strained last.
        suction : (n,) towards which it goes [kPa]; None: it does not change.
        """
        if out is None:
            out = BatchResponse()
            _new_blocks(out, len(stress))
        given = {"stress0": stress, "statev0": statev, "dstrain": direction, "suction": suction}
        kind = C["MUD_TANGENT_PRESENT"]
        return self._run(
            _native.mud.mud_update_points, len(stress), given, out, kind, total_stress, points, material, threads
        )

    def saturation_batch(
        self,
        statev: np.ndarray,
        suction: np.ndarray | None = None,
        *,
        points: np.ndarray | None = None,
        material: np.ndarray | None = None,
        out: BatchResponse | None = None,
    ) -> BatchResponse:
        """``s_w``, ``dsw_dpc`` and ``dsw_deps`` of points at another suction (n,) [kPa] and their present void ratio."""
        n = len(statev)
        out = out or BatchResponse(dsw_deps=np.zeros((n, 6)), dsw_dpc=np.zeros(n), s_w=np.zeros(n))
        given = {"statev0": statev, "suction": suction}
        return self._run(_native.mud.mud_saturation_points, n, given, out, 0, False, points, material, 1)

    def _run(self, function, n, given, answer, kind, total_stress, listed, material, threads) -> BatchResponse:
        if material is None and len(self._storage) > 1:
            raise InputError("material is missing: the number of each point's material, from 0")
        if answer.status is None:
            answer.status = np.zeros(n, dtype=np.intc)
        points = _native.Points(n=n, nstatev=len(states), threads=threads)
        points.tangent = kind + (C["MUD_TOTAL_STRESS"] if total_stress else 0)
        results = {
            "stress1": answer.stress,
            "statev1": answer.statev,
            "dsig_deps": answer.columns,
            "dsig_dpc": answer.dsig_dpc,
            "dsw_deps": answer.dsw_deps,
            "dsw_dpc": answer.dsw_dpc,
            "s_w": answer.s_w,
        }
        read, written = {}, {}
        for place, arrays in ((read, given), (written, results)):
            for name, array in arrays.items():
                if array is not None:
                    need(array, (n, *_SHAPES.get(name, ())), name.removesuffix("0"))
                    place[name] = array
        for place, name, array, size, said in (
            (read, "list", listed, None, "points"),
            (read, "material", material, n, "material"),
            (written, "status", answer.status, n, "status"),
        ):
            if array is not None:
                need(array, (np.size(array) if size is None else size,), said, np.intc)
                place[name] = array
        for name, (first, _) in _apart(read, written).items():
            setattr(points, name, first)
        if listed is not None:
            wrong = listed[(listed < 0) | (listed >= n)]
            if len(wrong):
                raise InputError(f"points has the number {wrong[0]}; there are {n} points, from 0")
            often = np.bincount(listed, minlength=1)
            if often.max() > 1:  # in place it would be updated again
                raise InputError(f"points has the number {np.argmax(often)} more than once")
            points.n = len(listed)
        if material is not None:
            used = material if listed is None else material[listed]
            wrong = used[(used < 0) | (used >= len(self._storage))]
            if len(wrong):
                raise InputError(f"material has the number {wrong[0]}; the list has {len(self._storage)}, from 0")
        summary = _native.Summary()
        failed = function(self._storage.ctypes.data, len(self._storage), byref(points), byref(summary))
        if failed < 0:
            raise fault_of(failed)
        for name in ("failed", "worst", "pnewdt", "n_open", "n_tensile", "n_lifted", "report"):
            setattr(answer, name, getattr(summary, name))
        answer.n_rate, answer.n_substep = int(summary.n_rate), int(summary.n_substep)
        return answer


class MaterialList(Points):
    """Several materials, by number: every method takes ``material``, the number of each point's.

    >>> ground = MaterialList([Material("toyoura"), Material("karlsruhe")])
    """

    def __init__(self, materials: Sequence[Material]):
        materials = list(materials)
        if not materials:
            raise InputError("a list of materials needs one at least")
        for i, one in enumerate(materials):
            if not isinstance(one, Points) or isinstance(one, MaterialList):  # Material itself imports this module
                raise InputError(f"materials[{i}] is {one!r}: each is a mud.Material, such as mud.Material('toyoura')")
            if not abs(one["p_atm"] / materials[0]["p_atm"] - 1) < NEAR:
                raise InputError(
                    f"materials[{i}] has p_atm = {one['p_atm']:g} and the first {materials[0]['p_atm']:g}: the stresses of "
                    "a list have one unit; Material.converted changes that of a material"
                )
        self._storage = np.concatenate([one._storage for one in materials])


def tangent_kind(kind: str | None) -> int:
    """Number of a kind of tangent."""
    if kind not in TANGENTS:
        raise InputError(f"tangent = {kind!r}: allowed are {', '.join(repr(k) for k in TANGENTS)}")
    return TANGENTS[kind]


def need(array: np.ndarray, shape: tuple[int, ...], name: str, dtype: type = np.float64) -> None:
    """Refuses what the library could not read as it is."""
    if not isinstance(array, np.ndarray) or array.dtype != dtype or not array.flags.c_contiguous:
        word = np.dtype(dtype).name
        raise InputError(
            f"{name} must be a contiguous numpy array of {word} (C order); make it one with "
            f"numpy.ascontiguousarray(..., dtype={word!r})"
        )
    if array.shape != shape:
        raise InputError(f"{name} has the shape {array.shape}, needed is {shape}")


def _apart(read: dict[str, np.ndarray], written: dict[str, np.ndarray]) -> dict[str, tuple[int, int]]:
    """First and last address of arrays. Refuses results that cannot be written, and those that lie across an input or
    another result: the next point would read them."""
    spans: dict[str, tuple[int, int]] = {}
    for name, array in (*read.items(), *written.items()):
        first = array.__array_interface__["data"][0]
        last = first + array.nbytes
        if name in written:
            if not array.flags.writeable:
                raise InputError(f"{name} is read-only: results are written to it")
            for other, (begin, end) in spans.items():
                in_place = first == begin and other in read and name[:-1] == other[:-1]
                if first < end and begin < last and not in_place:
                    words = "results are written to the input itself or apart from it"
                    raise InputError(f"{name} overlaps {other}: {words}")
        spans[name] = first, last
    return spans


def _new_blocks(answer: BatchResponse, n: int) -> None:
    answer.columns, answer.dsig_dpc, answer.dsw_deps = np.zeros((n, 6, 6)), np.zeros((n, 6)), np.zeros((n, 6))
    answer.dsw_dpc, answer.s_w = np.zeros(n), np.zeros(n)
