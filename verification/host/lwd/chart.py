# SPDX-License-Identifier: MIT
"""Makes chart.csv and drops.csv: the chart of Toyoura sand by mud_lwd, and the drops of one of its tests."""
import os
import pathlib
import shutil
import subprocess
import sys

from tools.results import folder

ROOT = pathlib.Path(__file__).resolve().parents[3]
BUILD = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")


def main():
    output = folder(__file__)
    subprocess.run([sys.executable, "-m", "mud.lwd", "chart", "--material", "toyoura", "--void-ratios", "0.7", "0.85",
                    "--suctions", "5", "10", "20", "50", "100", "200", "--output", output / "chart"], check=True,
                   env={**os.environ, "PYTHONPATH": str(ROOT / "python"), "MUD_LIBRARY_DIR": str(BUILD),
                        "MUD_HOST": str(BUILD / "host/mud_host")})
    shutil.copyfile(output / "chart/chart.csv", output / "chart.csv")
    shutil.copyfile(output / "chart/e0.7_s20/drops.csv", output / "drops.csv")


if __name__ == "__main__":
    main()
