# SPDX-License-Identifier: MIT
"""The two shared libraries and what their headers say.

Constants, the report of an update and the version of the interface are read from ``mud.h`` and ``mud_triax.h``, which lie
beside the libraries: there is one list of them, and this module does not repeat it.
"""

from __future__ import annotations

import ctypes
import os
import pathlib
import re
from ctypes import POINTER, c_char_p, c_double, c_int, c_void_p

from ._texts import text_of_bytes

PACKAGE = pathlib.Path(__file__).resolve().parent
SOURCE_TREE = PACKAGE.parent.parent
FOLDER_VARIABLE = "MUD_LIBRARY_DIR"
# Interfaces that this package was written for.
ABI_VERSIONS = {"mud": (3,), "mud_triax": (1,)}
TEXT = 2000  # bytes of a sentence


def _folders() -> list[pathlib.Path]:
    """Where libraries may be: the folder of MUD_LIBRARY_DIR alone, or that of the wheel, then the release build of the tree."""
    named = os.environ.get(FOLDER_VARIABLE)
    builds = [pathlib.Path(named)] if named else [PACKAGE / "lib", SOURCE_TREE / "build" / "release"]
    return [folder / part for folder in builds for part in ("", "umat", "drivers")]


def _find(name: str) -> pathlib.Path:
    for folder in _folders():
        for suffix in (".so", ".dylib"):
            if (folder / f"lib{name}{suffix}").exists():
                return folder / f"lib{name}{suffix}"
    looked = (
        ", ".join(str(folder) for folder in dict.fromkeys(_folders()) if folder.is_dir()) or "no folder that is there"
    )
    raise ImportError(
        f"lib{name}.so was not found in {looked}. Install the package with `pip install .` from the tree, build "
        f"the tree (cmake --preset release; ninja -C build/release), or name the folder with {FOLDER_VARIABLE}."
    )


def _header(name: str) -> str:
    for place in (PACKAGE / "include" / name, SOURCE_TREE / "umat" / "include" / name, SOURCE_TREE / "drivers" / name):
        if place.exists():
            return re.sub(r"/\*.*?\*/", " ", place.read_text(encoding="utf-8"), flags=re.DOTALL)
    raise ImportError(f"{name} is missing beside the package; install it again with `pip install .`.")


def _constants(header: str) -> dict[str, int]:
    """Enumerators and numeric macros of a header."""
    found = {m[1]: int(m[2]) for m in re.finditer(r"#define\s+(\w+)\s+(-?\d+)\s*$", header, re.MULTILINE)}
    for body in re.findall(r"enum\s+\w+\s*\{(.*?)\}", header, re.DOTALL):
        found.update({m[1]: int(m[2]) for m in re.finditer(r"(\w+)\s*=\s*(-?\d+)", body)})
    return found


def _structure(header: str, name: str, **known: type) -> type[ctypes.Structure]:
    """The ctypes twin of a `typedef struct` of ints, doubles, arrays of them, pointers and structures known before."""
    body = re.search(rf"typedef struct {name}\s*\{{(.*?)\}}", header, re.DOTALL)
    kinds, fields = {"int": c_int, "double": c_double, **known}, []
    for kind, names in re.findall(r"(?:const\s+)?(\w+)\s+([^;]+);", body[1]):
        for star, word, length in re.findall(r"(\*?)(\w+)(?:\[(\d+)\])?", names):
            fields.append((word, c_void_p if star else kinds[kind] * int(length) if length else kinds[kind]))
    return type(name, (ctypes.Structure,), {"_fields_": fields})


