# SPDX-License-Identifier: MIT
"""FEniCSx, PETSc and MPI: points against mud_triax, ranks, restart, multigrid, a metre, ground under K_0 stress, a strip
against mud_host.

Writes the numbers of the runs to results.json in its work folder."""
import csv
import json
import os
import pathlib
import re
import subprocess

import clients

here = pathlib.Path(__file__).parent
PYTHON = "/usr/bin/python3"  # Debian's packages belong to Debian's Python
RANKS = 1e-8  # loads of a push, relative: ten times the tolerance of Newton's method for the residual
clients.debian(["python3-dolfinx", "openmpi-bin"])
folder = clients.work_folder("fenicsx")
environment = {**os.environ, **clients.python_package, "OMP_NUM_THREADS": "1", "OMPI_ALLOW_RUN_AS_ROOT": "1",
               "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM": "1", "OMPI_MCA_rmaps_base_oversubscribe": "1",
               "OMPI_MCA_mpi_yield_when_idle": "1"}  # a waiting rank leaves its core to others
BACK = ["--back-pressure", "2000"]  # dense sand dilates: without it the water would be in tension
SMALL = ["--cells", "3", "--steps", "4", *BACK]


def program(name, script, *arguments, ranks=1):
    """What a program wrote to its result file, or None."""
    result = folder / f"{name}.json"
    result.unlink(missing_ok=True)
    launch = ["mpirun", "-n", str(ranks), "--bind-to", "none"] if ranks > 1 else []
    command = [*launch, PYTHON, here / script, *arguments, "--result", result]
    if clients.run(command, folder / f"{name}.log", cwd=folder, env=environment, timeout=3000) != 0:
        return None
    return json.loads(result.read_text())


runs_made = {}


def footing(name, *arguments, ranks=1):
    runs_made[name] = program(name, "footing.py", *arguments, ranks=ranks)
    return runs_made[name]


def close(what, got, wanted, relative):
    if got is None or wanted is None:
        clients.verdict(False, what, "a run did not come to its end")
    else:
        clients.compare(what, [[x] for x in got["pressure"]], [[x] for x in wanted["pressure"]], relative)


# Points by the batch call, as the finite elements use it: the strains and suctions of mud_triax.
for case, parameters in (("shear", {}), ("shear_suction", {}), ("wetting", {}), ("hysteresis", {"hysteresis": 1})):
    table = clients.expected(case)
    path = folder / f"{case}.json"
    path.write_text(json.dumps({"strains": clients.strains(table), "suction": table["suction"],
                                "void_ratio": table["e"][0], "stress": -table["p_eff"][0], "parameters": parameters}))
    answer = program(f"points_{case}", "points.py", path)
    clients.compare(f"batch call, {case}", answer["stress"] if answer else [], clients.stresses(table)[1:])
    if parameters:
        clients.compare(f"its degree of saturation, {answer and answer['state_variables']} state variables",
                        [answer["saturation"] if answer else []], [table["s_w"][1:]])

one = footing("one", *SMALL, "--record", "one")
two = footing("two", *SMALL, "--record", "two", ranks=2)
close("footing, u-p_w in three dimensions: two ranks give the loads of one", two, one, RANKS)
replay = program("replay", "points.py", folder / "two.npz")
clients.verdict(bool(replay) and replay["same"] and replay["points"] > 0,
                "stress and state of the points of two ranks are those of one process, bit by bit",
                f"{replay and replay['points']} points")
footing("half", *SMALL, "--stop-after", "2", "--save", "checkpoint")
again = footing("again", *SMALL, "--load", "checkpoint")
clients.verdict(bool(again and one) and again["digest"] == one["digest"], "a restart gives the bits of the whole run",
                f"digests {again and again['digest']}, {one and one['digest']}")
other = footing("other", *SMALL, "--load", "checkpoint", ranks=2)
if one:
    one_later = {"pressure": one["pressure"][2:]}
    close("a restart with another number of ranks gives the loads", other, one_later, RANKS)
