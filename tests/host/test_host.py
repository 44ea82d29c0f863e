# SPDX-License-Identifier: MIT
"""mud_host as a user meets it: mistakes with their own sentence and exit code. Known answers: tests/verification."""
import os
import re
import subprocess

from checking import build, check, root, work
import tables  # noqa: E402 (checking knows its folder)

host = build / "host/mud_host"
environment = {**os.environ, "OMP_NUM_THREADS": "1", "MUD_BUILD_DIR": str(build)}

SCENE = (root / "verification/host/cylinder/scene.nml").read_text()
FLOW = (root / "verification/host/terzaghi/scene.nml").read_text()
FALL = (root / "verification/host/contact/fall.nml").read_text()
SUCTION = (root / "verification/host/element/suction.nml").read_text().replace("../../..", str(root)) + """
&retention name = 'curve' /
&elastic name = 'other' young = 1e4 poisson = 0.3 /
"""
STAGE = "&stage name = 'load' analysis = 'static' duration = 1 dt = 1 /\n"
# what, scene, old text, new text, exit code, words of the sentence
MISTAKES = [
    ("unknown key", SCENE, "young = 1.0e4", "yuong = 1.0e4", 2, ("yuong", "nearest is young")),
    ("unknown group", SCENE, "&elastic", "&elastc", 2, ("elastc", "&elastic")),
    ("missing key", SCENE, "   poisson = 0.3\n", "", 2, ("needs poisson",)),
    ("value out of range", SCENE, "poisson = 0.3", "poisson = 0.5", 2, ("poisson", "outside")),
    ("not a number", SCENE, "young = 1.0e4", "young = stiff", 2, ("stiff", "not a number")),
    ("unknown word", SCENE, "'axisymmetric'", "'spherical'", 2, ("spherical", "plane_strain")),
    ("key given twice", SCENE, "poisson = 0.3", "poisson = 0.3\n   poisson = 0.2", 2, ("given twice",)),
    ("field the scene has not", SCENE, "field = 'u_z'", "field = 'p_w'", 2, ("no field p_w",)),
    ("second retention of MUD", SUCTION, "retention = 'mud'", "retention = 'curve'", 2,
     ("retention of its own", "P_a")),
    ("retention of MUD for another law", SUCTION, "material = 'sand'", "material = 'other'", 2,
     ("has no retention of its own",)),
    ("rate of saturation by a curve if it is a state", SUCTION.replace("&scene", "&scene saturation_rate = 'suction'"),
     "tangent = 3", "tangent = 3\n   hysteresis = 1", 2, ("saturation_rate = 'suction'", "hysteresis = 1", "'full'")),
    ("tangent without slopes", SUCTION, "tangent = 3", "tangent = 0", 2, ("gives no slopes",)),
    ("key of a law", SUCTION, "tangent = 3", "tangnt = 3", 2, ("tangnt", "tangent")),
    ("plate without a place", FALL, "   r = 0, 0.15\n   z = 1.0e-5", "", 2, ("give one of the two",)),
    ("plate with two places", FALL, "   z = 1.0e-5", "   group = 'top'", 2, ("give one of the two",)),
    ("no time to act", SCENE, "field = 'u_z'", "field = 'u_z' from = 1 until = 0.5", 2,
     ("from = 1 s and until = 0.5 s leave this &fix no time",)),
    ("a moment to act", SCENE, "field = 'u_z'", "field = 'u_z' from = 1 until = 1", 2, ("no time to act",)),
    ("no stage", SCENE, "&stage", "&point name = 'p' r = 2 z = 0 /\n&stage", 0, ()),
    ("point outside", SCENE, "&stage", "&point name = 'p' r = 0.5 z = 0 /\n&stage", 11,
     ("&point p: (0.5, 0) m lies outside the mesh", "nearest node is at (1, 0) m")),
    ("bad mesh piece", SCENE, "r_cells = 8", "r_cells = 8, 8", 10, ("n - 1 pieces",)),
    ("mesh file missing", SCENE, "r = 1, 2", "file = 'nowhere.msh'", 10, ("nowhere.msh", "cannot be read")),
    ("missing group", SCENE, "group = 'left'", "group = 'lefft'", 11, ("lefft", "left")),
    ("missing material", SCENE, "material = 'wall'", "material = 'wal'", 11, ("wal", "there is wall")),
    ("missing stage", SCENE, "kind = 'pressure'", "kind = 'pressure'\n   stages = 'lode'", 11, ("lode",)),
    ("inverted element", SCENE, "r = 1, 2", "r = -1, 2", 12, ("r >= 0",)),
    ("unconstrained body", SCENE, "   field = 'u_z'", "   field = 'u_r'", 13, ("nothing holds the body", "&fix")),
    ("no convergence", FLOW, "tolerance = 1.0e-8", "tolerance = 1.0e-14\n   cuts = 2\n   max_iterations = 1", 14,
     ("no convergence", "element", "time")),
    ("no convergence under a plate", FALL, "tolerance = 1.0e-6",
     "tolerance = 1.0e-12\n   cuts = 1\n   max_iterations = 1", 14, ("worst at node 212 of element 88",)),
    ("stage named twice", SCENE, "&fix\n   group = 'bottom'", f"{STAGE}&fix\n   group = 'bottom'", 2,
     ("name = 'load' is given twice, first in line 24",)),
    ("material named twice", SCENE, "&region", "&mud\n   name = 'wall'\n/\n&region", 2, ("'wall' is given twice",)),
    ("point named twice", SCENE, "&region", "&point name = 'inner' r = 2 z = 0 /\n&region", 2,
     ("'inner' is given twice",)),
    ("names of two lists", SCENE, "&region", "&point name = 'load' r = 2 z = 0 /\n&region", 0, ()),
    ("comma in a point", SCENE, "'inner'", "'in,ner'", 2, ("'in,ner' becomes a file or a column", "letters")),
    ("slash in a stage", SCENE, "'load'", "'lo/ad'", 2, ("'lo/ad' becomes a file or a column",)),
    ("odd but harmless name", SCENE, "'wall'", "'a wall, thick'", 0, ()),
    ("nameless stage", SCENE, "'load'", "''", 2, ("a name has 1 to 64",)),
    ("long name", SCENE, "'load'", f"'{'l'*65}'", 2, ("a name has 1 to 64",)),
    ("huge mesh", SCENE, "r_cells = 8\n   z = 0, 0.25\n   z_cells = 2",
     "r_cells = 100000\n   z = 0, 0.25\n   z_cells = 100000", 10, ("r_cells, z_cells: 2e10 elements", "at most 5e6")),
    ("masses of three points", SCENE.replace("'static'", "'dynamic'"), "&scene", "&scene quadrature = 3", 13,
     ("quadrature = 3", "start = 'zero' in &stage")),
    ("absurd strain", SCENE, "value = 100", "value = 1.0e8", 14, ("strained by more than 1",)),
]
# Histories from a file: what a line holds, what is said, and where.
TABLES = [
    ("plain", "0 0\n1 1\n", ()),
    ("commas, tabs, returns, comments", "# t, f\r\n  ! indented\n0,\t0 ! start\r\n\n1.0d0 , 1\r\n", ()),
    ("not a number", "0 0\n1 nan\n", (":2:", "1 nan", "two finite numbers")),
    ("infinity", "0 0\n1 inf\n", (":2:", "1 inf")),
    ("too large", "0 0\n# more\n1 1e999\n", (":3:", "1 1e999")),
    ("more words", "0 0\n1 1 junk 7\n", (":2:", "1 1 junk 7")),
    ("one word", "0 0\n1\n", (":2:",)),
    ("a slash", "0 0\n1 /\n", (":2:",)),
    ("a repetition", "0 0\n2*1\n", (":2:",)),
    ("a long line", "0 0\n1 1" + "0"*1100 + "\n", (":2:", "longer than 1023")),
    ("no order", "0 0\n0 1\n", ("must ascend",)),
    ("nothing", "# nothing\n", ("as many values as times",)),
]


