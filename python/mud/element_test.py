# SPDX-License-Identifier: MIT
"""Element tests: every control of mud_triax, run in this process by the driver's own library."""

from __future__ import annotations

import ctypes
import os
import pathlib
from collections.abc import Iterator, Mapping, Sequence
from ctypes import byref

import numpy as np

from . import _native
from ._native import CONSTANTS as C
from .errors import InputError, TestStopped
from .material import Material

_DONE, _REFUSED = 0, 2


class Stage:
    """A stage of a test: ``control`` and its keys, as in a case file of mud_triax (drivers/README.md).

    >>> Stage("drained", eps_a_end=0.2, increment=1e-3)
    >>> Stage("undrained", cycle_by="q", amplitude=25.0, cycles=20, stop_r_u=0.95)

    Controls: drained, undrained, isotropic, oedometer, k0, constant_p, constant_q, simple_shear_drained,
    simple_shear_constant_volume, constant_net_stress, strain_path, stress_path, linear. Strains are natural [-] and count
    from the start of the test, stresses in kPa, compression positive. Sequences are lists of numbers (d_eps, strain_1 ...).
    """

    def __init__(self, control: str, **keys: float | str | Sequence[float]):
        self.control, self.keys = control, keys

    def __repr__(self) -> str:
        return f"Stage({self.control!r}, {', '.join(f'{k}={v!r}' for k, v in self.keys.items())})"


class TestResult(Mapping):
    """Table of a test: columns by name, arrays of shape (rows,); compression positive, kPa, natural strain."""

    __test__ = False  # not a test of pytest

    def __init__(
        self, columns: dict[str, np.ndarray], units: dict[str, str], meanings: dict[str, str], remarks: list[str]
    ):
        self._columns = columns
        self.units = units  #: unit of each column
        self.meanings = meanings  #: what each column is
        self.remarks = remarks  #: facts of the run, "name: text"

    def __getitem__(self, name: str) -> np.ndarray:
        if name not in self._columns:
            raise KeyError(f"there is no column {name}; there are {', '.join(self._columns)}")
        return self._columns[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._columns)

    def __len__(self) -> int:
        return len(self._columns)

    @property
    def volumetric_strain(self) -> np.ndarray:
        """(rows,) linear volumetric strain as a laboratory reports it, (e_0 - e)/(1 + e_0) [-]; `eps_v` is natural."""
        e = self["e"]
        return (e[0] - e) / (1 + e[0])

    @property
    def axial_strain(self) -> np.ndarray:
        """(rows,) linear axial strain as a laboratory reports it, 1 - exp(-eps_a) [-]; `eps_a` is natural."""
        return -np.expm1(-self["eps_a"])

    def end_of_stages(self) -> np.ndarray:
        """Row numbers of the start and of the last row of every stage that was begun."""
        stage = self["stage"].astype(int)
        return np.concatenate([np.flatnonzero(np.diff(stage) != 0), [len(stage) - 1]])


def element_test(
    material: Material | Mapping[str, object] | str | os.PathLike,
    *stages: Stage,
    void_ratio: float,
    p_eff: float | None = None,
    sigma_a: float | None = None,
    sigma_r: float | None = None,
    suction: float = 0.0,
    name: str = "test",
    control_tolerance: float | None = None,
    max_updates: int | None = None,
) -> TestResult:
    """Runs a test on one point and returns its table.

    material : a ``Material``, a name or file of one, or the keys of a ``&material`` group for another law
        (``{"law": "elastic", "young": 1e4, "poisson": 0.3}``).
    stages : one after the other.
    void_ratio : at the start [-].
    p_eff, or sigma_a and sigma_r : effective stress at the start [kPa].
    suction : at the start [kPa].
    control_tolerance : relative error allowed in the prescribed stresses; None: the driver's 1e-10.
    max_updates : the test stops after so many updates of the material; None: no limit.

    Raises ``InputError`` if the driver refuses the case, ``TestStopped`` (with the rows so far) if the test stops.
    """
    if isinstance(material, (str, os.PathLike)):
        material = Material(material)
    initial = {"void_ratio": void_ratio, "p_eff": p_eff, "sigma_a": sigma_a, "sigma_r": sigma_r, "suction": suction}
    text = "".join(
        [
            _group("case", {"name": name, "control_tolerance": control_tolerance, "max_updates": max_updates}),
            material.group() if isinstance(material, Material) else _group("material", material),
            _group("initial", initial),
            *(_group("stage", {"control": s.control, **s.keys}) for s in stages),
        ]
    )
    return run_case(text)


def run_case(case: str, folder: str | os.PathLike = ".") -> TestResult:
    """Runs a case given as the text of a case file; relative paths in it begin in ``folder``.

    Threads may call it and wait for each other; processes run side by side.
    """
    handle, message = ctypes.c_void_p(), ctypes.create_string_buffer(_native.TEXT)
    library = _native.mud_triax
    place = str(pathlib.Path(folder) / "case")
    code = library.mud_triax_run(case.encode(), place.encode(), byref(handle), message, len(message))
    sentence = message.value.decode()
    if code == _REFUSED or not handle:
        raise InputError(sentence)
    try:
        result = _table(handle)
    finally:
        library.mud_triax_free(handle)
    if code != _DONE:
        raise TestStopped(sentence, result)
    return result


def _table(handle: ctypes.c_void_p) -> TestResult:
    library = _native.mud_triax
    rows, count = library.mud_triax_rows(handle), library.mud_triax_columns(handle)
    values = np.empty((count, rows))
    library.mud_triax_values(handle, values.ctypes.data)
    fields = [
        [_native.text_of(library.mud_triax_column, handle, i, C[f"MUD_TRIAX_{field}"])[1] for i in range(count)]
        for field in ("NAME", "UNIT", "MEANING")
    ]
    remarks = ctypes.create_string_buffer(library.mud_triax_remarks(handle, None, 0) + 1)
    library.mud_triax_remarks(handle, remarks, len(remarks))
    return TestResult(
        dict(zip(fields[0], values)),
        dict(zip(fields[0], fields[1])),
        dict(zip(fields[0], fields[2])),
        remarks.value.decode().splitlines(),
    )


def _group(name: str, keys: Mapping[str, object]) -> str:
    return "".join(
        [f"&{name}\n", *(f"   {key} = {_value(value)}\n" for key, value in keys.items() if value is not None), "/\n"]
    )


def _value(value: object) -> str:
    if isinstance(value, (str, os.PathLike)):
        return f"'{os.fspath(value)}'"
    if isinstance(value, (Sequence, np.ndarray)):
        return ", ".join(map(_value, value))
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else repr(float(value))
