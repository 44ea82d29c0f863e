# SPDX-License-Identifier: MIT
"""History of impedance.nml: sines of a_0 = 0.5, 1, 1.5 and 2 that grow within their common period."""
import numpy as np
from tools.results import folder

SLOWEST, STEPS = 50.0, 100   # [1/s], a period
PERIOD = 2 * np.pi / SLOWEST


if __name__ == "__main__":
    t = np.arange(3 * STEPS + 1) * PERIOD / STEPS
    factor = sum(np.sin(k * SLOWEST * t) for k in (1, 2, 3, 4)) * np.minimum(1, t / PERIOD)
    with open(folder(__file__) / "waves.txt", "w", encoding="ascii") as file:
        file.write("! Sines of 50, 100, 150 and 200 rad/s that grow within a period of the slowest; time [s], factor\n")
        file.writelines(f"{a:.10f} {b:.10f}\n" for a, b in zip(t, factor))
