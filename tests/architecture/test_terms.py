# SPDX-License-Identifier: MIT
"""A feature has one place: for every term of host/terms the files of the host that name it in their code are counted.
Comments and texts do not count."""
import re

from checking import check
from test_architecture import code_lines, root, shown

MOST = 3   # such as the registry of the terms and the words of the key `without`
FRAME = {"scene_term", "term_registry"}
# Names of what belongs to a term alone, and a folder of laws that the term stands on: friction those of contact.
WORDS = {
    "absorbing": (r"absorb", None),
    "buffer": (r"\bbuffer", None),
    "contact_drainage": (r"contact_drainage|of_drainage|drains|impervious|gives_way", None),
    "drained_regions": (r"drained_regions|give_pressures|follow_undrained", None),
    "friction": (r"friction", "contact"),
    "plane_plates": (r"plane_(plates|motion)|in_plane|\b(rotation|moment|lever)\b|turn_(node|group)", None),
    "run_off": (r"run_off\b|(\b|_)rain(\b|_)|ponding|stuck|releases|begin_sides", None),
    "staging": (r"staging|held_up|staged|mark_absent|%(joins|growth)\b|model%ground\b", None),
    "strength": (r"strength", None),
    "viscosity": (r"viscos", None),
}
STEP = ("run/", "solver/")   # They know term_t alone.


def code(text):
    """Statements, one a line, without comments and texts."""
    return "\n".join(line for _, line in code_lines(text))


def crowded(files, words=None, most=MOST):
    """Terms that too many files name, or one of a step. files: {place below host: text}."""
    found = []
    for term, (pattern, laws) in (words or WORDS).items():
        outside = sorted(place for place, text in files.items() if re.search(pattern, code(text), re.IGNORECASE)
                         and place != f"terms/{term}" and place.partition("/")[0] != laws)
        if len(outside) > most:
            found.append(f"{term}: {len(outside)} files name it: {', '.join(outside)}")
        found += [f"{place} names {term}" for place in outside if place.startswith(STEP)]
    return found


def test_few_files_name_a_term():
    files = {str(file.relative_to(root / "host"))[:-len(".f90")]: file.read_text(encoding="utf-8")
             for file in (root / "host").glob("*/*.f90")}
    ice = {"ice": (r"\bice\b", "cold")}
    planted = {"terms/ice": "module ice", "a/a": "ice = 1", "a/b": "call Ice()", "a/c": "price = 'ice' ! ice",
               "a/d": "use ice, only: x", "cold/e": "ice = 2"}
    terms = {place.removeprefix("terms/") for place in files if place.startswith("terms/")} - FRAME
    checks = [
        ("files that name a term in their code are counted, without its own and those of its laws",
         [] if crowded(planted, ice, 2) and not crowded(planted, ice, 3) else ["planted offence"]),
        ("a step that names a term is seen",
         [] if crowded({"solver/newton_step": "ice = 0"}, ice) else ["planted offence"]),
        ("every term has its words here", sorted(terms ^ set(WORDS))),
        (f"no more than {MOST} files outside name a term, and no step does", crowded(files))]
    for name, findings in checks:
        check(name, not findings, shown(findings))
