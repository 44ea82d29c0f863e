# SPDX-License-Identifier: MIT
"""Does a change of the library leave its answers alone?

    scripts/same_increments.py record FILE     updates 18,000 random increments and keeps their answers
    scripts/same_increments.py compare FILE    updates them again and compares

The library is build/release/umat/libmud.so, or that of $MUD_LIBRARY_DIR. Sands, states and increments are random and
the same in every run: every combination of the effects, the memory rules, the schemes and the kinds of tangent, strains
of 1e-6 to 3e-3, straight and turning. An increment starts from the recorded answer of the one before, so that a
difference does not grow. Told are the largest differences: of the stress over its norm, of other state variables over
their size or 1, of tangents over their largest entry; and every code that differs. Exit code 1 where a stress moved by
more than 1e-12, another state variable or a tangent by more than 1e-10, or a code. Some seconds.
"""
import argparse
import itertools
import pathlib
import sys

import numpy as np

root = pathlib.Path(__file__).resolve().parents[1]
sys.path.insert(0, str(root / "python"))
import mud  # noqa: E402 (its folder is known only now)

PATH = 20   # increments of a path
ALLOWED = {"stress": 1e-12, "state": 1e-10, "tangent": 1e-10}


def sands():
    """An endless row of materials: options in turn, parameters as they are found in sands."""
    random = np.random.default_rng(20261128)
    rules, schemes = ("classic", "repositioning", "return_point"), (0.0, 1.0, 2.0, 3.0)
    options = list(itertools.product((0.0, 1.0, 2.0), (0.0, 0.1), (0.0, 10.0), (0.0, 1.0), rules, schemes, (0.0, 2e-5)))
    random.shuffle(options)
    for isotropic, c_chi, c_ell, hysteresis, rule, scheme, rho_e in itertools.cycle(options):
        yield random, mud.Material(
            G_0=random.uniform(80, 160), K_0=random.uniform(80, 200), M_c=random.uniform(1.15, 1.45),
            n_b=random.uniform(0.8, 2.5), n_d=random.uniform(0.8, 3.5), h_0=random.uniform(4, 14),
            A_0=random.uniform(0.2, 1.0), isotropic=isotropic, c_chi=c_chi, c_ell=c_ell, hysteresis=hysteresis,
            memory_rule=rule, scheme=scheme, rho_e=rho_e)


def updates(paths, answers=None):
    """Codes, stresses with states, and tangents of all increments; each path starts anew, each increment after the
    first of a path from the answer kept, if there is one."""
    kinds = ("consistent", "continuum", None)
    for number, (random, sand) in zip(range(paths), sands()):
        p, suction = 10 ** random.uniform(0, 3), random.choice([0.0, 20.0, 200.0])
        try:
            stress, statev = sand.initial_state([-p, -0.7 * p, -0.7 * p, 0, 0, 0], suction, random.uniform(0.55, 0.9))
        except mud.MudError:
            stress = statev = None
        size, turns = 10 ** random.uniform(-6, -2.5), random.random() < 0.5
        direction = random.normal(size=6)
        for step in range(PATH):
            if turns:
                direction = direction + 0.5 * random.normal(size=6)
            if random.random() < 0.1:
                direction = -direction
            strain = size * direction / np.linalg.norm(direction)
            change = 0.02 * suction * random.normal()
            row = {"code": -1, "state": np.zeros(6 + len(mud.states)), "tangent": np.zeros(0)}
            if stress is not None:
                try:
                    now = float(statev[mud.states["suction"].index])
                    answer = sand.update(stress, statev, strain, now + change, kinds[number % 3])
                    tangent = np.zeros(0) if answer.dsig_deps is None else np.concatenate(
                        [np.ravel(answer.dsig_deps), np.ravel(answer.dsig_dpc), np.ravel(answer.dsw_deps), [answer.dsw_dpc]])
                    row = {"code": 0, "state": np.concatenate([answer.stress, answer.statev]), "tangent": tangent}
                except mud.MudError as fault:
                    row["code"] = getattr(fault, "code", 1)
            yield row
            kept = row if answers is None else answers[number * PATH + step]
            if stress is not None and kept["code"] == 0:
                stress, statev = kept["state"][:6].copy(), kept["state"][6:].copy()


def main():
    words = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    words.add_argument("work", choices=("record", "compare"))
    words.add_argument("file", type=pathlib.Path)
    words.add_argument("--paths", type=int, default=900, metavar="N", help=f"paths of {PATH} increments to record (900)")
    given = words.parse_args()
    if given.work == "record":
        rows = list(updates(given.paths))
        with open(given.file, "wb") as file:   # a name would get an ending that `compare` does not know
            np.savez_compressed(file, code=[r["code"] for r in rows], state=[r["state"] for r in rows],
                                sizes=[r["tangent"].size for r in rows],
                                tangent=np.concatenate([r["tangent"] for r in rows]))
        print(f"{len(rows)} increments, {sum(r['code'] != 0 for r in rows)} of them refused: {given.file}")
        return 0
    kept = np.load(given.file)
    states, codes, tangents = kept["state"], kept["code"], kept["tangent"]
    ends = np.cumsum(kept["sizes"])
    old = [{"code": c, "state": s, "tangent": tangents[e - n:e]} for c, s, e, n in zip(codes, states, ends, kept["sizes"])]
    worst = dict.fromkeys(ALLOWED, (0.0, -1))
    differ, same = [], 0
    for i, (before, now) in enumerate(zip(old, updates(len(old) // PATH, old), strict=True)):
        if before["code"] != now["code"]:
            differ.append(i)
            continue
        parts = {"stress": (before["state"][:6], now["state"][:6], np.linalg.norm(before["state"][:6])),
                 "state": (before["state"][6:], now["state"][6:], np.maximum(np.abs(before["state"][6:]), 1.0)),
                 "tangent": (before["tangent"], now["tangent"], np.abs(before["tangent"]).max(initial=0.0))}
        same += all(np.array_equal(a, b, equal_nan=True) for a, b, _ in parts.values())
        for name, (a, b, scale) in parts.items():
            difference = np.abs(a - b) / np.where(scale > 0, scale, 1.0)
            if difference.size and difference.max() > worst[name][0]:
                worst[name] = (float(difference.max()), i)
    print(f"{len(old)} increments, {same} bitwise the same; codes differ in {len(differ)} {differ[:10]}")
    for name, (size, place) in worst.items():
        print(f"  {name}: {size:.1e} at increment {place} (allowed {ALLOWED[name]:.0e})")
    return int(bool(differ) or any(worst[n][0] > ALLOWED[n] for n in ALLOWED))


if __name__ == "__main__":
    sys.exit(main())
