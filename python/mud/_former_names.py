# SPDX-License-Identifier: MIT
"""Names of state variables of version 0.1 that version 0.2 refuses, so that the message can give the new one."""

#: The same variable under its new name.
RENAMED = {"nucleus": "elastic_domain", "n_reseat": "n_reset"}
#: Variables of the memory rule `resume`, which version 0.2 does not have: what takes their place in return_point.
REPLACED = {"way_back": "interrupted", "suspended": "interrupted", "turning_point": "target"}


def note_on(name: str) -> str:
    """What became of a name of version 0.1, '' if it was none; a component (_11 ... _23) is that of its tensor."""
    stem, _, component = name.lower().rpartition("_")
    if not (stem and len(component) == 2 and component.isdigit()):
        stem, component = name.lower(), ""
    tail = f"_{component}" if component else ""
    if stem in RENAMED:
        return f"version 0.2 calls it {RENAMED[stem]}{tail}"
    if stem in REPLACED:
        return f"it belonged to the memory rule resume; return_point, which takes its place, has {REPLACED[stem]}"
    return ""
