# SPDX-License-Identifier: MIT
"""Writes record.txt: an artificial earthquake of 12 s. The velocity is a sum of waves of 0.4 to 8 Hz with random phases, their amplitudes
those that white noise leaves behind a ground of 2.5 Hz with 60 % of damping (Kanai and Tajimi), times an envelope that rises for 2 s,
stays until 6 s and decays; the acceleration is its slope, so that the ground comes to rest."""
import pathlib
import sys

import numpy as np

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE.parents[1]))
from tools import results  # noqa: E402

STEP, END, GROUND, DAMPING, START = 0.02, 12.0, 2.5, 0.6, 1.0   # the ground rests for 1 s


def envelope(t):
    return np.where(t < 2, (t / 2)**2, np.where(t < 6, 1.0, np.exp(-0.6 * (t - 6)))) * np.clip((END - t) / 2, 0, 1)


def acceleration(seed=1):
    """Times of the run [s] and the acceleration over its peak."""
    draw = np.random.default_rng(seed)
    fine = np.arange(0, END + STEP / 20, STEP / 10)
    frequency = np.arange(0.4, 8.0, 0.1) + draw.uniform(-0.04, 0.04, 76)
    ratio = frequency / GROUND
    filtered = np.sqrt((1 + (2 * DAMPING * ratio)**2) / ((1 - ratio**2)**2 + (2 * DAMPING * ratio)**2))
    phase = draw.uniform(0, 2 * np.pi, len(frequency))
    velocity = envelope(fine) * np.sum((filtered / frequency)[:, None] * np.sin(2 * np.pi * frequency[:, None] * fine + phase[:, None]), axis=0)
    found = np.gradient(velocity, fine)[::10]
    found[[0, -1]] = 0
    return START + fine[::10], found / np.abs(found).max()


if __name__ == "__main__":
    text = "! an artificial earthquake of 12 s, made by make_record.py; time [s], acceleration over its peak\n"
    text += "".join(f"{t:.2f} {a:.5f}\n" for t, a in zip(*acceleration()))
    (results.folder(__file__) / "record.txt").write_text(text, encoding="utf-8")
