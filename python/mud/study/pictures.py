# SPDX-License-Identifier: MIT
"""Pictures of studies. Curves are told apart by marks and dashes, and carry their names themselves."""

from __future__ import annotations


def accuracy_picture(path, result, asked):
    """Total and parts of the worst answer against the time of the run, over the pairs that were measured."""
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    pairs = result.pairs
    worst = result.last.worst
    pairs = [p for p in pairs if worst in p.errors]
    seconds = [p.run.seconds for p in pairs]
    figure, axes = plt.subplots(figsize=(6, 4))
    for part, mark, dash in (("total", "s", "-"), ("mesh", "^", "--"), ("steps", "o", ":"), ("newton", "x", "-.")):
        values = [max(getattr(p.errors[worst], part), 1e-7) for p in pairs]
        if max(values) <= 1e-6:
            continue
        axes.loglog(seconds, values, dash, marker=mark, color="k", mfc="w", lw=1)
        axes.annotate(" " + {"newton": "Newton"}.get(part, part), (seconds[-1], values[-1]), va="center", fontsize=8)
    for p in pairs:
        axes.annotate(f"F {p.fineness:g}\na {p.tolerance:.2g}", (p.run.seconds, p.errors[worst].total), fontsize=7,
                      xytext=(0, 6), textcoords="offset points", ha="center")
    axes.axhline(asked, color="0.6", lw=1)
    axes.annotate("asked", (min(seconds), asked), fontsize=8, va="bottom", color="0.4")
    axes.margins(0.2)
    axes.set(xlabel="time of the run [s]", ylabel=f"error of {worst} [-]", title=result.state)
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)
