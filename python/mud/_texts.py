# SPDX-License-Identifier: MIT
"""Bytes as text: files of other programs, and what the libraries say about them."""

from __future__ import annotations

import codecs


def text_of_bytes(raw: bytes) -> tuple[str, str]:
    """(text, letters): without a byte-order mark; ``letters`` is empty for UTF-8, else what the letters were read as.

    What is not UTF-8 is read as Windows-1252, which contains Latin-1; UTF-16 (Excel's Unicode text) tells itself by its mark.
    """
    if raw.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE)):
        return raw.decode("utf-16", errors="replace"), "UTF-16"
    try:
        return raw.decode("utf-8-sig"), ""
    except UnicodeDecodeError:
        return raw.decode("cp1252", errors="replace"), "Windows-1252, not UTF-8"
