# SPDX-License-Identifier: MIT
"""Element tests: every control of mud_triax, run in this process by the driver's own library."""

from __future__ import annotations

import ctypes
import difflib
import functools
import os
import pathlib
import textwrap
from collections.abc import Iterator, Mapping, Sequence
from ctypes import byref

import numpy as np

from . import _native
from ._native import CONSTANTS as C
from ._texts import text_of_bytes
from .errors import InputError, TestStopped, UnknownName
from .material import Material
from .namelist import quoted

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


# Columns that follow from the stresses of the driver: name -> (unit, meaning).
_DERIVED = {
    "q_mises": ("kPa", "sqrt(3 J2) of the effective stress, whatever its direction; |q| in triaxial tests"),
    "b": ("1", "(sigma_2 - sigma_3)/(sigma_1 - sigma_3); NaN where the stress is isotropic"),
    "lode": ("degrees", "Lode angle: 0 in triaxial compression, 60 in extension; NaN where the stress is isotropic"),
}


class TestResult(Mapping):
    """Table of a test: columns by name, arrays of shape (rows,); compression positive, kPa, natural strain.

    Behind the columns of the driver come ``q_mises``, ``b`` and ``lode`` of the principal stresses: ``q`` is
    sigma_a - sigma_r and says little where the axes turn, as in simple shear.
    """

    __test__ = False  # not a test of pytest

    def __init__(
        self, columns: dict[str, np.ndarray], units: dict[str, str], meanings: dict[str, str], remarks: list[str]
    ):
        self._given = columns  # by the driver
        #: unit of each column
        self.units = {**units, **{name: unit.replace("kPa", units["q"]) for name, (unit, _) in _DERIVED.items()}}
        self.meanings = {**meanings, **{name: text for name, (_, text) in _DERIVED.items()}}  #: what each column is
        self.remarks = remarks  #: facts of the run, "name: text"

    @functools.cached_property
    def _derived(self) -> dict[str, np.ndarray]:
        return _of_principal_stresses(self._given)

    def __getitem__(self, name: str) -> np.ndarray:
        if name in self._given:
            return self._given[name]
        if name not in _DERIVED:
            raise UnknownName(f"there is no column {name}{_nearest(name, self)}")
        return self._derived[name]

    def __getattr__(self, name: str) -> np.ndarray:
        names = [*self.__dict__.get("_given", ()), *_DERIVED]
        if name in names:
            raise AttributeError(f"columns are read by their name in brackets: result['{name}']")
        raise AttributeError(f"a TestResult has no {name}{_nearest(name, names)}")

    def __repr__(self) -> str:
        end = ", ".join(f"{name} {self[name][-1]:.6g}" for name in ("eps_a", "eps_v", "p_eff", "q", "e", "s_w"))
        case = next((r.removeprefix("case: ") for r in self.remarks if r.startswith("case: ")), "test")
        told = (
            f"TestResult({case!r}: {len(self['stage'])} rows, {int(self['stage'][-1])} stages; end: {end}; "
            f"columns {', '.join(self)})"
        )
        return textwrap.fill(told, 110, subsequent_indent="   ")

    def to_frame(self) -> object:
        """The table as a pandas.DataFrame; units and meanings are in its ``attrs``."""
        try:
            import pandas
        except ImportError as problem:
            raise ImportError("to_frame needs pandas: pip install 'mud-soil[frames]'") from problem
        frame = pandas.DataFrame(dict(self))
        frame.attrs.update(units=self.units, meanings=self.meanings, remarks=self.remarks)
        return frame

    def __iter__(self) -> Iterator[str]:
        return iter((*self._given, *_DERIVED))

    def __len__(self) -> int:
        return len(self._given) + len(_DERIVED)

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
    p_net: float | None = None,
    sigma_a_net: float | None = None,
    sigma_r_net: float | None = None,
    suction: float = 0.0,
    saturation: float | None = None,
    air_pressure: float | None = None,
    henry: float | None = None,
    k_w: float | None = None,
    name: str = "test",
    accuracy: float | None = None,
    control_tolerance: float | None = None,
    max_updates: int | None = None,
) -> TestResult:
    """Runs a test on one point and returns its table.

    material : a ``Material``, a name or file of one, or the keys of a ``&material`` group for another law
        (``{"law": "elastic", "young": 1e4, "poisson": 0.3}``).
    stages : one after the other.
    void_ratio : at the start [-].
    p_eff, or sigma_a and sigma_r : effective stress at the start [kPa]; p_net, or sigma_a_net and sigma_r_net: net stress.
    suction : at the start [kPa]. saturation : at the start, with hysteresis; None: on the main drying curve.
    air_pressure : at the start, above the atmosphere [kPa]. henry, k_w : of air and water that cannot leave (air="constant").
    accuracy : relative error wanted in the histories, as 1e-2: increments and tolerance that are not given are chosen for it,
        and ``remarks`` tell the estimate of every column; None: the increments of the stages.
    control_tolerance : relative error allowed in the prescribed stresses; None: the driver's 1e-10.
    max_updates : the test stops after so many updates of the material; None: no limit.

    Raises ``InputError`` if the driver refuses the case, ``TestStopped`` (with the rows so far) if the test stops.
    """
    if isinstance(material, (str, os.PathLike)):
        material = Material(material)
    wrong = next((s for s in stages if not isinstance(s, Stage)), None)
    if not stages or wrong is not None:
        raise InputError(
            f"{'a test has no stage' if wrong is None else f'{wrong!r} is no stage'}; give stages as "
            "mud.Stage('drained', eps_a_end=0.2)"
        )
    initial = {
        "void_ratio": void_ratio,
        "p_eff": p_eff,
        "sigma_a": sigma_a,
        "sigma_r": sigma_r,
        "p_net": p_net,
        "sigma_a_net": sigma_a_net,
        "sigma_r_net": sigma_r_net,
        "suction": suction,
        "saturation": saturation,
        "air_pressure": air_pressure,
        "henry": henry,
        "k_w": k_w,
    }
    text = "".join(
        [
            _group(
                "case",
                {
                    "name": name,
                    "accuracy": accuracy,
                    "control_tolerance": control_tolerance,
                    "max_updates": max_updates,
                },
            ),
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
    sentence = text_of_bytes(message.value)[0]
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
        text_of_bytes(remarks.value)[0].splitlines(),
    )


def _of_principal_stresses(columns: Mapping[str, np.ndarray]) -> dict[str, np.ndarray]:
    """The columns of _DERIVED: from six stresses where the driver gives them, else from axial and radial stress."""
    if "sig_11" in columns:
        s11, s22, s33, s12, s13, s23 = (columns[f"sig_{k}"] for k in ("11", "22", "33", "12", "13", "23"))
        tensor = np.array([[s11, s12, s13], [s12, s22, s23], [s13, s23, s33]]).transpose(2, 0, 1)
        least, middle, most = np.linalg.eigvalsh(tensor).T
    else:
        axial, radial = columns["sigma_a"], columns["sigma_r"]
        least, middle, most = np.minimum(axial, radial), radial, np.maximum(axial, radial)
    reach = most - least
    sheared = reach > 1e-9 * np.abs(most)  # eigenvalues of an isotropic stress differ by rounding
    b = np.where(sheared, (middle - least) / np.where(sheared, reach, 1.0), np.nan)
    return {
        "q_mises": np.sqrt(((most - middle) ** 2 + (middle - least) ** 2 + reach**2) / 2),
        "b": b,
        "lode": np.degrees(np.arctan2(np.sqrt(3.0) * b, 2.0 - b)),
    }


def _nearest(name: str, names: object) -> str:
    """'; the nearest is X (there are ...)'."""
    begun = [other for other in names if other.startswith(f"{name}_")]  # p: p_eff
    near = begun or difflib.get_close_matches(str(name), list(names), 1, 0.4)
    return (f"; the nearest is {near[0]}" if near else "") + f" (there are {', '.join(names)})"


def _group(name: str, keys: Mapping[str, object]) -> str:
    return "".join(
        [f"&{name}\n", *(f"   {key} = {_value(value)}\n" for key, value in keys.items() if value is not None), "/\n"]
    )


def _value(value: object) -> str:
    if isinstance(value, (str, os.PathLike)):
        return quoted(os.fspath(value))
    if isinstance(value, (Sequence, np.ndarray)):
        return ", ".join(map(_value, value))
    return str(value) if isinstance(value, int) and not isinstance(value, bool) else repr(float(value))
