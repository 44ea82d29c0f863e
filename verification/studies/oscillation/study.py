# SPDX-License-Identifier: MIT
"""Noise on element-test paths: how far each memory rule is led away from the clean path, and at what cost.

`verification/run oscillation --make [--pass --groups GROUP ...]` runs the cases (about ten minutes on two cores) and
writes the CSV files.
"""
import argparse
import concurrent.futures
import csv
import itertools
import math
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile
import time

from tools import tables
from tools.bench import GUARDS, ROOT, Bench
from tools.results import folder

sys.path.insert(0, str(ROOT / "verification/material/verdugo_ishihara"))
import laboratory as tests_of_verdugo_ishihara  # noqa: E402

RULES = {"classic": (0, 0.0), "threshold": (1, 0.0), "repositioning": (2, 0.0), "return_point": (3, 0.0),
         "as_published": (0, 0.0), "elastic_domain": (1, 5e-5), "return_point_2e-5": (3, 2e-5)}   # name: memory_rule, rho_e
SIZES = [10.0 ** k for k in range(-9, -2)]
SETTINGS = [dict(e=e, drained=drained, path=path, suction=suction) for e, drained, path, suction in itertools.product(
    (0.735, 0.907), (False, True), ("straight", "turning"), (0.0, 100.0))]
DEFAULT = dict(e=0.735, drained=False, path="straight", suction=0.0, noise="back", events=0, random_events=False,
               size=0.0, growth=1.0, to=0.05, last=0.05, top=0.05, increment=1e-5, tolerance=1e-5, **{"from": 0.01})
DRAINED_INCREMENT = 5e-5   # held stresses cost iterations
FIELDS = ["group", "rule", "rho_e", *DEFAULT, "failed", "distance", "eps_v", "substeps", "rejects", "rates", "resets",
          "halvings"]


def case(group, name, rho_e=None, **values):
    rule, radius = RULES[name]
    row = dict(DEFAULT, group=group, rule=name, memory=rule, rho_e=radius if rho_e is None else rho_e)
    if values.get("drained"):
        row["increment"] = DRAINED_INCREMENT
    return row | values


def single():
    """One reversal at 0.01, 0.05 and 0.10; the answer is looked at 0.005 later."""
    for name, setting, place, size in itertools.product(RULES, SETTINGS, (0.01, 0.05, 0.10), SIZES):
        yield case("single", name, **setting, events=1, size=size, to=place, last=place + 0.005, top=0.105,
                   **{"from": place})


def many():
    """40, 300 and 1000 reversals between 0.01 and 0.05, equally spaced and sized or at random."""
    for name, setting, events, at_random, size in itertools.product(
            RULES, SETTINGS, (40, 300, 1000), (False, True), (1e-7, 1e-6, 1e-5, 1e-4)):
        # turning paths and suction with 300 only
        if events != 300 and (setting["path"] == "turning" or setting["suction"] > 0.0):
            continue
        yield case("many", name, **setting, events=events, random_events=at_random, size=size)


def transverse():
    """Perturbations across the path and their return: shear, and six components at once (at constant volume only)."""
    radii = (1e-5, 2e-5, 5e-5, 1e-4)
    for e, drained, noise, size in itertools.product((0.735, 0.907), (False, True), ("shear", "six"),
                                                     (1e-7, 1e-6, 1e-5, 1e-4)):
        if drained and noise == "six":
            continue
        values = dict(e=e, drained=drained, noise=noise, size=size, events=300, random_events=True)
        for name in RULES:
            if name not in ("as_published", "elastic_domain"):
                yield case("transverse", name, **values)
        for radius in radii:
            yield case("transverse", "elastic_domain", radius, **values)


def numerics():
    """The same noise over increments and tolerances."""
    tolerances = [10.0 ** -k for k in range(3, 9)]
    numbers = [(h, tolerance) for h in (1e-5, 1e-3) for tolerance in tolerances] + [(1e-6, 1e-5), (1e-4, 1e-5)]
    for name, e, drained, (increment, tolerance) in itertools.product(RULES, (0.735, 0.907), (False, True), numbers):
        # held stresses in few and large increments only; as_published goes on at its minimum substep for ever
        if drained and increment < 1e-4 or name == "as_published" and tolerance < 1e-6 * 0.99:
            continue
        yield case("numerics", name, e=e, drained=drained, events=300, random_events=True, size=1e-6,
                   increment=increment, tolerance=tolerance)


