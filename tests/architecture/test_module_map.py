# SPDX-License-Identifier: MIT
"""The map of the folders, docs/architecture.svg, is what the `use` lines say, and CONTRIBUTING.md shows it."""
import subprocess
import sys

from checking import check, root

sys.path.insert(0, str(root/"scripts"))
import module_map  # noqa: E402 (its folder is known only now)

# Of a cycle the fewest use lines run upwards; what has none loses nothing.
chain = {("a", "b"): 3, ("b", "c"): 2, ("a", "c"): 1}


def test_the_same_sources_give_the_same_picture():
    sys.dont_write_bytecode = True

    text, wrong = module_map.draw()
    check("the same sources give the same picture", module_map.draw()[0] == text)
    check("no folder uses one above it", not wrong, wrong)
    check("docs/architecture.svg is that picture", module_map.PICTURE.exists()
          and module_map.PICTURE.read_text(encoding="utf-8") == text, "renew it: python3 scripts/module_map.py")
    told = subprocess.run([sys.executable, root/"scripts/module_map.py", "--check"], capture_output=True, text=True)
    check("--check agrees", told.returncode == 0, told.stdout + told.stderr)
    check("CONTRIBUTING.md shows it", "(docs/architecture.svg)" in (root/"CONTRIBUTING.md").read_text(encoding="utf-8"))


def test_a_chain_has_no_cycle():
    check("a chain has no cycle", module_map.split_cycles(chain) == (sorted(chain), []), module_map.split_cycles(chain))
    circle = {**chain, ("c", "a"): 1}
    check("the use that closes a cycle is the one against the order",
          module_map.split_cycles(circle)[1] == [("c", "a")], module_map.split_cycles(circle))
    check("an arrow that follows from others is left out", module_map.reduced(
        sorted(chain)) == [("a", "b"), ("b", "c")], module_map.reduced(sorted(chain)))
    check("a folder stands above what it uses", module_map.rows_of(["a", "b", "c"], sorted(chain)) == [
          ["a"], ["b"], ["c"]], module_map.rows_of(["a", "b", "c"], sorted(chain)))


def test_the_librarys_folders_are_among_those_found():
    found, folders = module_map.uses_of_folders()
    check("the library's folders are among those found", {"umat/core/base", "umat/abi"} <= set(folders), folders)
    check("folders of the library use each other", ("umat/abi", "umat/core/base") in found, sorted(found))
