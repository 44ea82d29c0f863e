# SPDX-License-Identifier: MIT
"""An option of the core is one file of umat/core/options in registered slots, or the file of what it changes and the
others ask, the retention and the isotropic mechanism: the other files of the library that name it in their code are
counted. Comments and texts do not count, nor do the lists of PROPS and STATEV, which name all, nor a count in the
report of the library (n_hysteresis, which is of the reversal test)."""
import re

from checking import check
from test_architecture import code_lines, root, shown

MOST = 3   # such as its parameters, its numbers in the state, the slots
LISTS = {"mud_registry", "mud_units"}
WORDS = {
    "mud_fluidity": r"fluid|(\b|_)ell(\b|_)",
    "mud_retention": r"(?<!n_)hyster|scann|wetting|turns_t|branch_t|\bp_?aw\b",
    "mud_mechanism": r"remember|isotropic_memory|(?<!surface_)margin",
    "mud_preloading": r"preload|(\b|_)chi(\b|_)",
}


def code(text):
    """Statements, one a line, without comments and texts."""
    return "\n".join(line for _, line in code_lines(text))


def crowded(files, words, most=MOST):
    """Options that too many files name. files: {module: text}."""
    found = []
    for option, pattern in words.items():
        outside = sorted(name for name, text in files.items() if name != option and name not in LISTS
                         and re.search(pattern, code(text), re.IGNORECASE))
        if len(outside) > most:
            found.append(f"{option}: {len(outside)} files name it: {', '.join(outside)}")
    return found


def test_few_files_name_an_option():
    files = {file.stem: file.read_text(encoding="utf-8") for file in (root / "umat").glob("**/*.f90")}
    planted = {"mud_ice": "module mud_ice", "a": "ice = 1", "b": "call f(par%ice)", "c": "price = 'ice' ! ice",
               "mud_registry": "P_ICE = ice"}
    ice = {"mud_ice": r"\bice\b"}
    options = {file.stem for file in (root / "umat/core/options").glob("*.f90")} - {"mud_options"}
    options |= {"mud_retention", "mud_mechanism"}   # hysteresis, isotropic memory
    checks = [
        ("files that name an option in their code are counted, without its own and the lists",
         [] if crowded(planted, ice, 1) and not crowded(planted, ice, 2) else ["planted offence"]),
        ("every option has its words here", sorted(options ^ set(WORDS))),
        (f"no more than {MOST} files outside name an option", crowded(files, WORDS))]
    for name, findings in checks:
        check(name, not findings, shown(findings))
