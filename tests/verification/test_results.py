# SPDX-License-Identifier: MIT
"""Results of a study that goes on: rows that other programs made are not mixed with those of the present ones; every
committed table has a row."""
import sys

from checking import check, root, work

sys.path.insert(0, str(root / "verification"))
from tools import results  # noqa: E402


def test_results_of_other_programs_are_removed():
    build, place = work / "a_build", work / "made"
    (build / "host").mkdir(parents=True, exist_ok=True)
    (build / "host/mud_host").write_bytes(b"one")
    row = results.current(place, build) / "rows.csv"
    row.write_text("a\n")
    (place / "run").mkdir(exist_ok=True)
    results.current(place, build)
    check("the same program: a study goes on where it was", row.exists() and (place / "run").is_dir())
    (build / "host/mud_host").write_bytes(b"two")
    results.current(place, build)
    check("another program: it begins anew", place.is_dir() and not row.exists() and not (place / "run").exists())
    row.write_text("a\n")
    (place / results.MARK).unlink()
    results.current(place, build)
    check("nothing tells of the program: it begins anew", not row.exists())


def test_no_data_of_a_page_is_empty():
    # A page that the check run leaves out would fail unseen.
    empty = [str(path.relative_to(root)) for path in (root / "verification").rglob("*.csv")
             if "/build/" not in str(path) and len(path.read_bytes().splitlines()) < 2]
    check("every committed table has a row", not empty, empty)