multigrid = footing("multigrid", *SMALL, "--linear", "amg")
close("multigrid with rigid-body modes gives the loads of MUMPS", multigrid, one, RANKS)
FIRST = [*SMALL, "--stop-after", "1"]
both = footing("multigrid_two", *FIRST, "--linear", "amg", ranks=2)
close("the same on two ranks, first step", both, one and {"pressure": one["pressure"][:1]}, RANKS)
MIDDLE = ["--cells", "6", "--steps", "3", "--stop-after", "1", "--scheme", "2", *BACK]
direct, multigrid = footing("direct_6", *MIDDLE), footing("multigrid_6", *MIDDLE, "--linear", "amg")
close("the same with 6934 unknowns, first step", multigrid, direct, RANKS)
DEEP = ["--cells", "3", "--scale", "4", "--steps", "1", "--scheme", "2", *BACK]
for name, settlement, cut in (("metre", 1.0, False), ("metre_and_a_half", 1.5, True)):
    deep = footing(name, *DEEP, "--settlement", str(settlement))
    told = json.dumps(deep and {k: deep[k] for k in ("pressure", "steps", "cuts", "searches", "iterations")})
    clients.verdict(bool(deep) and abs(deep["settlement"] - settlement) < 1e-12 and deep["searches"] > 0,
                    f"{settlement} m in one step get through", told)
    if cut:
        clients.verdict(bool(deep) and deep["cuts"] > 0, "by cuts", told)
        both = footing(f"{name}_two", *DEEP, "--settlement", str(settlement), ranks=2)
        clients.verdict(bool(both and deep) and both["cuts"] == deep["cuts"], "two ranks cut the same steps",
                        f"{both and both['cuts']}, {deep and deep['cuts']} cuts")
        close("and give the loads of one", both, deep, RANKS)

# Water in tension is refused, on two ranks as on one: no result, and a sentence that says where.
for ranks in (1, 2):
    tense = footing(f"tension_{ranks}", *DEEP, "--settlement", "1", "--back-pressure", "0", ranks=ranks)
    said = (folder / f"tension_{ranks}.log").read_text()
    clients.verdict(tense is None and "the pressure of the water falls to" in said and "mud_host" in said,
                    f"water in tension ends the run on {ranks} ranks",
                    said[said.find("Unsaturated: "):][:150].replace("\n", " "))

# The start: ground with weight under K_0 stress.
path = folder / "given.json"
path.write_text(json.dumps(clients.GROUND))
clients.ground(program("ground", "ground.py", path))


def graded(x):
    """As in footing.py."""
    beyond = max(0.0, (x - 1/3)*1.5)
    return 1.5*x if x <= 1/3 + 1e-12 else 0.5 + beyond + 2.5*beyond**2


def host(cells, steps):
    """Settlement and pressure of the water at the axis, by mud_host on a mesh with the same breaks."""
    name = f"host_{cells}_{steps}"
    lines = [graded(i/cells) for i in range(cells + 1)]
    scene = (here / "strip.nml").read_text()
    load = "".join(f"&load\n   group = 'top_{i}'\n   kind = 'pressure'\n   value = 150\n   history = 'ramp'\n/\n"
                   for i in range(1, cells//3 + 1))
    for word, text in (("R", ", ".join(map(repr, lines))), ("Z", ", ".join(repr(-x) for x in reversed(lines))),
                       ("ONES", ", ".join(["1"]*cells)), ("STEP", repr(100.0/steps)), ("LOAD", load)):
        scene = re.sub(f"@{word}@", text, scene)
    (folder / f"{name}.nml").write_text(scene)
    command = [clients.build / "host/mud_host", f"{name}.nml", "--output", name, "--quiet"]
    subprocess.run(["rm", "-rf", folder / name], check=True)
    if clients.run(command, folder / f"{name}.log", cwd=folder, timeout=900) != 0:
        return None
    with open(folder / name / "histories.csv") as file:
        last = list(csv.DictReader(file))[-1]
    return {"settlement": -float(last["centre.u_z"]), "p_w": float(last["below.p_w"])}


def strip(cells, steps):
    return footing(f"strip_{cells}_{steps}", "--strip", "--cells", str(cells), "--steps", str(steps))


# The strip. The finite elements here are of first order in time: two runs are extrapolated to steps of no length.
# Allowed is what halving the elements moves either program, and halving the step mud_host.
runs = {(n, s): strip(n, s) for n in (6, 12) for s in (10, 20)}
own = {(n, s): host(n, s) for n, s in ((6, 20), (12, 20), (12, 10))}
for name in ("settlement", "p_w"):
    if not all(runs.values()) or not all(own.values()):
        clients.verdict(False, f"strip against mud_host, {name}", "a run did not come to its end")
        continue
    coarse, fine = (2.0*runs[n, 20][name] - runs[n, 10][name] for n in (6, 12))
    ours = own[12, 20][name]
    apart, theirs = abs(fine - ours)/ours, abs(fine - coarse)/ours
    mine = (abs(ours - own[6, 20][name]) + abs(ours - own[12, 10][name]))/ours
    clients.verdict(apart <= theirs + mine, f"strip against mud_host, {name}",
                    f"apart {apart:.1e} of {ours:.6g}, allowed {theirs:.1e} (FEniCSx) + {mine:.1e} (mud_host)")
(folder / "results.json").write_text(json.dumps({"library": clients.commit(), "runs": runs_made}, indent=1) + "\n")
clients.finish()
