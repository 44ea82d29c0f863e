"""Indentation of unsaturated soil by a rigid plate: balances of momentum and energy of the run, and what it shows."""
import pathlib
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
import analysis  # noqa: E402
import figures  # noqa: E402
import series  # noqa: E402
from host_tools import Checks, arguments, number, read, root, run  # noqa: E402

args = arguments(__doc__)
checks = Checks("indentation")
scene = here / "indent_s030.nml"
text = scene.read_text(encoding="utf-8")
folder = run(scene, [("duration = 0.03999", "duration = 1.5e-3")] if args.quick else [])
c, ledger, h = (read(folder / name) for name in ("contact.csv", "ledger.csv", "histories.csv"))
impact = ledger["stage"] == 3
seated = np.flatnonzero(ledger["stage"] == 2)[-1]
t, mass = c["time"][impact] - 2, number(text, "mass")
weight = 9.81 * mass

# The seat is in equilibrium to 1e-8 of all forces; the plate's weight is about 1e-3 of these, hence 1e-4. The paper's eq. (24) at
# 30 kPa and e = 0.8 gives S_w.
checks.near("thrust of the seated plate / its weight", c["interface.thrust"][seated] / weight, 1.0, 1e-4)
exact = 1 / np.log(np.e + (30 * 0.8**2 / 5)**2)
checks.near("S_w at the start", h["centre.S_w"][0], exact, 1e-12)
# Impulse of load and weight against that of the contact and the plate's momentum, at the level of values within each step; what the
# scheme leaves at the end is of the order of dt m times the last acceleration.
load = (c["plate.load"][seated:-1] + (c["plate.load"][impact] - c["plate.load"][seated:-1]) / (1 + number(text, "rho_inf")))[-len(t):]
impulse = np.sum(load * c["dt"][impact])
missing = impulse + np.sum(c["interface.thrust"][impact] * c["dt"][impact]) - mass * c["plate.v_z"][-1]
checks.small("impulse left open / impulse of the load", abs(missing / impulse), 1e-3)
# Energy: what the ledger leaves open of the impact, against its largest entry.
entries = ("kinetic", "skeleton", "pores", "gravity", "loads", "supports")
largest = max(np.abs(ledger[name][impact] - ledger[name][seated]).max() for name in entries)
left = np.abs(ledger["imbalance"][impact] - ledger["imbalance"][seated]).max()
checks.small("energy left open / largest entry of the ledger", left / largest, 1e-3)
# The committed series is of this program: the history of its analysis at 30 kPa, written with six digits. Loading is smooth; rounding does
# not grow before the first unloading.
kept = read(analysis.RESULTS / "histories/s0030_remedy.csv")
common = kept["t_ms"] <= min(1e3 * t[-1], 14) + 1e-6
place = np.rint(kept["t_ms"][common] / (1e3 * analysis.DT)).astype(int)
now = -1e3 * (h["centre.u_z"][-len(t) - 1:] - h["centre.u_z"][-len(t) - 1])
checks.near("displacement / that of the committed series", now[place] / now[place].max(), kept["u_mm"][common] / now[place].max(), 1e-4)
# The page says what the committed results say.
rows = analysis.read_rows(analysis.RESULTS / "series.csv")
page = (here / "README.md").read_text(encoding="utf-8")
checks.small("tables of the page that are not those of results/", sum(text.rstrip() not in page for text in (
    series.table_1(rows) + "\n" + series.statements(rows, analysis.RESULTS), series.details(rows))), 0)
if not args.quick:
    depth = -1e3 * (h["centre.u_z"][-len(t):] - h["centre.u_z"][-len(t) - 1])
    gone = t[(c["interface.thrust"][impact] <= 0) & (t > 0.014)]
    print(f"  {len(t)} steps, {ledger['iterations'][impact].sum():.0f} iterations, {np.sum(ledger['iterations'][impact] > 1)} steps with more than one")
    print(f"  largest indentation {depth.max():.4f} mm at {1e3 * t[depth.argmax()]:.2f} ms, {depth[-1]:.4f} mm at the end; contact lost at {1e3 * gone[0]:.2f} ms")
    for name in ("p_w", "p_c", "S_w"):
        value = h["centre." + name][-len(t):]
        print(f"  {name} under the centre: {value[0]:.5g}, {value.min():.5g} to {value.max():.5g}")
    print("  " + (folder / "log.txt").read_text(encoding="utf-8").strip().splitlines()[-1])
if args.plot:
    picture = root / "build/verification/indentation.png"
    picture.parent.mkdir(parents=True, exist_ok=True)
    print(f"figure {figures.interface({'remedy': analysis.histories(folder, 1)}, picture)}")
checks.end()
