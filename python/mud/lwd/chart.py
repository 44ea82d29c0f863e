# SPDX-License-Identifier: MIT
"""Modulus against suction, degree of saturation and void ratio: a grid of tests, several at a time."""

from __future__ import annotations

import csv
import json
import pathlib
import subprocess
import sys
import time
from dataclasses import dataclass, field

from ..plots import COLOURS, LINES, pyplot, style

INTERRUPTED = 130


@dataclass
class Place:
    """A test of the grid."""

    void_ratio: float
    suction: float
    folder: pathlib.Path
    told: dict = field(default_factory=dict)  # results.json
    code: int = 0
    said: str = ""  # why it has no result


def run_grid(places: list[Place], words: list[str], processes: int, say) -> None:
    """Runs what has no result: `words` are the options that all tests share. Interrupted, it ends its tests."""
    waiting, running = list(places), []
    began = time.monotonic()
    try:
        while waiting or running:
            while waiting and len(running) < processes:
                place = waiting.pop(0)
                place.folder.mkdir(parents=True, exist_ok=True)
                command = [sys.executable, "-m", "mud.lwd", "test", *words, "--quiet", "--no-page"]
                command += ["--void-ratio", f"{place.void_ratio:g}", "--suction", f"{place.suction:g}"]
                command += ["--output", str(place.folder)]
                log = open(place.folder / "said.txt", "w", encoding="utf-8")  # noqa: SIM115 (closed where it ends)
                running.append((place, subprocess.Popen(command, stdout=log, stderr=log), log))
            time.sleep(0.2)
            for one in [x for x in running if x[1].poll() is not None]:
                place, process, log = one
                running.remove(one)
                log.close()
                _take(place, process.returncode)
                done = len(places) - len(waiting) - len(running)
                through = done + len(running) / 2  # those that run are halfway, on the average
                left = (time.monotonic() - began) / through * (len(places) - through)
                end = f"{place.told['modulus'] / 1e3:.3g} MN/m2" if place.told else place.said
                say(f"   {done} of {len(places)}: {place.folder.name}: {end}; {left:.0f} s left")
    finally:
        for _, process, log in running:
            process.terminate()
            process.wait()
            log.close()


def _take(place, code):
    place.code = code
    if code == 0:
        place.told = json.loads((place.folder / "results.json").read_text(encoding="utf-8"))
        return
    lines = (place.folder / "said.txt").read_text(encoding="utf-8", errors="replace").strip().splitlines()
    place.said = lines[-1] if lines else f"exit code {code}"


def write_chart(places: list[Place], folder: pathlib.Path, material: str) -> None:
    """chart.csv and chart.png."""
    with open(folder / "chart.csv", "w", newline="", encoding="utf-8") as file:
        table = csv.writer(file)
        table.writerow(("void_ratio", "suction_kPa", "S_w", "modulus_MPa", "error_MPa", "deflection_mm", "remarks"))
        for place in places:
            told = place.told
            numbers = (
                [
                    f"{told['saturation']:.4g}",
                    f"{told['modulus'] / 1e3:.4g}",
                    f"{told['error'] / 1e3:.2g}",
                    f"{1e3 * told['deflection']:.4g}",
                    "; ".join(told["warnings"]),
                ]
                if told
                else ["", "", "", "", place.said]
            )
            table.writerow((f"{place.void_ratio:g}", f"{place.suction:g}", *numbers))
    _draw(places, folder / "chart.png", material)


@style()
def _draw(places: list[Place], path: pathlib.Path, material: str) -> None:
    """The modulus against suction, saturation and void ratio."""
    plt = pyplot()
    figure, axes = plt.subplots(1, 3, figsize=(12, 4), constrained_layout=True, sharey=True)
    ratios, suctions = ([*dict.fromkeys(getattr(p, n) for p in places)] for n in ("void_ratio", "suction"))

    def draw(ax, kept, along, label, i):
        rows = sorted((along(p), p.told["modulus"] / 1e3, p.told["error"] / 1e3) for p in kept if p.told)
        if rows:
            x, y, error = zip(*rows)
            ax.errorbar(x, y, error, color=COLOURS[i % 6], ls=LINES[i % 6], marker="os^Dv*"[i % 6], mfc="w", capsize=3)
            beside = {"xytext": (8, 0), "textcoords": "offset points", "va": "center"}
            ax.annotate(label, (x[-1], y[-1]), fontsize=8, color=COLOURS[i % 6], **beside)

    for i, ratio in enumerate(ratios):
        kept = [p for p in places if p.void_ratio == ratio]
        draw(axes[0], kept, lambda p: p.suction, f"e = {ratio:g}", i)
        draw(axes[1], kept, lambda p: p.told["saturation"], f"e = {ratio:g}", i)
    for i, suction in enumerate(suctions):
        draw(axes[2], [p for p in places if p.suction == suction], lambda p: p.void_ratio, f"{suction:g} kPa", i)
    if min(suctions) > 0 and max(suctions) / min(suctions) > 8:
        axes[0].set_xscale("log")
    for ax, label in zip(axes, ("suction [kPa]", "degree of saturation [-]", "void ratio [-]")):
        ax.set_xlabel(label)
        ax.margins(x=0.15)
    axes[0].set_ylabel("modulus [MN/m2]")
    axes[0].set_ylim(bottom=0)
    figure.suptitle(material, fontsize=10)
    figure.savefig(path, dpi=130)
    plt.close(figure)
