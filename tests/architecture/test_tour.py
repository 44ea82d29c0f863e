# SPDX-License-Identifier: MIT
"""The calls that docs/tour.md names stand in the sources, each in the body of the one before."""
import re

from checking import root


def bodies(folder):
    """Subroutines of the Fortran files below a folder by their names."""
    found = {}
    for file in folder.rglob("*.f90"):
        text = file.read_text(encoding="utf-8")
        for match in re.finditer(r"^ *(?:pure )?subroutine (\w+)\(.*?^ *end subroutine \1$", text,
                                 re.MULTILINE | re.DOTALL):
            found.setdefault(match[1], []).append(match[0])
    return found


def missing(names, sources):
    """Pairs of which the first does not call the second."""
    return [(a, b) for a, b in zip(names, names[1:])
            if not any(re.search(rf"\bcall {b}\(", body) for body in sources.get(a, []))]


def test_the_calls_from_umat_to_the_rates_are_those_of_the_tour():
    sentence = re.search(r"(\w+) calls lead from `(\w+)` to the rates: (.*?)\.\n\n",
                         (root / "docs/tour.md").read_text(encoding="utf-8"), re.DOTALL)
    names = [sentence[2], *re.findall(r"`(\w+)`", sentence[3])]
    sources = bodies(root / "umat")
    assert missing([*names[:4], *names[5:]], sources), "a call left out must be found"
    assert not missing(names, sources)
    assert (sentence[1], len(names)) == ("Nine", 10)
