# SPDX-License-Identifier: MIT
"""Writes paths_rates.csv: 200 single evaluations of the rates of docs/theory/material.md section 4 (default parameters, memory held)."""

import numpy as np

from tools.results import folder

from reference_rates import I3, Params, Point, dd, dev, norm, rates, six, tensor

P = Params()
rng = np.random.default_rng(20240521)


def rdev(size):
    a = dev(tensor(rng.normal(size=6)))
    return size * a / norm(a)


def rounded_dev(a):
    c = np.round(six(a), 6)
    c[2] = np.round(-(c[0] + c[1]), 6)
    return tensor(c)


def sample(kind):
    """A random case, every input rounded to a short decimal number so that the file holds it exactly."""
    e = round(rng.uniform(0.68, 0.98), 4)
    p = 10 ** rng.uniform(np.log10(20), 3)
    pc = [0.0, 3.0, 30.0, 100.0][rng.integers(4)]
    pc = round(pc * rng.uniform(0.5, 1.5), 3)
    z = rdev(rng.uniform(0, 3.5))
    r = rdev(rng.uniform(0.05, 1.0))
    gap = rng.uniform(0.02, 0.8)
    if kind == "floor":
        gap = 10 ** rng.uniform(-5, -2.6)
    if kind == "contraction":
        e = round(rng.uniform(0.9, 1.25), 4)
        p = 10 ** rng.uniform(1.5, 4)
        z = rdev(rng.uniform(2, 4))
        r = rdev(rng.uniform(0.6, 1.2))
    if kind == "softening":
        r = rdev(rng.uniform(1.0, 1.6))
        gap = 10 ** rng.uniform(-4, -1.0)
        p = 10 ** rng.uniform(2, 3.7)
        e = round(rng.uniform(0.75, 1.0), 4)
    if kind == "multi":
        r = rdev(rng.uniform(0.7, 1.4))
        gap = 10 ** rng.uniform(-3.5, -1.0)
    if kind == "dense line":
        p = 10 ** rng.uniform(3.0, 4.2)
        r = rdev(rng.uniform(0.0, 0.5))
    if kind == "low":
        p = rng.uniform(0.03, 0.4)
    sig = tensor(np.round(six(p * (I3 + r)), 5))
    rho = rdev(gap)
    de = rdev(1.0)
    if kind == "generic":
        rho = gap * dev(rho / norm(rho) * 0.6 + de)
    if kind in ("multi", "softening", "contraction"):
        de = 0.7 * r / norm(r) + 0.7 * rdev(1.0)
    if kind == "softening":
        de = r / norm(r) + 0.4 * rdev(1.0)
    if kind == "isotropic":
        de = 0.0 * de
    r_in = r - rho
    size = 10 ** rng.uniform(-5, -3)
    dv = rng.normal() * 0.5
    if kind in ("isotropic", "dense line"):
        dv = abs(rng.normal()) + 0.2
    if kind == "wetting":
        pc = round(rng.uniform(5, 120), 3)
    deps = tensor([float(f"{v:.5e}") for v in six(size * (de + dv * I3 / 3.0))])
    dpc = 0.0
    if pc > 0.0 and rng.uniform() < 0.7 or kind == "wetting":
        dpc = float(f"{pc * rng.normal() * size * 30:.4e}")
    if kind == "wetting":
        dpc = -abs(dpc)
        r = None
    return dict(sig=sig, e=e, pc=pc, z=rounded_dev(z), r_in=rounded_dev(r_in), deps=deps, dpc=dpc, kind=kind)


