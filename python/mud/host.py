# SPDX-License-Identifier: MIT
"""Results of the finite-element host: tables of a run with numpy alone, fields with h5py (extra ``host``)."""

from __future__ import annotations

import os
import pathlib
import re

import numpy as np

from ._csv import rows_of
from .errors import InputError


class HostRun:
    """The output folder of a run of mud_host (host/OUTPUT.md). Units m, s, kPa; tension positive.

    >>> run = HostRun("out")
    >>> time, settlement = run.histories["time"], run.histories["top.u_z"]
    """

    def __init__(self, folder: str | os.PathLike):
        self.folder = pathlib.Path(folder)
        if not (self.folder / "histories.csv").exists():
            raise InputError(f"{self.folder} holds no histories.csv of mud_host; name the folder of its --output")

    @property
    def histories(self) -> dict[str, np.ndarray]:
        """Columns of histories.csv: the time [s] first, then POINT.QUANTITY; arrays (steps,)."""
        return self.table("histories")

    @property
    def ledger(self) -> dict[str, np.ndarray]:
        """Columns of ledger.csv, a row a step: iterations, errors, energies [kJ], outflow [m3]."""
        return self.table("ledger")

    @property
    def stages(self) -> list[str]:
        """Names of the stages that came to their end, in their order."""
        names = [path.stem.removeprefix("nodes_") for path in self.folder.glob("nodes_*.csv")]
        begun = list(self.reactions)
        written = {name: (self.folder / f"nodes_{name}.csv").stat().st_mtime_ns for name in names}
        return sorted(names, key=begun.index if set(names) <= set(begun) else written.get)

    @property
    def reactions(self) -> dict[str, dict[str, np.ndarray]]:
        """Tables reactions_STAGE by stage, in the order of their times: a copied folder has lost that of its files."""
        names = [path.stem.removeprefix("reactions_") for path in self.folder.glob("reactions_*.csv")]
        tables = [(name, self.table(f"reactions_{name}")) for name in names]
        return dict(sorted(tables, key=lambda item: item[1]["time"][:1].tolist()))

    def table(self, name: str) -> dict[str, np.ndarray]:
        """Columns of a table of the folder by its name without .csv: histories, ledger, contact, nodes_STAGE, points_STAGE.

        Columns of numbers are arrays of float64 (rows,), others arrays of text.
        """
        path = self.folder / f"{name}.csv"
        if not path.exists():
            there = ", ".join(sorted(p.stem for p in self.folder.glob("*.csv")))
            raise InputError(f"{self.folder} has no table {name}; it has {there}")
        lines = rows_of(path)
        if not lines:
            raise InputError(f"{path} is empty: the run ended before it wrote it")
        (_, names), rows = lines[0], lines[1:]
        for number, cells in rows:
            if len(cells) != len(names):
                words = f"{len(cells)} values of {len(names)}; the row was not written to its end"
                raise InputError(f"{path}:{number}: {words}")
        if not rows:
            return {name: np.empty(0) for name in names}
        return {name: _column(values) for name, values in zip(names, zip(*(cells for _, cells in rows)))}

    def _frames(self) -> list[pathlib.Path]:
        # Not whatever lies in the folder: an earlier run may have written more.
        listed = self.folder / "results.xdmf"
        if not listed.exists():
            raise InputError(f"{self.folder} has no results.xdmf; name the output folder of a run of mud_host")
        return [
            self.folder / n
            for n in dict.fromkeys(re.findall(r">(fields_\d+\.h5):/", listed.read_text(encoding="utf-8")))
        ]

    def mesh(self) -> tuple[np.ndarray, np.ndarray]:
        """Nodes (n, 2) [m] and elements (m, 6), numbers from 0."""
        with _h5py().File(self.folder / "mesh.h5") as file:
            return file["nodes"][...], file["elements"][...].reshape(-1, 6)

    def times(self) -> np.ndarray:
        """Moments at which fields were written [s]."""
        return np.array([_read(path, "time")[0] for path in self._frames()])

    def field(self, name: str, frame: int = -1) -> np.ndarray:
        """A field at a moment: (nodes,), (nodes, 3) for vectors, the last zero, or (elements,)."""
        path = self._frames()[frame]
        with _h5py().File(path) as file:
            for place in ("nodes", "cells"):
                if name in file[place]:
                    return file[place][name][...]
            raise InputError(f"there is no field {name}; there are {', '.join([*file['nodes'], *file['cells']])}")


def _column(values: tuple[str, ...]) -> np.ndarray:
    try:
        return np.array([float(v) for v in values])
    except ValueError:
        return np.array(values)


def _h5py():
    try:
        import h5py
    except ImportError as problem:
        raise ImportError("fields of a run need h5py: pip install 'mud-soil[host]'; tables do not") from problem
    return h5py


def _read(path: pathlib.Path, name: str) -> np.ndarray:
    with _h5py().File(path) as file:
        return file[name][...]