_text, _text_triax = _header("mud.h"), _header("mud_triax.h")
CONSTANTS = {**_constants(_text), **_constants(_text_triax)}
Report = mud_report = _structure(_text, "mud_report")  # by both names, or pickle does not find it
Blocks = _structure(_text, "mud_blocks")
Points = _structure(_text, "mud_points")
Summary = _structure(_text, "mud_summary", mud_report=Report)
STATUS_NAMES = {
    value: name for name, value in _constants(re.search(r"enum mud_status\s*\{.*?\}", _text, re.DOTALL)[0]).items()
}
_doubles = POINTER(c_double)
_SIGNATURES = {
    "mud_abi_version": [],
    "mud_version": [c_char_p, c_int],
    "mud_count": [c_int],
    "mud_index": [c_int, c_char_p],
    "mud_text": [c_int, c_int, c_int, c_char_p, c_int],
    "mud_option": [c_int, c_int, _doubles, c_char_p, c_int],
    "mud_bounds": [c_int, c_int, _doubles, _doubles, _doubles],
    "mud_default_props": [c_void_p, c_int],
    "mud_bounds_for": [c_void_p, c_int, c_int, _doubles, _doubles, _doubles],
    "mud_validate_props": [c_void_p, c_int, c_char_p, c_int],
    "mud_convert_props": [c_void_p, c_int, c_double],
    "mud_prepared_size": [],
    "mud_prepared_statev": [c_void_p],
    "mud_prepare": [c_void_p, c_int, c_void_p, c_int, c_char_p, c_int],
    "mud_init": [c_void_p, c_void_p, c_double, c_double, c_double, c_void_p, c_int, c_char_p, c_int],
    "mud_update": [c_void_p, c_void_p, c_void_p, c_int, c_void_p, c_double, c_int] + 4 * [c_void_p],
    "mud_init_points": [c_void_p, c_int, c_void_p, c_void_p],
    "mud_update_points": [c_void_p, c_int, c_void_p, c_void_p],
    "mud_saturation_points": [c_void_p, c_int, c_void_p, c_void_p],
    "mud_save_increment": [c_char_p, c_char_p, c_void_p, c_void_p, c_void_p, c_int, c_void_p, c_double, c_int, c_char_p, c_int],
    "mud_saturation": [c_void_p, c_double, c_double, _doubles, _doubles, _doubles],
    "mud_status_text": [c_int, c_char_p, c_int],
    "mud_message": [POINTER(Report), c_char_p, c_int],
}
_SIGNATURES_TRIAX = {
    "mud_triax_run": [c_char_p, c_char_p, POINTER(c_void_p), c_char_p, c_int],
    "mud_triax_rows": [c_void_p],
    "mud_triax_columns": [c_void_p],
    "mud_triax_column": [c_void_p, c_int, c_int, c_char_p, c_int],
    "mud_triax_values": [c_void_p, c_void_p],
    "mud_triax_remarks": [c_void_p, c_char_p, c_int],
    "mud_triax_free": [c_void_p],
}


def _load(name: str, signatures: dict[str, list]) -> ctypes.CDLL:
    path = _find(name)
    try:
        library = ctypes.CDLL(str(path))
    except OSError as problem:
        raise ImportError(
            f"{path} cannot be loaded: {problem}. It needs the runtime of gfortran (Debian: libgfortran5) and, "
            "for element tests, LAPACK."
        ) from problem
    for function, arguments in signatures.items():
        getattr(library, function).argtypes = arguments
        getattr(library, function).restype = c_int
    return library


def _check_version(name: str, found: int) -> None:
    if found not in ABI_VERSIONS[name]:
        raise ImportError(
            f"lib{name} has interface {found}, this package was written for {ABI_VERSIONS[name]}; "
            "install library and package from the same tree."
        )


class _Later:
    """A library that is loaded when a function of it is first asked for: updates need neither mud_triax nor LAPACK."""

    def __init__(self, name: str, signatures: dict[str, list]) -> None:
        self._what = name, signatures

    def __getattr__(self, function: str):
        if function not in self._what[1]:
            raise AttributeError(function)
        library = _load(*self._what)
        library.mud_triax_free.restype = None
        self.__dict__.update({name: getattr(library, name) for name in self._what[1]})
        return getattr(library, function)


mud = _load("mud", _SIGNATURES)
_check_version("mud", mud.mud_abi_version())
_check_version("mud_triax", CONSTANTS["MUD_TRIAX_ABI_VERSION"])
mud_triax = _Later("mud_triax", _SIGNATURES_TRIAX)


def text_of(function, *arguments) -> tuple[int, str]:
    """(code, text) of a function that ends in (text, len)."""
    room = ctypes.create_string_buffer(TEXT)
    code = function(*arguments, room, len(room))
    return code, text_of_bytes(room.value)[0]