def specials():
    """Corners: r = 0, proportional, suction only, volumetric only, below p_min."""
    O = np.zeros((3, 3))
    S = lambda *a: tensor(np.array(a, float))
    base = dict(e=0.8, pc=0.0, z=O, r_in=O, dpc=0.0)
    yield dict(base, sig=S(100, 100, 100, 0, 0, 0), deps=S(1e-4, -5e-5, -5e-5, 0, 0, 0), kind="special")
    yield dict(base, sig=S(100, 100, 100, 0, 0, 0), deps=S(1e-4, 1e-4, 1e-4, 0, 0, 0), kind="special")
    yield dict(base, sig=S(100, 100, 100, 0, 0, 0), deps=S(-1e-4, -1e-4, -1e-4, 0, 0, 0), kind="special")
    yield dict(base, sig=S(100, 100, 100, 0, 0, 0), deps=S(1e-4, 2e-5, -5e-5, 3e-5, -4e-5, 6e-5), kind="special")
    yield dict(base, sig=S(160, 70, 70, 0, 0, 0), deps=S(1e-4, 0, 0, 0, 0, 0), kind="special")
    yield dict(base, sig=S(70, 160, 70, 0, 0, 0), deps=S(0, -1e-4, 0, 0, 0, 0), kind="special")
    yield dict(base, sig=S(160, 70, 70, 0, 0, 0), deps=S(-1e-4, 0, 0, 0, 0, 0), r_in=S(0.5, -0.25, -0.25, 0, 0, 0), kind="special")
    yield dict(base, sig=S(100, 80, 60, 10, -5, 8), deps=O, pc=60.0, dpc=-1.0, kind="special")
    yield dict(base, sig=S(100, 80, 60, 10, -5, 8), deps=O, pc=60.0, dpc=1.0, kind="special")
    yield dict(base, sig=S(100, 100, 100, 0, 0, 0), deps=O, pc=60.0, dpc=-1.0, kind="special")
    yield dict(base, sig=S(100, 80, 60, 10, -5, 8), deps=O, pc=0.0, dpc=0.0, kind="special")
    yield dict(base, sig=S(0.09, 0.04, 0.03, 0.01, -0.02, 0.005), deps=S(1e-6, 2e-6, -4e-6, 1e-6, 2e-6, -1e-6), kind="special")
    yield dict(base, sig=S(0.12, 0.05, 0.06, 0.03, -0.01, 0.02), deps=S(4e-6, 2e-6, -1e-6, 1e-6, -2e-6, 3e-6), kind="special")
    yield dict(base, sig=S(9000, 8600, 8100, 300, -200, 150), deps=S(1e-4, 0, 0, 0, 0, 0), kind="special")
    yield dict(base, sig=S(200, 150, 120, 20, -30, 10), deps=S(1e-4, 2e-5, -5e-5, 3e-5, -4e-5, 6e-5), pc=-15.0, dpc=2.0, kind="special")


def rejected():
    """Cases found by random search where the second solution (mechanism on) contradicts itself and the first is kept."""
    for sig, e, pc, z, r_in, deps, dpc in (
        ((10947.29547, 10129.28092, 6136.49282, -53.30522, 2798.93509, 1451.05845), 1.211, 32.615,
         (-1.152154, -0.162381, 1.314535, 0.835228, 0.338744, 0.753378),
         (0.222916, 0.091779, -0.314695, 0.047898, 0.203556, -0.027203),
         (4.40111e-06, -2.49772e-07, 1.68472e-06, 2.89192e-06, 1.1314e-06, 5.90015e-07), 0.0016094),
        ((5129.70038, 5344.42076, 4002.91327, 615.78136, 59.74168, 2217.06361), 1.2356, 76.05,
         (-0.836147, 1.458845, -0.622698, -0.454227, 1.474912, 0.837791),
         (0.065498, 0.125665, -0.191163, 0.153384, -0.027069, 0.424491),
         (7.09945e-05, 0.000163025, -1.16527e-05, 0.000131914, 4.29161e-05, 0.000131397), -0.41572),
        ((1112.11281, 1925.09395, 1650.50262, 586.29361, 336.13766, 279.46373), 0.9775, 1.618,
         (-0.232896, 1.0434, -0.810504, 0.244804, 1.182903, -0.098025),
         (-0.567454, 0.556441, 0.011013, 0.202447, 0.176997, 0.363962),
         (1.12042e-05, 1.68732e-05, -1.27519e-05, 4.64808e-05, 2.7259e-05, -1.1113e-05), 0.0),
        ((4854.97043, 3165.74648, 4676.55067, 1282.01991, 935.454, -674.32345), 1.1444, 39.544,
         (-0.029323, -0.247328, 0.276651, 2.30956, 1.253181, 0.042754),
         (-0.202512, -0.091189, 0.293701, 0.072103, 0.455758, -0.08472),
         (2.28198e-05, -6.68534e-06, 2.1979e-05, 5.53325e-06, 1.85877e-05, 1.13457e-05), -0.03895)):
        yield dict(sig=tensor(sig), e=e, pc=pc, z=tensor(z), r_in=tensor(r_in), deps=tensor(deps), dpc=dpc, kind="rejected")


