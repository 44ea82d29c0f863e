# SPDX-License-Identifier: MIT
"""Makes chart.csv, chart.png and drops.csv: the chart of Toyoura sand by mud_lwd, and the drops of one of its tests; and
test.png, the picture of the example of docs/how-to/lwd.md."""
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
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "python"), "MUD_LIBRARY_DIR": str(BUILD),
                   "MUD_HOST": str(BUILD / "host/mud_host")}

    def mud_lwd(*words):
        subprocess.run([sys.executable, "-m", "mud.lwd", *words], check=True, env=environment)

    mud_lwd("chart", "--material", "toyoura", "--void-ratios", "0.7", "0.85",
            "--suctions", "5", "10", "20", "50", "100", "200", "--output", output / "chart")
    for name in ("chart.csv", "chart.png", "e0.7_s20/drops.csv"):
        shutil.copyfile(output / "chart" / name, output / pathlib.Path(name).name)
    mud_lwd("test", "--material", "toyoura", "--void-ratio", "0.8", "--suction", "30", "--output", output / "test")
    shutil.copyfile(output / "test/lwd.png", output / "test.png")


if __name__ == "__main__":
    main()
