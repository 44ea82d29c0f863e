# SPDX-License-Identifier: MIT
"""Pictures of studies. Curves are told apart by marks and dashes, and carry their names themselves."""

from __future__ import annotations

NOTHING = 1e-6  # errors below are none


def _axes(height=4.0):
    import matplotlib

    matplotlib.use("Agg")
    import matplotlib.pyplot as plt

    figure, axes = plt.subplots(figsize=(6.5, height))
    axes.spines[["top", "right"]].set_visible(False)
    return figure, axes


def _save(figure, path):
    import matplotlib.pyplot as plt

    figure.savefig(path, dpi=130, bbox_inches="tight")
    plt.close(figure)


def _level(axes, value, words):
    axes.axhline(value, color="0.6", lw=0.8)
    where = ("axes fraction", "data")
    axes.annotate(words, (1, value), xycoords=where, fontsize=8, color="0.4", ha="right", va="bottom")


def accuracy_picture(path, study):
    """Total and parts of the worst answer, pair by pair in the order in which they were measured."""
    worst = study.pairs[-1].worst
    pairs = [p for p in study.pairs if worst in p.errors]
    figure, axes = _axes()
    for part, mark, dash in (("total", "s", "-"), ("mesh", "^", "--"), ("steps", "o", ":"), ("newton", "x", "-."),
                             ("stress", "+", "-.")):
        values = [getattr(p.errors[worst], part) for p in pairs]
        if part == "total" or max(values) > NOTHING:
            axes.semilogy([max(x, NOTHING) for x in values], dash, marker=mark, color="k", mfc="w", lw=1,
                          label={"newton": "Newton", "stress": "stress integration"}.get(part, part))
    _level(axes, study.accuracy, "asked")
    axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.01, 0.5))
    words = [f"F {p.fineness:g}\na {p.tolerance:.2g}\n{p.run.seconds:.2g} s" for p in pairs]
    axes.set_xticks(range(len(pairs)), words, fontsize=7)
    axes.set(xlabel="cells F, step tolerance a and time of the run", ylabel=f"error of {worst} [-]", title=study.state)
    axes.margins(x=0.1, y=0.1)
    _save(figure, path)


def price_picture(path, study, rows):
    """Error of the worst answer against time: runs that were measured, and what others are expected to take."""
    figure, axes = _axes()
    pairs = sorted(study.pairs, key=lambda p: p.run.seconds)
    front = [p for i, p in enumerate(pairs) if p.total <= min(q.total for q in pairs[: i + 1])]
    axes.loglog([p.run.seconds for p in pairs], [p.total for p in pairs], "s", color="k", label="measured")
    axes.loglog([p.run.seconds for p in front], [p.total for p in front], "-", color="k", lw=1.2)
    expected = [(row[5], row[4]) for row in rows if row[1] != "met" and row[5] != ""]
    if expected:
        axes.loglog(*zip(*expected), "s", color="k", mfc="w", label="expected")
    for level, *_ in rows:
        _level(axes, level, f"{100 * level:g} %")
    for p in pairs:
        axes.annotate(f"F {p.fineness:g}, a {p.tolerance:.2g}", (p.run.seconds, p.total), fontsize=7, xytext=(5, 4),
                      textcoords="offset points")
    axes.legend(fontsize=8, frameon=False, loc="center left", bbox_to_anchor=(1.01, 0.5))
    axes.margins(x=0.25, y=0.1)
    axes.set(xlabel="time of the run [s]", ylabel="error of the worst answer [-]")
    _save(figure, path)


def effects_picture(path, rows, tolerance):
    """Influence of each effect that was tried; what stays is filled."""
    tried = sorted((r for r in rows if r.influence is not None), key=lambda r: r.influence)
    figure, axes = _axes(1.0 + 0.3 * max(1, len(tried)))
    for i, r in enumerate(tried):
        axes.plot([max(r.influence, NOTHING)], [i], "o", color="k", mfc="k" if r.on else "w")
        axes.annotate(f"  {r.answer}", (max(r.influence, NOTHING), i), fontsize=7, va="center")
    axes.axvline(tolerance / 2, color="0.6", lw=0.8)
    axes.annotate(" matters", (tolerance / 2, 1), xycoords=("data", "axes fraction"), fontsize=8, color="0.4")
    axes.set(xscale="log", xlabel="largest change of an answer without it, over its range [-]; filled: stays")
    axes.set_yticks(range(len(tried)), [r.name for r in tried], fontsize=8)
    axes.margins(0.2)
    _save(figure, path)