def evaluate(c, nscan=8001, refine=True):
    return rates(c["sig"], c["e"], c["pc"], c["z"], c["r_in"], c["deps"], c["dpc"], P, nscan=nscan, refine=refine)


def residual(c, q):
    """The equations of docs/theory/material.md section 4 written out with the answer put in (not the way it was solved)."""
    pt = Point(c["sig"], c["e"], c["pc"], c["z"], c["r_in"], P)
    if np.trace(c["sig"]) / 3.0 <= P.p_min:
        return 0.0
    ds, dp = dev(q.dsig), np.trace(q.dsig) / 3.0
    dr = (ds - pt.r * dp) / pt.p
    dv, de = np.trace(c["deps"]), dev(c["deps"])
    iso = max(pt.A * dp / pt.p + pt.B1 * c["dpc"], 0.0) if q.iso == 1 else 0.0
    L, n = q.L, q.n
    out = []
    if n is None:
        D = 0.0
    else:
        import math
        g = (2 * P.c**4 / (1 + P.c**4 - (1 - P.c**4) * math.sqrt(6) * np.trace(n @ n @ n))) ** 0.25
        D = P.A0 * (1 + max(dd(c["z"], n), 0)) * (math.sqrt(2 / 3) * g * pt.Md - dd(pt.r, n))
        Ke = pt.K / (1 + pt.K * pt.A / pt.p) if q.iso == 1 else pt.K
        Rb = math.sqrt(2 / 3) * g * pt.Mb
        rn = dd(pt.r, n)
        if rn > 0:
            D = min(D, 0.95 * 2 * pt.G / (Ke * rn))
        hb = max(dd(pt.r - c["r_in"], n), P.x0) / pt.b0
        if rn > Rb:
            hb = max(hb, 2 / 3 * pt.p * (rn - Rb) / (0.5 * (2 * pt.G - Ke * D * rn)))
        out.append(norm(dr - 2 / 3 * L / hb * (Rb * n - pt.r)) / max(norm(dr), norm(2 * pt.G * de) / pt.p))
        out.append(abs(norm(n) - 1) + abs(np.trace(n)))
    de_el = de - (L * n if n is not None else 0.0)
    scale = max(norm(2 * pt.G * de), abs(pt.K * dv), norm(q.dsig), 1e-300)
    out.append(norm(ds - 2 * pt.G * de_el) / scale)
    out.append(abs(dp - pt.K * (dv - L * D - iso)) / scale)
    return max(out)


def uncertainty(c, q):
    """Relative change of the answer when every input moves by about 1e-13: the conditioning of the case."""
    worst = 0.0
    for k in range(3):
        f = lambda a: a * (1 + 1e-13 * rng.uniform(-1, 1, size=(3, 3)))
        c2 = dict(c)
        for name in ("sig", "z", "r_in", "deps"):
            m = f(c[name])
            c2[name] = (m + m.T) / 2
        q2 = evaluate(c2, nscan=801)
        s = norm(q.dsig)
        worst = max(worst, norm(q2.dsig - q.dsig) / max(s, 1e-300), 0.0 if q2.iso == q.iso and q2.roots == q.roots else 1.0)
    return worst


