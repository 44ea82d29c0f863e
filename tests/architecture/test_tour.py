# SPDX-License-Identifier: MIT
"""The calls that docs/tour.md names stand in the sources, each in the body of the one before."""
import re

from checking import root


def bodies(folder):
    """Subroutines and programs of the Fortran files below a folder by their names."""
    found = {}
    for file in folder.rglob("*.f90"):
        text = file.read_text(encoding="utf-8")
        for match in re.finditer(r"^(?=(( *)(?:pure )?(subroutine|program) (\w+).*?^\2end \3 \4$))", text,
                                 re.MULTILINE | re.DOTALL):
            found.setdefault(match[4], []).append(match[1])
    return found


def missing(names, sources):
    """Pairs of which the first does not call the second."""
    return [(a, b) for a, b in zip(names, names[1:])
            if not any(re.search(rf"\bcall (\w+%)?{b}\(", body) for body in sources.get(a, []))]


def check_way(goal, folder, count):
    """The sentence of the tour on the calls that lead to a goal, so many of them."""
    sentence = re.search(rf"(\w+) calls\s+lead from `(\w+)` to\s+{goal}: (.*?)\.\n\n",
                         (root / "docs/tour.md").read_text(encoding="utf-8"), re.DOTALL)
    names = [sentence[2], *re.findall(r"`(\w+)`", sentence[3])]
    sources = bodies(root / folder)
    assert missing([*names[:4], *names[5:]], sources), "a call left out must be found"
    assert not missing(names, sources)
    assert (sentence[1], len(names) - 1) == count


def test_the_calls_from_umat_to_the_direction_equation_are_those_of_the_tour():
    check_way("the direction equation", "umat", ("Eleven", 11))


def test_the_calls_from_the_host_to_a_law_are_those_of_the_tour():
    check_way("the law", "host", ("Nine", 9))


def test_a_scene_has_nine_stops_of_which_main_calls_the_first():
    text = (root / "docs/tour.md").read_text(encoding="utf-8").partition("## A scene")[2].partition("\n## ")[0]
    stops = re.findall(r"^\| (\d+) \| `([\w/.]+)`", text, re.MULTILINE)
    assert [int(number) for number, _ in stops] == list(range(1, 10))
    main = bodies(root / "host")["mud_host"][0]
    assert all(f"call {name}(" in main for name in ("read_scene", "build_model", "prepare_run", "run_stages"))