def test_exit_code():
    for what, text, old, new, code, words in MISTAKES:
        assert old in text, what
        scene = work / "scene.nml"
        scene.write_text(text.replace(old, new))
        done = subprocess.run([host, scene, "--output", work / "out"], capture_output=True, text=True, env=environment)
        check(f"{what}: exit code", done.returncode == code, f"{done.returncode} instead of {code}: {done.stderr}")
        for word in words:
            check(f"{what}: says {word}", word in done.stderr, done.stderr)
        if code:
            check(f"{what}: one sentence", len(done.stderr.splitlines()) == 1, done.stderr)
    scene.write_text(SCENE.replace("value = 100\n", "value = 100\n   history = 'rise'\n")
                     + "&history name = 'rise' file = 'rise.txt' /\n")
    for what, table, words in TABLES:
        (work / "rise.txt").write_bytes(table.encode())
        done = subprocess.run([host, scene, "--output", work / "out"], capture_output=True, text=True, env=environment)
        check(f"history, {what}: exit code", done.returncode == (
            2 if words else 0), f"{done.returncode}: {done.stderr}")
        for word in words:
            check(
    f"history, {what}: says {word}",
    word in done.stderr and len(
        done.stderr.splitlines()) == 1,
         done.stderr)
    scene.write_text(SCENE)

    done = subprocess.run([host], capture_output=True, text=True)
    check("no scene: usage", done.returncode == 2 and "usage" in done.stderr, done.stderr)
    for words in (("--output", "--quiet"), ("--restart", "--check"), ("--output",), ("--outptu", "out")):
        done = subprocess.run([host, scene, *words], capture_output=True, text=True, cwd=work)
        check(f"{' '.join(words)}: usage", done.returncode == 2 and words[0] in done.stderr and "usage" in done.stderr
              and len(done.stderr.splitlines()) == 1 and not (work / "--quiet").exists(), done.stderr)
    done = subprocess.run([host, "--help"], capture_output=True, text=True)
    check("help", done.returncode == 0 and "default: output" in done.stdout
          and "xit codes: host/OUTPUT.md" in done.stdout
          and "--restart" in done.stdout and max(map(len, done.stdout.splitlines())) <= 120, done.stdout)
    done = subprocess.run([host, work / "scene.nml", "--output", "/proc/nowhere"], capture_output=True, text=True,
                          env=environment)
    check("output that cannot be written", done.returncode == 4, f"{done.returncode}: {done.stderr}")

    # The first scene of the manual: a column under 10 kPa, E = 1e4 kPa, free to spread: 1 mm.
    manual = (root / "host/README.md").read_text()
    scene.write_text(manual.split("<!-- first scene -->")[1].split("```")[1])
    done = subprocess.run([host, scene, "--output", work / "first"], capture_output=True, text=True, env=environment)
    check("first scene of the manual runs", done.returncode == 0, done.stderr)
    if done.returncode == 0:
        u_z = list(tables.numbers(work / "first/histories.csv")[-1].values())[2]
        check("first scene: 1 mm", abs(u_z + 1e-3) < 1e-12, u_z)
    for code in re.findall(r"EXIT_\w+ = (\d+)", (root / "host/base/exit_codes.f90").read_text()):
        check(f"the reference names exit code {code}", f"| {code} |" in (root / "host/OUTPUT.md").read_text())

    # A plate that bounces on its penalty: generalised-alpha with rho_inf = 0.8 gains energy at every opening and
    # closing where a period of the penalty has few steps (five times the energy of the fall here); rho_inf = 0 never
    # does. The run ends where it has created 1 % of the largest work, or what the scene allows; it warns where that is
    # more, also quiet.
    fall = (root / "verification/host/contact/fall.nml").read_text().replace("penalty = 1.0e7", "penalty = 1.0e8") \
        .replace("dt = 1.0e-5", "dt = 3.0e-4").replace("duration = 0.006", "duration = 0.06")
    allow = "\n   created_energy = "
    for rho, code, word in (("0.8", 18, "has created"), ("0.0", 0, ""), (f"0.8{allow}0.5", 18, "allowed 50 %"),
                            (f"0.8{allow}1e3", 0, "warning: stage fall has created")):
        scene.write_text(fall.replace("rho_inf = 0.8", f"rho_inf = {rho}"))
        done = subprocess.run([host, scene, "--output", work / "fall", "--quiet"], capture_output=True, text=True,
                              env=environment)
        check(f"rho_inf {' '.join(rho.split())}: energy out of nothing is told", word in done.stderr and (
            "created" in done.stderr) == bool(word) and done.returncode == code, f"{done.returncode}: {done.stderr}")
        if code == 18:
            last = tables.numbers(work / "fall/ledger.csv")[-1]["time"]
            check(f"rho_inf {' '.join(rho.split())}: the run ends before its time", 0 < last < 0.05, last)

    # A load that grows from zero on a column with Rayleigh damping: its first step has no other work than its own, of
    # which the scheme creates at most gamma**2 l_f/(beta l_a) - 1, 0.83 % with rho_inf 0.8 and 12.5 % with 0, where
    # inertia alone acts; damping takes nothing of that for creation. No run ends by it, and at the end 1e-4 of the work
    # is left of it.
    ramp = ("&scene name = 'ramp' geometry = 'plane_strain' fields = 'u' /\n"
            "&mesh r = 0, 1 r_cells = 1 z = -8, 0 z_cells = 8 /\n"
            "&elastic name = 'm' young = 3e5 poisson = 0.25 /\n&region material = 'm' rho_s = 1.9 void_ratio = 0 "
            "stiffness_damping = 2e-3 damping = 1 /\n"
            "&history name = 'v' times = 0, 0.05, 0.1, 1 values = 0, 1, 0, 0 /\n"
            "&stage name = 's' analysis = 'dynamic' duration = 0.2 /\n&tie first = 'left' second = 'right' /\n"
            "&fix group = 'bottom' field = 'u_z' /\n&fix group = 'bottom' field = 'u_r' /\n"
            "&load group = 'top' kind = 'shear_r' value = 5 history = 'v' /\n&point name = 't' r = 0 z = 0 /\n")
    for rho, least, most in ((0.8, 0.0, 0.0084), (0.0, 0.02, 0.126)):
        scene.write_text(ramp.replace("duration", f"rho_inf = {rho} duration"))
        done = subprocess.run([host, scene, "--output", work / "ramp", "--quiet"], capture_output=True, text=True,
                              env=environment)
        check(f"damped column, rho_inf {rho}: runs", done.returncode == 0 and "created" not in done.stderr, done.stderr)
        rows = tables.numbers(work / "ramp/ledger.csv")
        created = -rows[0]["imbalance"] / rows[0]["loads"]
        check(f"damped column, rho_inf {rho}: what the first step creates", least <= created <= most, created)
        left = -rows[-1]["imbalance"] / max(row["loads"] for row in rows)
        check(f"damped column, rho_inf {rho}: what is left of it", left < 1e-4, left)

    # A first guess that is refused: 0.5 g dt**2 of a cantilever's step of 100 s is 49 km. The step starts again from
    # the state before it; the tip sinks by what the statics of the beam say, 3/2 rho g L**4/(E' h**2) with E' of plane
    # strain and 2 % for shear and the mesh; a linear problem takes any step, without a cut and without energy out of
    # nothing.
    beam = ("&scene name = 'beam' geometry = 'plane_strain' gravity = 9.81 /\n"
            "&mesh r = 0, 8 r_cells = 40 z = 0, 0.4 z_cells = 2 /\n"
            "&elastic name = 'c' young = 3e7 poisson = 0.2 /\n&region material = 'c' rho_s = 2.5 void_ratio = 0 /\n"
            "&stage name = 's' duration = 4000 analysis = 'dynamic' dt = 100 rho_inf = 0 /\n"
            "&fix group = 'left' field = 'u_r' /\n"
            "&fix group = 'left' field = 'u_z' /\n&point name = 'tip' r = 8 z = 0.2 /\n")
    scene.write_text(beam)
    done = subprocess.run([host, scene, "--output", work / "beam", "--quiet"], capture_output=True, text=True,
                          env=environment)
    check("cantilever in steps of 100 s: runs", done.returncode == 0, done.stderr)
    rows = tables.numbers(work / "beam/histories.csv")
    sag = 1.5 * 2.5 * 9.81 * 8**4 / (3e7 / (1 - 0.2**2) * 0.4**2)
    check("cantilever: no cut", len(rows) == 41, len(rows))
    check("cantilever: static tip", abs(rows[-1]["tip.u_z"] / -sag - 1) < 0.02, (rows[-1]["tip.u_z"], -sag))

    # rho_inf where the scene leaves it open: 0 in a dynamic stage with contact, which gains no energy on a penalty
    # however long the step (omega dt 3, 12 and 50 here; rounding apart), 0.8 without. The start of a run says which
    # holds.
    quiet_fall = fall.replace("rho_inf = 0.8", "").replace("duration = 0.06", "duration = 0.02")
    for step in (1.2e-4, 4.8e-4, 2.0e-3):
        scene.write_text(quiet_fall.replace("dt = 3.0e-4", f"dt = {step}"))
        done = subprocess.run([host, scene, "--output", work / "fall"], capture_output=True, text=True, env=environment)
        gained = -min(row["imbalance"] for row in tables.numbers(work / "fall/ledger.csv"))
        check(f"contact, dt = {step}: no energy gained", done.returncode == 0 and gained < 1e-12, gained)
        check(f"contact, dt = {step}: rho_inf told", "Stage fall: dynamic, rho_inf 0." in done.stdout, done.stdout)
    done = subprocess.run([host, root / "verification/host/terzaghi/scene.nml", "--check"],
                          capture_output=True, text=True, env=environment)
    check("rho_inf given: told", "Stage consolidation: quasi_static, rho_inf 0." in done.stdout, done.stdout)
    free = re.sub(r"&contact.*?^/$", "", quiet_fall, flags=re.MULTILINE | re.DOTALL)
    scene.write_text(free)
    done = subprocess.run([host, scene, "--check"], capture_output=True, text=True, env=environment)
    check("without contact: rho_inf 0.8", "Stage fall: dynamic, rho_inf 0.8." in done.stdout, done.stdout + done.stderr)


