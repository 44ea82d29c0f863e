"""One soil sample through the assembled equations against the element driver: effective stress and S_w."""
import csv
import pathlib
import subprocess
import sys

here = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(here.parent))
import numpy as np  # noqa: E402
from host_tools import Checks, arguments, build, figure, read, root, run, scratch  # noqa: E402


def driver(case):
    out = scratch() / "out.csv"
    subprocess.run([build / "drivers/mud_triax", case, "--output", out, "--quiet"], check=True)
    rows = list(csv.DictReader(line for line in out.read_text().splitlines() if not line.startswith("#")))
    return {k: np.array([float(r[k]) for r in rows]) for k in rows[0]}


args = arguments(__doc__)
checks = Checks("element")
results = {}
for name, case in (("saturated", root / "drivers/cases/undrained_e735_p100.nml"), ("suction", here / "drained_s100.nml")):
    d = driver(case)
    for call in ("mud_update", "umat"):
        if args.quick and call == "umat" and name == "saturated":
            continue
        steps = [("material_call = 'mud_update'", f"material_call = '{call}'")]
        h = read(run(here / f"{name}.nml", steps) / "histories.csv")
        strain = 0.1 * h["time"] / h["time"][-1]
        at = [int(np.argmin(abs(d["eps_a"] - e))) for e in strain]
        p = -(h["soil.s_rr"] + h["soil.s_zz"] + h["soil.s_tt"]) / 3
        q = h["soil.s_rr"] - h["soil.s_zz"]
        # The same increments and the same library; what differs is Newton's tolerance and the flow of the interior.
        checks.small(f"{name}, {call}: p' / p'", np.max(abs(p / d["p_eff"][at] - 1)), 1e-4)
        checks.small(f"{name}, {call}: q / p'", np.max(abs(q - d["q"][at]) / d["p_eff"][at]), 1e-4)
        checks.near(f"{name}, {call}: S_w", h["soil.S_w"], d["s_w"][at], 1e-4)
        results[name, call] = strain, p, q
        if call == "umat":
            same = [np.max(abs(a - b)) for a, b in zip(results[name, "umat"], results[name, "mud_update"])]
            checks.small(f"{name}: umat_ against mud_update [kPa]", max(same), 1e-6)
    if args.plot:
        results[name, "driver"] = d
if args.plot:
    fig, axes = figure(2)
    for axis, name in zip(axes, ("saturated", "suction")):
        d = results[name, "driver"]
        inside = d["eps_a"] <= 0.1001
        for key, symbol, colour in (("p_eff", "p'", "C0"), ("q", "q", "C1")):
            axis.plot(100 * d["eps_a"][inside], d[key][inside], color=colour, label=f"{symbol}, driver")
        strain, p, q = results[name, "mud_update"]
        axis.plot(100 * strain[::6], p[::6], "o", ms=3, color="C0", label="host")
        axis.plot(100 * strain[::6], q[::6], "o", ms=3, color="C1")
        axis.set(xlabel="axial strain [%]", ylabel="kPa",
                 title="undrained, saturated" if name == "saturated" else "drained, suction 100 kPa")
        axis.legend()
    fig.savefig(here / "element.png", dpi=130)
checks.end()