def hard():
    """Made to break a memory that comes back: reversals inside reversals, noise while unloading, growing cycles."""
    for name, e, drained in itertools.product(RULES, (0.735, 0.907), (False, True)):
        for size in (1e-6, 1e-5, 1e-4):
            yield case("nested", name, e=e, drained=drained, noise="nested", events=40, size=size)
            yield case("inner", name, e=e, drained=drained, noise="inner", events=10, size=size)
            yield case("unloading", name, e=e, drained=drained, path="unloading", events=40, size=size, to=0.025,
                       last=0.025, top=0.02, **{"from": 0.02})
        # 12 cycles back by 1e-6 to 2e-3 and forward again, 1e-3 of strain apart
        yield case("growing", name, e=e, drained=drained, events=12, size=1e-6, growth=2.0, to=0.022, last=0.022)


def clean():
    """No noise: what the rule and the elastic domain do by themselves."""
    for name, setting in itertools.product(RULES, SETTINGS):
        for radius in (1e-5, 5e-5, 1e-4) if name == "elastic_domain" else (None,):
            yield case("clean", name, radius, **setting)


GROUPS = {f.__name__: f for f in (clean, transverse, hard, single, many, numerics)}


def clean_key(values, own_rule):
    key = tuple(values[k] for k in ("e", "drained", "path", "suction", "last",
                                    "top")) + (values["increment"] * (values["path"] == "turning"),)
    return key + ((values["rule"], values["rho_e"]) if own_rule else ())


def namelist(name, values, **changed):
    text = [f"&run id='{name}' rule={values['memory']} rho_e={values['rho_e']}"]
    if values["rule"] == "as_published":
        text.append("isotropic=1 off=" + ",".join(f"'{guard}'" for guard in GUARDS))
    for key in DEFAULT:
        value = changed.get(key, values[key])
        text.append(f"{key}={value!r}" if isinstance(value, str) else
                    f"{key}={'T' if value else 'F'}" if isinstance(value, bool) else f"{key}={value:.17g}")
    return " ".join(text + [f"scheme={changed.get('scheme', 1)} /"])