def test_threads_same_bytes():
    # Results do not depend on the number of threads: the files are the same, byte for byte.
    answers = []
    terzaghi = root / "verification/host/terzaghi/scene.nml"
    for threads in ("1", "2"):
        out = work / f"threads{threads}"
        scene = work / f"threads{threads}.nml"
        scene.write_text(
    terzaghi.read_text().replace(
        "name = 'terzaghi'",
         f"name = 'terzaghi'\n   threads = {threads}"))
        subprocess.run([host, scene, "--output", out, "--quiet"], check=True,
                       env={**environment, "OMP_WAIT_POLICY": "passive"})
        answers.append((out / "histories.csv").read_bytes() + (out / "ledger.csv").read_bytes())
    check("threads: same bytes", answers[0] == answers[1])

    # A few elastic elements are not worth a second thread, 392 of MUD are; what the scene says counts.
    indentation = root / "verification/studies/indentation/indent_s030.nml"
    for scene, count in ((terzaghi, 1), (work / "threads2.nml", 2), (indentation, 2)):
        done = subprocess.run([host, scene, "--check"], capture_output=True, text=True,
                              env={**environment, "OMP_NUM_THREADS": "2"})
        check(f"threads by size: {scene.stem}", f", {count} threads." in done.stdout, done.stdout + done.stderr)


