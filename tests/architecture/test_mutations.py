# SPDX-License-Identifier: MIT
"""Every mutation finds its lines in the sources: a list that has fallen behind would say that nothing survives. Running
them takes minutes and is not part of this."""
import subprocess
import sys

from test_architecture import root

failed = 0
LISTS = ([], ["--contact"], ["--regions"])
for which in LISTS:
    done = subprocess.run([sys.executable, root / "tests/mutations/run_mutations.py", "--apply", *which],
                          capture_output=True, text=True)
    if done.returncode:
        failed += 1
        print(f"FAILED mutations {' '.join(which)}:\n{done.stdout}{done.stderr}")
print(f"{len(LISTS) - failed} passed, {failed} failed")
sys.exit(failed > 0)