def run_all(program, lines):
    """The answers by their number; two programs side by side."""
    order = random.Random(1).sample(lines, len(lines))   # shares the heavy ones out
    half = [subprocess.Popen([program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) for _ in range(2)]
    with concurrent.futures.ThreadPoolExecutor(2) as pool:
        texts = pool.map(lambda i: half[i].communicate("\n".join(order[i::2]) + "\n")[0], range(2))
        answers = {int(row["id"]): row for text in texts for row in tables.parsed(text)}
    if len(answers) != len(lines):
        raise SystemExit(f"{len(lines)} cases, {len(answers)} answers")
    return answers


def stress(row):
    return [float(row[f"s{ij}"]) for ij in ("11", "22", "33", "12", "13", "23")]


def length(s):
    return math.sqrt(sum(x * x for x in s[:3]) + 2.0 * sum(x * x for x in s[3:]))


def kept(group, rules):
    """The rows of a committed file that other rules than these made, and the note of where they come from."""
    path = pathlib.Path(__file__).with_name(f"{group}.csv")
    heads = [line for line in path.read_text(encoding="utf-8").splitlines() if line.startswith("# ")]
    fixed = dict(part.rsplit(" ", 1) for part in heads[-1].split(": ", 1)[1].split(", "))
    fixed = {k: {"True": "1", "False": "0"}.get(v) or (f"{float(v):g}" if re.fullmatch(r"[-+.\de]+", v) else v)
             for k, v in fixed.items()}
    rows = [fixed | row for row in tables.rows(path) if row["rule"] in RULES and row["rule"] not in rules]
    return rows, [line for line in heads[:-1] if rows and not set(rules) >= set(line.split(": ")[-1].split(", "))]


def text_of(value):
    return f"{value:g}" if isinstance(value, float) else str(int(value)) if isinstance(value, bool) else str(value)


def compute(program, commit, name, rules):
    cases = [c for c in GROUPS[name]() if c["rule"] in rules]
    own = [c["group"] in ("unloading", "growing") for c in cases]
    keys = {}
    for c, o in zip(cases, own):
        keys.setdefault(clean_key(c, o), c)
    lines = [namelist(i, c) for i, c in enumerate(cases)]
    # the clean path: the same without events, Dormand-Prince at 1e-9, no elastic domain
    for i, (key, c) in enumerate(keys.items()):
        lines.append(namelist(len(cases) + i, dict(c, rho_e=0.0), events=0, noise="back", tolerance=1e-9, scheme=3,
                              increment=c["increment"] if c["path"] == "turning" else 1e-4))
    start = time.time()
    answers = run_all(program, lines)
    print(f"{name}: {len(cases)} cases and {len(keys)} clean paths, {time.time() - start:.0f} s", flush=True)
    clean = {key: answers[len(cases) + i] for i, key in enumerate(keys)}
    rows = []
    for i, (c, o) in enumerate(zip(cases, own)):
        a, b = answers[i], clean[clean_key(c, o)]
        difference = [x - y for x, y in zip(stress(a), stress(b))]
        row = {k: c[k] for k in FIELDS if k in c}
        row.update(failed=a["status"], distance=f"{length(difference) / length(stress(b)):.3g}",
                   eps_v=f"{(float(b['e']) - float(a['e'])) / (1.0 + float(b['e'])):.3g}",
                   **{k: a[k] for k in ("substeps", "rejects", "rates", "resets", "halvings")})
        rows.append(row)
    for group in dict.fromkeys(c["group"] for c in cases):
        chosen = [r for r in rows if r["group"] == group]
        heads = [f"# made at commit {commit}"]
        if len(rules) < len(RULES):
            others, heads = kept(group, rules)
            heads.append(f"# made at commit {commit}: {', '.join(rules)}")
            chosen = sorted(others + chosen, key=lambda row: [*RULES].index(row["rule"]))
        chosen = [{f: text_of(r[f]) for f in FIELDS if f in r} for r in chosen]
        varied = [f for f in FIELDS[1:] if len({r[f] for r in chosen}) > 1 or f in ("rule", "failed", "distance")]
        fixed = {f: chosen[0][f] for f in FIELDS[1:] if f not in varied}
        with open(folder(__file__) / f"{group}.csv", "w", encoding="utf-8", newline="") as file:
            file.write("\n".join(heads) + "\n# the same in every row: "
                       + ", ".join(f"{k} {v}" for k, v in fixed.items()) + "\n")
            writer = csv.DictWriter(file, varied, extrasaction="ignore", lineterminator="\n")
            writer.writeheader()
            writer.writerows(chosen)


def laboratory(build, commit):
    """The drained tests of Verdugo & Ishihara with the elastic domain: misfit against the rows from 1 to 25 %."""
    tests = tests_of_verdugo_ishihara.read()
    with tempfile.TemporaryDirectory() as scratch, open(folder(__file__) / "laboratory.csv", "w",
                                                        encoding="utf-8") as file:
        bench = Bench(ROOT, build, scratch)
        file.write(f"# made at commit {commit}\n# misfit of q [%], of volumetric strain [points]\n")
        file.write("test,rho_e,q,eps_v\n")
        for name, radius in itertools.product(sorted(tests), (0.0, 1e-5, 5e-5, 1e-4)):
            run = bench.driver(f"vi_drained_{name}", ((re.compile(r"(?m)^   file = .*$"),
                                                       rf"\g<0>\n   rho_e = {radius}"),))
            q, volume = tests_of_verdugo_ishihara.misfit(run, tests[name])
            file.write(f"{name},{radius:g},{q:.3f},{volume:.4f}\n")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--groups", nargs="*", choices=[*GROUPS, "laboratory"], default=[*GROUPS, "laboratory"],
                        help="what to run again")
    parser.add_argument("--rules", nargs="*", choices=[*RULES], default=[*RULES],
                        help="whose rows to make again; those of other rules stay as they are committed")
    arguments = parser.parse_args()
    build = pathlib.Path(os.environ.get("MUD_BUILD_DIR") or ROOT / "build/release")
    commit = subprocess.run(["git", "describe", "--always"], cwd=ROOT, capture_output=True, text=True).stdout.strip()
    for group in arguments.groups:
        if group in GROUPS:
            compute(build / "verification/studies/oscillation/mud_oscillation", commit or "unknown", group,
                    arguments.rules)
    if "laboratory" in arguments.groups:
        laboratory(build, commit or "unknown")


if __name__ == "__main__":
    main()
