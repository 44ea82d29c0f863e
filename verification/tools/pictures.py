# SPDX-License-Identifier: MIT
"""One style for the pictures of all pages."""
COLOURS = ("#0b3c6f", "#c8553d", "#3a8f6a", "#8a5a9e", "#b58900")   # distinct in grey and for colour-blind readers
STYLE = {"font.size": 9, "axes.titlesize": 10, "axes.grid": True, "grid.color": "#dddddd", "grid.linewidth": 0.6,
         "axes.axisbelow": True, "legend.frameon": False, "lines.linewidth": 1.2, "figure.constrained_layout.use": True}


def pyplot():
    """matplotlib.pyplot without a display, in this style."""
    import matplotlib
    matplotlib.use("Agg")
    import matplotlib.pyplot as plt
    plt.rcParams.update(STYLE)
    return plt
