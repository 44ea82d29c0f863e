# SPDX-License-Identifier: MIT
"""What the remedy costs: instructions of the stress integration with and without it on strain paths of the benchmark.

Runs the indentation at three suctions with more points of output, takes the strain of three elements from their nodes
step by step, and counts (valgrind, callgrind) the instructions of mud_update along these paths: results/cost.csv. Ten
minutes:
`verification/run indentation --make --only cost.py`.
"""
import argparse
import ctypes
import re
import subprocess
import sys

import numpy as np
from analysis import Job, build, impact_of, program, read_rows, results_folder, root, run_all, scene, write_rows
from tools.bench import AS_PUBLISHED

FOLDER = root / "build/indentation"
PROPS, STATEV = 1, 2   # enum mud_list
SUCTIONS = (30, 200, 1000)
# Entries of PROPS. With a threshold of 1e-12 no process is ever interrupted: the integration takes exactly the path of
# `classic`, and what it does more is the remedy's bookkeeping.
RULES = {"classic": dict(memory_rule=0), "remedy, never acting": dict(memory_rule=1, eps_hat=1e-12),
         "remedy": dict(memory_rule=1), "as_published": AS_PUBLISHED}


def axis(breaks, cells, ratios):
    """Ends of the cells of the built-in mesh."""
    x = [breaks[0]]
    for a, b, n, ratio in zip(breaks, breaks[1:], cells, ratios):
        size = ratio ** np.arange(n)
        x += list(a + (b - a) * np.cumsum(size) / size.sum())
    return np.array(x)


def triangles(groups):
    """Corners of right triangles between nodes of the mesh: under the centre, under the rim, one radius deep."""
    mesh = next(k for g, k in groups if g == "mesh")
    values = {key: [float(v) for v in text.replace(",", " ").split()] for key, text in mesh.items()}
    r = axis(values["r"], [int(n) for n in values["r_cells"]], values["r_ratio"])
    z = axis(values["z"], [int(n) for n in values["z_cells"]], values["z_ratio"])
    rim = int(np.argmin(abs(r - 0.15)))
    deep = int(np.argmin(abs(z + 0.15)))
    corner = {"centre": (0, len(z) - 1), "rim": (rim - 1, len(z) - 1), "deep": (1, deep)}
    return {name: np.array([(r[i], z[j]), (r[i + 1], z[j]), (r[i], z[j - 1])]) for name, (i, j) in corner.items()}


def six(corners):
    a, b, c = corners
    return [a, b, c, (a + b) / 2, (b + c) / 2, (c + a) / 2]


def recording(suction):
    groups = scene(suction, "u-p_w-p_c", "as_published")
    for name, corners in triangles(groups).items():
        for i, (r, z) in enumerate(six(corners)):
            groups.append(("point", dict(name=f"'{name}{i}'", r=f"{r:.10g}", z=f"{z:.10g}")))
    return Job(f"path_{suction:04d}", groups, FOLDER, suction=suction)


def path_of(job, name, corners):
    """Stress, void ratio and suction at the start; strain (library's order and signs) and suction of every step."""
    h = impact_of(job.folder)["histories"]
    x = np.array(six(corners))
    # Slopes of the six shape functions at the centroid, by the gradient of the barycentric coordinates.
    edge = np.array([corners[1] - corners[0], corners[2] - corners[0]])
    g1, g2 = np.linalg.inv(edge).T
    g = np.array([-g1 - g2, g1, g2])
    slope = [(4 / 3 - 1) * g[i] for i in range(3)] + [4 / 3 * (g[i] + g[j]) for i, j in ((0, 1), (1, 2), (2, 0))]
    shape = np.array([-1 / 9] * 3 + [4 / 9] * 3)
    assert np.allclose(sum(s[:, None] * p for s, p in zip(slope, x)), np.eye(2)), "the slopes do not fit the triangle"
    u = np.array([[h[f"{name}{i}.u_r"], h[f"{name}{i}.u_z"]] for i in range(6)])
    d = np.einsum("nk,nct->kct", np.array(slope), u)
    hoop = np.einsum("n,nt->t", shape, u[:, 0]) / (shape @ x[:, 0])
    zero = 0 * hoop
    strain = np.array([d[0, 0], d[1, 1], hoop, d[1, 0] + d[0, 1], zero, zero])
    at_start = [float(np.mean([h[f"{name}{i}.{c}"][0] for i in range(3)])) for c in ("s_rr", "s_zz", "s_tt", "s_rz")]
    suction = np.einsum("n,nt->t", shape, np.array([h[f"{name}{i}.p_c"] for i in range(6)]))
    return {"start": np.array([*at_start, 0.0, 0.0, h[f"{name}0.e"][0]]), "strain": np.diff(strain).T,
            "suction": suction}


