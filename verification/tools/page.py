# SPDX-License-Identifier: MIT
"""What a page of the verification declares.

A page is a folder `verification/SECTION/NAME` with a README.md and a `page.py`, which holds

    PAGE = Page(claim=..., kind=..., input=..., reference=..., seconds=...)
    def check(bench):                    runs the programs and compares; what it returns is given to draw
    def draw(bench, results, plt):       optional: makes the pictures that PAGE names, by bench.save(figure, name)
    def texts(bench):                    optional: {file: {mark: text}} that the committed results say of themselves
    MAKES = (Script(...), ...)           optional: programs that made committed files of the folder

and is run by `verification/run SECTION/NAME`.
"""
from dataclasses import dataclass

KINDS = {
    "exact": "a closed form, or an equation that is solved apart from the programs",
    "manufactured": "a solution is chosen and the loads that it needs are derived",
    "code-to-code": "another program, or another implementation of the same equations",
    "experiment": "laboratory data, reported and not tuned",
    "fitted": "laboratory data to which parameters were chosen: shows what the model can reach, and predicts nothing",
    "conservation": "balances of mass, momentum or energy that every solution has to satisfy",
    "robustness": "whatever the input, nothing is lost and nothing is silently wrong",
    "regression": "earlier results of this program: proves only that they are unchanged",
    "study": "the program compared with itself or with published results; proves nothing about soil",
}


@dataclass(frozen=True)
class Tolerance:
    """What a check allows: |value - reference| <= absolute + relative*|reference|, and the reason."""
    because: str
    absolute: float = 0.0
    relative: float = 0.0

    def __post_init__(self):
        if not self.because.strip():
            raise ValueError("a tolerance needs its reason")


@dataclass(frozen=True)
class Script:
    """A program of the folder that makes committed files of it; `verification/run PAGE --make` runs those of a page in
    their order."""
    name: str
    files: tuple
    seconds: float
    needs: str = ""   # Python packages beyond requirements.txt
    alone: bool = False   # Too dear for a night: runs where --only names it.


@dataclass(frozen=True)
class Page:
    claim: str               # one sentence
    kind: tuple              # of KINDS
    input: str               # cases and scenes
    reference: str           # what the answer is compared with, and where it comes from
    seconds: float           # of the whole page: release build, one core
    quick: float = 0.0       # of `--quick`, which the check run takes; 0: no part of the check run
    pictures: tuple = ()     # files beside the README
    every_build: bool = False   # the check run of the slow builds (debug, sanitize) takes it too

    def __post_init__(self):
        kinds = (self.kind,) if isinstance(self.kind, str) else tuple(self.kind)
        object.__setattr__(self, "kind", kinds)
        unknown = [kind for kind in kinds if kind not in KINDS]
        if unknown or not kinds:
            raise ValueError(f"kind {unknown}: a page is of one or more of {', '.join(KINDS)}")
