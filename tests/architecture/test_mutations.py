# SPDX-License-Identifier: MIT
"""Every mutation finds its lines in the sources: a list that has fallen behind would say that nothing survives. Running
them takes minutes and is not part of this."""
import subprocess
import sys

import pytest
from checking import check, root


@pytest.mark.parametrize("which", [[], ["--contact"], ["--regions"], ["--field"]],
                         ids=["model", "contact", "regions", "field"])
def test_every_mutation_finds_its_lines(which):
    done = subprocess.run([sys.executable, root / "tests/mutations/run_mutations.py", "--apply", *which],
                          capture_output=True, text=True)
    check(f"mutations {' '.join(which)}", done.returncode == 0, done.stdout + done.stderr)