def walk(file, rule, tangent):
    """Along a recorded path through the library; callgrind counts kernel_point alone, which mud_update ends in."""
    path = np.load(file)
    mud = ctypes.CDLL(str(build / "umat/libmud.so"))
    double = ctypes.POINTER(ctypes.c_double)
    n_props, n_state = mud.mud_count(PROPS), mud.mud_count(STATEV)
    props, state = np.zeros(n_props), np.zeros(n_state)

    def of(array):
        return array.ctypes.data_as(double)
    mud.mud_default_props(of(props), n_props)
    for key, value in {"rho_e": 0.0, **RULES[rule]}.items():
        props[mud.mud_index(PROPS, key.encode())] = value
    stress = path["start"][:6].copy()
    text = ctypes.create_string_buffer(200)
    material = np.zeros(mud.mud_prepared_size())
    if mud.mud_prepare(of(props), n_props, of(material), len(material), text, 200) or mud.mud_init(
            of(material), of(stress), ctypes.c_double(path["suction"][0]), ctypes.c_double(path["start"][6]),
            ctypes.c_double(0.0), of(state), n_state, text, 200):
        sys.exit(text.value.decode())
    blocks = np.zeros(50)
    for d, q in zip(np.ascontiguousarray(path["strain"]), path["suction"][1:]):
        step = d.copy()
        code = mud.mud_update(of(material), of(stress), of(state), n_state, of(step), ctypes.c_double(q), int(tangent),
                              of(stress), of(state), of(blocks), None)
        if code:
            sys.exit(f"mud_update: {code}")
    print(*(int(state[mud.mud_index(STATEV, key)]) for key in (b"n_rate", b"n_substep", b"n_reset")))


def count(file, rule, tangent=0):
    """(instructions in mud_update, rates, substeps, resets)."""
    done = subprocess.run(["valgrind", "--tool=callgrind", "--toggle-collect=__mud_kernel_MOD_kernel_point",
                           "--callgrind-out-file=/dev/null",
                           sys.executable, __file__, "--walk", file, rule, str(tangent)],
                          capture_output=True, text=True)
    if done.returncode:
        sys.exit(done.stdout + done.stderr)
    return int(re.search(r"Collected : (\d+)", done.stderr)[1]), *(int(v) for v in done.stdout.split())


def report(rows):
    text = ["| path | rule | updates | rate evaluations | resets | instructions | a rate | against `classic`: all | "
            "a rate |",
            "|" + 9 * "---|"]
    for row in rows.values():
        base = rows[f"{row['path']}, classic"]
        each = row["instructions"] / row["rates"]
        text.append(f"| {row['path']} | {row['rule']} | {row['updates']:.0f} | {row['rates']:.0f} | "
                    f"{row['resets']:.0f} "
                    f"| {row['instructions']:.0f} | {each:.0f} | "
                    f"{100 * (row['instructions'] / base['instructions'] - 1):+.2f} % "
                    f"| {100 * (each / (base['instructions'] / base['rates']) - 1):+.2f} % |")
    paths = list(dict.fromkeys(r["path"] for r in rows.values()))
    for rule, what in (("remedy, never acting", "bookkeeping"), ("remedy", "whole remedy")):
        shares = [100 * (rows[f"{p}, {rule}"]["instructions"] / rows[f"{p}, classic"]["instructions"] - 1)
                  for p in paths]
        text.append(f"\n{what.capitalize()}: {min(shares):+.2f} to {max(shares):+.2f} % of the instructions of "
                    f"`classic`, "
                    f"over all paths "
                    f"{100 * (sum(rows[f'{p}, {rule}']['instructions'] for p in paths) / sum(rows[f'{p}, classic']['instructions'] for p in paths) - 1):+.2f} %.")
    return "\n".join(text)


def sixteen(results):
    """Time of the sixteen analyses of Table 1, from the rows of the series."""
    rows = [r for r in read_rows(results / "series.csv").values() if r["series"] in ("remedy", "as_published")
            and r["fields"] != "u-p_w"]
    whole = [r["cpu_s"] for r in rows if r["attempts"] == 1]
    return (f"{len(whole)} of the {len(rows)} analyses of Table 1, those that ran without interruption, took "
            f"{sum(whole) / 60:.1f} min of the processor: "
            f"half of that on two cores that have nothing else to do, two at a time.")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--jobs", type=int, default=2)
    parser.add_argument("--walk", nargs=3, help=argparse.SUPPRESS)
    args = parser.parse_args()
    if args.walk:
        walk(*args.walk)
        return
    results = results_folder(__file__, False)
    jobs = [recording(s) for s in SUCTIONS]
    run_all(jobs, args.jobs, 3600, lambda job: None)
    digest, commit = program()
    rows = {k: r for k, r in read_rows(results / "cost.csv").items() if r["program"] == digest}
    for job in jobs:
        for name, corners in triangles(job.groups).items():
            path = path_of(job, name, corners)
            file = job.folder / f"{name}.npz"
            np.savez(file, **path)
            for rule in RULES:
                title = f"{job.facts['suction']} kPa, {name}"
                if f"{title}, {rule}" in rows:
                    continue
                n, rates, substeps, resets = count(file, rule)
                rows[f"{title}, {rule}"] = dict(name=f"{title}, {rule}", path=title, rule=rule,
                                                updates=len(path["strain"]), rates=rates,
                                                substeps=substeps, resets=resets, instructions=n, program=digest,
                                                commit=commit)
                write_rows(results / "cost.csv", rows)
                print(f"{title}, {rule}: {n} instructions, {rates} rates, {resets} resets", flush=True)
    print(texts(results)["cost"])


def texts(results):
    """The text of README.md by its mark."""
    return {"cost": sixteen(results) + "\n\n" + report(read_rows(results / "cost.csv"))}


if __name__ == "__main__":
    main()
