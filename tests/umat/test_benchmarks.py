# SPDX-License-Identifier: MIT
"""The benchmarks start and write what their tables are made of. No time is judged."""
import itertools
import subprocess
import sys

from checking import at_length, build, check, preset, root, work

sys.path.insert(0, str(root / "common"))
import tables  # noqa: E402

PATHS = ("saturated", "unsaturated", "saturated_turning", "unsaturated_turning")
COLUMNS = {"path", "scheme", "tolerance", "error", "uncertainty", "rates", "status"}
program = build / "benchmarks/mud_benchmark"


def start(command, *words):
    return subprocess.run([command, *map(str, words)], capture_output=True, text=True)


def test_a_walk_is_what_is_counted():
    for path, tangent in itertools.product(PATHS, (0, 2, 3)):
        done = start(program, path, "1e-4", 0, "1e-5", tangent, 1)
        check(f"{path}, tangent {tangent}: starts", done.returncode == 0, done.stderr)
        updates, rates = (int(word) for word in done.stdout.split() if word.isdigit())
        check(f"{path}, tangent {tangent}: two rates an update", updates > 0 and rates >= 2*updates, done.stdout)
    for what, words in (("a word in place of a number", ("saturated", "1e-4", "third", "1e-5", 0, 1)),
                        ("a walk without a tolerance", ("saturated", "1e-4", 0))):
        done = start(program, *words)
        check(f"{what} is refused", done.returncode != 0 and "usage: mud_benchmark" in done.stderr, done.stderr)


def test_a_round_fills_the_tables():
    if preset != "release":
        return   # minutes
    done = start(program, 1)
    check("one round: runs", done.returncode == 0, done.stderr)
    rows = tables.parsed(done.stdout)
    check("one round: every kind of call", {row["call"] for row in rows} >= {"rate", "update", "batch"})
    check("one round: every path", {row["path"] for row in rows} >= set(PATHS))
    check("one round: rates and times are positive",
          all(float(row["rates_per_update"]) > 0 and float(row["ns"]) > 0 for row in rows))
    (work / "speed.csv").write_text(done.stdout)
    done = start(sys.executable, root / "benchmarks/summary.py", work)
    check("its tables are made", done.returncode == 0 and done.stdout.count("|---|") > 3, done.stderr)
    for path in PATHS:
        check(f"its tables have {path}", f"| {path} |" in done.stdout, done.stdout)


@at_length
def test_work_and_precision_run():
    page = root / "verification/studies/work_precision"
    done = start(build / "benchmarks/work_precision", page/"reference.csv")
    rows = tables.parsed(done.stdout)
    check("work and precision: runs", done.returncode == 0 and rows and set(rows[0]) >= COLUMNS, done.stderr)
    tight = [row for row in rows if row["status"] == "0" and float(row["tolerance"]) <= 1e-7]
    check("work and precision: at a tight tolerance every path ends at its reference",
          tight and all(float(row["error"]) < 1e-5 for row in tight), tight)
    done = start(build / "benchmarks/work_precision", "orders")
    check("orders: runs", done.returncode == 0 and len(done.stdout.splitlines()) > 10, done.stderr)


def test_the_host_alone_runs_the_column_of_the_other_programs():
    if preset != "release":
        return   # a time is what it is for
    done = start(sys.executable, root / "benchmarks/column.py", "--small", "--rounds", 1, "--results", work)
    rows = tables.parsed((work / "column.csv").read_text()) if done.returncode == 0 else []
    check("the column: two rows of the host", [row["program"] for row in rows] == ["mud_host", "mud_host, fresh"],
          done.stdout + done.stderr)
    check("the column: the answers are Terzaghi's to 0.2 %", all(
        abs(float(row[f"{what}_error_percent"])) < 0.2 for row in rows for what in ("settlement", "pressure")), rows)
    check("the column: a page beside it", "| mud_host |" in (work / "column.md").read_text(), done.stdout)
