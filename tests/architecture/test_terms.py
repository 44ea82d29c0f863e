# SPDX-License-Identifier: MIT
"""A feature has one place: for every term of host/terms the files of the host that name it are counted."""
import re

from checking import check
from test_architecture import root, shown

MOST = 3   # the registry of the terms, the words of the key `without` and what they take out
FRAME = {"term", "term_registry"}
# What a file says that knows a term. The names of keys in another group, as those of an old message, count as well.
WORDS = {
    "absorbing": r"absorb",
    "buffer": r"\bbuffer",
    "staging": r"stag(ed|ing)_ground|\bstaging|held_up|\babsent\(",
    "strength": r"strength",
}
STEP = ("run/step_attempt", "run/time_stepping", "run/step_booking", "solver/newton_step")   # They know term_t alone.


def naming(files, words):
    """Files that name a term. files: {place below host: text}."""
    return sorted(place for place, text in files.items() if re.search(words, text, re.IGNORECASE))


def crowded(files, words=None, most=MOST):
    found = []
    for term, pattern in (words or WORDS).items():
        outside = [place for place in naming(files, pattern) if place != f"terms/{term}"]
        if len(outside) > most:
            found.append(f"{term}: {len(outside)} files name it: {', '.join(outside)}")
        found += [f"{place} names {term}" for place in outside if place in STEP]
    return found


def test_few_files_name_a_term():
    files = {str(file.relative_to(root / "host"))[:-len(".f90")]: file.read_text(encoding="utf-8")
             for file in (root / "host").glob("*/*.f90")}
    ice = {"ice": r"\bice\b"}
    planted = {"terms/ice": "module ice", "a": "ice", "b": "Ice", "c": "price", "d": "use ice, only: x"}
    terms = {place.removeprefix("terms/") for place in files if place.startswith("terms/")} - FRAME
    checks = [
        ("files that name a term are counted, its own and a part of a word are not",
         [] if crowded(planted, ice, 2) and not crowded(planted, ice, 3) else ["planted offence"]),
        ("a step that names a term is seen",
         [] if crowded({"solver/newton_step": "ice"}, ice) else ["planted offence"]),
        ("every term has its words here", sorted(terms ^ set(WORDS))),
        (f"no more than {MOST} files outside name a term, and no step does", crowded(files))]
    for name, findings in checks:
        check(name, not findings, shown(findings))
