# SPDX-License-Identifier: MIT
"""Evaluations of a fit on disk: a fit that was interrupted goes on with the same command, to the same answer.

A fit is a sequence of evaluations that its task and seed determine. What has been evaluated is read back, the rest is
computed: nothing else need be saved.
"""

from __future__ import annotations

import hashlib
import os
import pathlib
import pickle
from collections.abc import Mapping, Sequence

import numpy as np

from .. import _native
from ..errors import InputError
from .simulation import SETTINGS
from .task import Item


class Store:
    """A file of evaluations: (test, thinning, values) -> (residuals, whether the test stopped)."""

    def __init__(self, path: str | os.PathLike, items: Sequence[Item], base: Mapping[str, float]):
        self.path = pathlib.Path(path)
        self.read = 0  #: evaluations that an earlier run left
        self._known: dict[bytes, tuple[np.ndarray, bool]] = {}
        mark = _mark(items, base)
        try:
            if self.path.exists() and not self._load(mark):
                self.path.unlink()  # of another task
            self.path.parent.mkdir(parents=True, exist_ok=True)
            self._file = open(self.path, "ab")
            if self._file.tell() == 0:
                pickle.dump(mark, self._file)
        except OSError as problem:
            raise InputError(f"{self.path} cannot be written: {problem.strerror}") from problem
        self.read = len(self._known)

    def _load(self, mark: str) -> bool:
        """Reads the file up to where its writer was ended. False: it belongs to another task, or is none."""
        with open(self.path, "rb") as file:
            try:
                if pickle.load(file) != mark:
                    return False
            except (pickle.UnpicklingError, EOFError, AttributeError, ImportError, IndexError, ValueError):
                return False
            whole = file.tell()
            while True:
                try:
                    key, answer = pickle.load(file)
                except (pickle.UnpicklingError, EOFError, AttributeError, ImportError, IndexError, ValueError, TypeError):
                    break
                self._known[key], whole = answer, file.tell()
        os.truncate(self.path, whole)
        return True

    def get(self, job: tuple) -> tuple[np.ndarray, bool] | None:
        """The answer of a job, if it is known."""
        return self._known.get(_key(job))

    def put(self, jobs: Sequence[tuple], answers: Sequence[tuple[np.ndarray, bool]]) -> None:
        """Keeps answers, on disk when this returns."""
        for job, answer in zip(jobs, answers):
            key = _key(job)
            self._known[key] = answer
            pickle.dump((key, answer), self._file)
        self._file.flush()

    def close(self, done: bool) -> None:
        """Closes the file; a fit that is done leaves none."""
        self._file.close()
        if done:
            self.path.unlink(missing_ok=True)


def _key(job: tuple) -> bytes:
    values, number, thin = job
    text = repr((sorted((name, float(value)) for name, value in values.items()), number, thin))
    return hashlib.blake2b(text.encode(), digest_size=16).digest()


def _mark(items: Sequence[Item], base: Mapping[str, float]) -> str:
    """What the evaluations depend on beside their job."""
    mark = hashlib.blake2b(repr((_native.text_of(_native.mud.mud_version)[1], sorted(base.items()), SETTINGS)).encode())
    for item in items:
        test = item.test
        mark.update(repr((test.name, test.kind, test.control, test.cycle_by, item.weight)).encode())
        mark.update(repr((item.use.start, sorted(item.use.scatter.items()))).encode())
        for name in sorted(test.columns):
            mark.update(name.encode() + np.ascontiguousarray(test[name]).tobytes())
        mark.update(np.ascontiguousarray(item.use.rows).tobytes())
    return mark.hexdigest()
