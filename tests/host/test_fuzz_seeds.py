# SPDX-License-Identifier: MIT
"""The inputs that fuzzing found worth keeping pass in every build, and the fuzz targets compile."""
import subprocess

from checking import build, check, root


def test_there_are_seeds_for():
    for target in ("point", "readers"):
        program = build / f"tests/fuzz_{target}_replay"
        seeds = sorted((root / "tests/fuzz/seeds" / target).iterdir())
        check(f"there are seeds for {target}", len(seeds) > 5, f"{len(seeds)}")
        done = subprocess.run([program, *seeds], capture_output=True, timeout=600)
        told = done.stderr.decode(errors="replace")
        check(f"every seed of {target} passes", done.returncode == 0, f"exit code {done.returncode}: {told[-600:]}")
        check(f"every seed of {target} was run", all(str(seed) in told for seed in seeds), told[-300:])