def test_idle_threads_wait_asleep():
    # The program begins itself anew for it: words with blanks arrive, and what it says is said once.
    spaced = work / "a scene.nml"
    spaced.write_text((root / "verification/host/terzaghi/scene.nml").read_text())
    for given, spins in ((None, "0"), ("active", None)):
        policy = {"OMP_WAIT_POLICY": given} if given else {}
        with_threads = {k: v for k, v in environment.items() if k != "OMP_WAIT_POLICY"} | policy
        done = subprocess.run([host, "--check", spaced], capture_output=True, text=True,
                              env={**with_threads, "OMP_NUM_THREADS": "2", "OMP_DISPLAY_ENV": "verbose"})
        told = re.findall(r"GOMP_SPINCOUNT = '(\d+)'", done.stderr)
        check(f"waits asleep, unless the user says otherwise ({given})", (told[-1] == "0") == (spins == "0"), told)
        check("the scene is the one that was named", done.returncode == 0 and done.stdout.count("unknowns") == 1,
              done.stdout + done.stderr)


def test_template_in_groups():
    # The template names every key of the code and is refused for nothing but its question marks.
    template = subprocess.run([host, "--template"], capture_output=True, text=True).stdout
    code = "".join(file.read_text() for file in (root / "host/model").glob("*_builder.f90"))
    for name in set(re.findall(r"call k%\w+\('(\w+)'", code)):
        lines, calls = (len(re.findall(pattern, text, re.MULTILINE))
                        for pattern, text in ((rf"^[ !]+{name} = ", template), (rf"call k%\w+\('{name}'", code)))
        check(f"template: {name} in {calls} groups", lines >= calls, lines)
