# SPDX-License-Identifier: MIT
"""One soil sample through the assembled equations against the element driver: effective stress and S_w."""
import numpy as np
from tools import tables
from tools.bench import CASES
from tools.page import Page, Tolerance

PAGE = Page(
    claim="the host's u-p_w-p_c equations and the element driver, two programs over the same library, give "
          "the same results of a test",
    kind="code-to-code",
    input="`saturated.nml` (undrained, e 0.735, p' 100 kPa, K_w 1e12, suction held at 0) and `suction.nml` (drained, e "
          "0.8, p_c 100 kPa, net radial stress held, pressures "
          "prescribed at the top alone): two elements, 0 to 10 % axial strain in 1000 steps, Toyoura sand, consistent "
          "tangent",
    reference="mud_triax: `drivers/cases/undrained_e735_p100.nml`, `drained_s100.nml`",
    seconds=4, quick=3, pictures=("element.png",))

SAME = Tolerance("the same increments and the same library; the differences are Newton's tolerance and the "
                 "flow of the interior", absolute=1e-4)


def check(bench):
    results = {}
    for name, case in (("saturated", CASES / "undrained_e735_p100.nml"), ("suction", bench.here / "drained_s100.nml")):
        d = bench.driver(case)
        results[name, "driver"] = d
        h = tables.columns(bench.host(f"{name}.nml") / "histories.csv")
        strain = 0.1 * h["time"] / h["time"][-1]
        at = [int(np.argmin(abs(d["eps_a"] - e))) for e in strain]
        p = -(h["soil.s_rr"] + h["soil.s_zz"] + h["soil.s_tt"]) / 3
        q = h["soil.s_rr"] - h["soil.s_zz"]
        bench.below(f"{name}: p' / p'", np.max(abs(p / d["p_eff"][at] - 1)), SAME)
        bench.below(f"{name}: q / p'", np.max(abs(q - d["q"][at]) / d["p_eff"][at]), SAME)
        bench.near(f"{name}: S_w", h["soil.S_w"], d["s_w"][at], SAME)
        results[name, "host"] = strain, p, q
    return results


def draw(bench, results, plt):
    figure, axes = plt.subplots(1, 2, figsize=(7.6, 3.2))
    for axis, name in zip(axes, ("saturated", "suction")):
        d = results[name, "driver"]
        inside = d["eps_a"] <= 0.1001
        for key, symbol, colour in (("p_eff", "p'", "C0"), ("q", "q", "C1")):
            axis.plot(100 * d["eps_a"][inside], d[key][inside], color=colour, label=f"{symbol}, driver")
        strain, p, q = results[name, "host"]
        axis.plot(100 * strain[::6], p[::6], "o", ms=3, color="C0", label="host")
        axis.plot(100 * strain[::6], q[::6], "o", ms=3, color="C1")
        axis.set(xlabel="axial strain [%]", ylabel="kPa", title="undrained, saturated" if name == "saturated"
                 else "drained, suction 100 kPa")
        axis.legend()
    bench.save(figure, "element.png")
