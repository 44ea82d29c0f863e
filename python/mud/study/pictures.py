# SPDX-License-Identifier: MIT
"""Pictures of studies. Curves are told apart by marks and dashes, and carry their names themselves."""

from __future__ import annotations


def _pyplot():
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    return plt


def accuracy_picture(path, result, asked):
    """Total and parts of the worst answer against the time of the run, over the pairs that were measured."""
    plt = _pyplot()
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
        axes.annotate(
            f"F {p.fineness:g}\na {p.tolerance:.2g}",
            (p.run.seconds, p.errors[worst].total),
            fontsize=7,
            xytext=(0, 6),
            textcoords="offset points",
            ha="center",
        )
    axes.axhline(asked, color="0.6", lw=1)
    axes.annotate("asked", (min(seconds), asked), fontsize=8, va="bottom", color="0.4")
    axes.margins(0.2)
    axes.set(xlabel="time of the run [s]", ylabel=f"error of {worst} [-]", title=result.state)
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)


def price_picture(path, study, rows):
    """Error of the worst answer against time: runs that were measured, and what others are expected to take."""
    plt = _pyplot()
    figure, axes = plt.subplots(figsize=(6, 4))
    for fineness, mark in zip(study.finenesses(), "^osDv"):
        line = study.front(fineness)
        axes.loglog(*zip(*line), "--", marker=mark, color="0.5", mfc="w", lw=0.8, ms=4)
        axes.annotate(
            f"F {fineness:g}, expected",
            line[-1],
            fontsize=7,
            color="0.4",
            xytext=(4, -4),
            textcoords="offset points",
            va="top",
        )
    pairs = sorted(study.pairs, key=lambda p: p.run.seconds)
    axes.loglog([p.run.seconds for p in pairs], [p.total for p in pairs], "s", color="k")
    front = [p for i, p in enumerate(pairs) if p.total <= min(q.total for q in pairs[: i + 1])]
    axes.loglog([p.run.seconds for p in front], [p.total for p in front], "-", color="k", lw=1.5)
    axes.annotate(
        "measured",
        (front[-1].run.seconds, front[-1].total),
        fontsize=8,
        xytext=(-6, -12),
        ha="right",
        textcoords="offset points",
    )
    for level, *_ in rows:
        axes.axhline(level, color="0.7", lw=0.7)
        axes.annotate(f"{100 * level:g} %", (0.01, level), xycoords=("axes fraction", "data"), fontsize=7, va="bottom")
    axes.margins(x=0.3, y=0.1)
    axes.set(xlabel="time of the run [s]", ylabel="error of the worst answer [-]")
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)


def effects_picture(path, rows, tolerance):
    """Influence of each effect that was tried; what stays is filled."""
    plt = _pyplot()
    tried = [r for r in rows if r.influence is not None]
    figure, axes = plt.subplots(figsize=(6, 0.6 + 0.3 * max(1, len(tried))))
    for i, r in enumerate(tried):
        axes.plot([max(r.influence, 1e-6)], [i], "o", color="k", mfc="k" if r.on else "w")
        axes.annotate(f"  {r.answer}", (max(r.influence, 1e-6), i), fontsize=7, va="center")
    axes.axvline(tolerance / 2, color="0.6", lw=1)
    axes.set(xscale="log", yticks=range(len(tried)), xlabel="largest change of an answer without it [-]; filled: stays")
    axes.set_yticklabels([r.name for r in tried], fontsize=8)
    axes.margins(0.2)
    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)
