# SPDX-License-Identifier: MIT
"""Exceptions; their text is the message of the library."""

from __future__ import annotations

from . import _native


class MudError(Exception):
    """Something that the library refuses. ``code`` is its status code, ``name`` the code's name in ``mud.h``."""

    def __init__(self, sentence: str, code: int = 0, report: object = None):
        super().__init__(sentence)
        self.code, self.name, self.report = code, _native.STATUS_NAMES.get(code, "") if code else "", report


class InputError(MudError, ValueError):
    """The caller's mistake (negative code): a parameter, a state or an argument out of its range."""


class UnknownName(InputError, KeyError):
    """A name that the registry does not have; the sentence names the nearest one."""

    __str__ = Exception.__str__  # KeyError shows a representation, not the sentence


class Unchangeable(InputError, AttributeError):
    """An attribute that cannot be set, or is read in another way; the sentence says how."""


class IncrementError(MudError):
    """An increment that could not be integrated (positive code); nothing was changed, a smaller one may pass.

    ``report`` has ``reached`` (share of the increment that was integrated) and ``pnewdt`` (factor to cut it by).
    """


class TestStopped(MudError):
    """An element test that stopped before its end; ``result`` holds the rows so far (mud.TestResult)."""

    __test__ = False  # not a test of pytest

    def __init__(self, sentence: str, result: object = None):  # pickle gives the sentence alone, then the rest
        super().__init__(sentence)
        self.result = result


def fault_of(code: int, sentence: str = "", report: object = None) -> MudError:
    """The exception of a status code, with the sentence of its report or of the code."""
    if not sentence:
        if report is not None:
            sentence = _native.text_of(_native.mud.mud_message, report)[1]
        else:
            sentence = _native.text_of(_native.mud.mud_status_text, code)[1]
    return (InputError if code < 0 else IncrementError)(sentence, code, report)