def main():
    wanted = {"generic": 66, "floor": 25, "contraction": 25, "softening": 25, "multi": 18, "dense line": 12, "low": 5,
              "isotropic": 5}
    cases = list(specials()) + list(rejected())
    stats = {}
    for kind, count in wanted.items():
        got = tries = 0
        while got < count:
            tries += 1
            c = sample(kind)
            q = evaluate(c, nscan=241, refine=False)
            fl = q.flags
            if kind == "floor" and not fl.get("floor"):
                continue
            if kind == "contraction" and not fl.get("ccap"):
                continue
            if kind == "softening" and not fl.get("scap"):
                continue
            if kind == "multi" and q.roots < 2:
                continue
            if kind == "isotropic" and q.iso != 1:
                continue
            if kind == "isotropic" and got < 2:
                c["sig"] = round(np.trace(c["sig"]) / 3.0) * I3
                c["deps"] = 2.0 ** -13 * I3
                q = evaluate(c)
            q = evaluate(c)
            if len(q.all_roots) > 1 and abs(abs(q.all_roots[1]) - abs(q.all_roots[0])) < 1e-3:
                continue
            if q.n is not None and uncertainty(c, q) > 1e-9:
                continue
            cases.append(c)
            got += 1
        stats[kind] = (got, tries)
    n_fill = 200 - len(cases)
    while n_fill > 0:
        c = sample("wetting")
        q = evaluate(c)
        if q.iso == 0 and n_fill > 3 or uncertainty(c, q) > 1e-9:
            continue
        cases.append(c)
        n_fill -= 1
    rows, res, unc = [], [], []
    tot = dict(floor=0, ccap=0, scap=0, iso1=0, iso2=0, multi=0, elastic=0)
    for i, c in enumerate(cases, 1):
        q = evaluate(c)
        q0 = evaluate(c, nscan=121, refine=False)
        assert norm(q0.dsig - q.dsig) <= 1e-10 * max(norm(q.dsig), 1e-30), (i, c["kind"])
        res.append(residual(c, q))
        unc.append(uncertainty(c, q) if q.n is not None else 0.0)
        fl = q.flags
        mask = (1 if fl.get("floor") else 0) + (2 if fl.get("ccap") else 0) + (4 if fl.get("scap") else 0)
        tot["floor"] += mask & 1
        tot["ccap"] += mask >> 1 & 1
        tot["scap"] += mask >> 2 & 1
        tot["iso1"] += q.iso == 1
        tot["iso2"] += q.iso == 2
        tot["multi"] += q.roots > 1
        tot["elastic"] += q.n is None
        n = six(q.n) if q.n is not None else np.zeros(6)
        ins = [*six(c["sig"]), c["e"], c["pc"], *six(c["z"]), *six(c["r_in"]), *six(c["deps"]), c["dpc"]]
        outs = [*six(q.dsig), *six(q.dz), q.deqp, *n, q.x]
        rows.append(",".join([str(i)] + [f"{v + 0.0:.12g}" for v in ins] + [str(q.iso), str(q.roots), str(mask)]
                             + [f"{v + 0.0:.12e}" for v in outs]))
    zero = " ".join(str(i) for i, c in enumerate(cases, 1) if evaluate(c).n is None)
    head = [
        "# 200 single evaluations of the MUD rates; made by mud_reference.py (make_rates.py), independent of the library",
        "# default parameters (paper Tables 2 and 3, p_atm 101.325, theta 0.2, x_0 3e-3, kappa_c 0.5, all guards and effects on)",
        "# units kPa and -, compression positive, true tensor shear, component order 11 22 33 12 13 23",
        "# sig = effective stress; the memory r_in is held: NO reset test is made even where x < -x_rev",
        "# all inputs are exact short decimals; r_in and z are traceless",
        "# results are of degree one in (deps, dpc): they are increments for the given deps, dpc",
        "# iso: 0 isotropic mechanism off, 1 on, 2 second solution rejected (the first is kept)",
        "# nroots: admissible angles of the final solve; the smallest |w| is taken; 0 = L zero (purely volumetric or no increment)",
        "# guards: 1 floor + 2 contraction cap + 4 softening cap active at the root of the final solve; x = (r - r_in):n before the floor",
        f"# counts: {tot}",
        f"# largest residual of the written-out equations {max(res):.1e} (relative); largest relative change of dsig for a 1e-13 change of the inputs {max(unc):.1e}",
        "# uncertainty of every result: 1e-10 relative to the norm of its tensor (estimated; most are at 1e-12)",
        f"# t = 0 (L = 0) in the rows {zero}: rounding may turn t into noise there; do not compare nroots, n, x of these rows",
        "# id, sig(6), e, p_c, z(6), r_in(6), deps(6), dpc, iso, nroots, guards, dsig(6), dz(6), deps_q^p, n(6), x",
    ]
    with open(folder(__file__) / "paths_rates.csv", "w") as fh:
        fh.write("\n".join(head + rows) + "\n")
    print(stats, tot, "max residual", max(res), "max change", max(unc), "residual>1e-11:", [i + 1 for i, v in enumerate(res) if v > 1e-11])


if __name__ == "__main__":
    main()
