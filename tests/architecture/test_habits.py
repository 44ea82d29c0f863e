# SPDX-License-Identifier: MIT
"""One version everywhere, a licence for every file, and the numbers of docs/release.md as the sources have them."""
import pathlib
import re
import subprocess
import tomllib

from checking import check, root

TAG = "SPDX-License" "-Identifier"   # apart, so that reuse lint does not read this file's texts as licences
SOURCES = (".f90", ".pf", ".py", ".c", ".h", ".sh", ".cmake")
SCRIPTS = ("CMakeLists.txt", "check", "demo", "run", "benchmark", "random_increments", "site")


def found(pattern, name):
    """What the pattern finds in a file of the tree; None if it is not there."""
    match = re.search(pattern, (root / name).read_text(encoding="utf-8"), re.MULTILINE)
    return match[1] if match else None


def committed():
    told = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=root,
                          capture_output=True, text=True)
    names = told.stdout.split("\n") if told.returncode == 0 else [
        str(path.relative_to(root)) for path in root.rglob("*") if "build" not in path.relative_to(root).parts]
    return [name for name in names if name and (root / name).is_file()]


def unlicensed(names, text_of):
    """Sources without a licence in their first five lines."""
    return [name for name in names if (pathlib.Path(name).suffix in SOURCES or pathlib.Path(name).name in SCRIPTS)
            and not any(re.match(rf"\W+{TAG}: \S", line) for line in text_of(name).splitlines()[:5])]


def test_every_file_tells_the_version_of_cmakelists_txt():
    version = found(r"^project\(mud VERSION (\S+)", "CMakeLists.txt")
    told = {
        "pyproject.toml": tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8")) ["project"] ["version"],
        "umat/abi/mud_c_api.f90": found(r"VERSION = '([\d.]+)'", "umat/abi/mud_c_api.f90"),
        "CITATION.cff": found(r"^version: (\S+)", "CITATION.cff"),
        "fpm.toml": found(r'^version = "(\S+)"', "fpm.toml"),
        "codemeta.json": found(r'"version": "(\S+)"', "codemeta.json"),
        "packaging/conda/recipe.yaml": found(r'^  version: "(\S+)"', "packaging/conda/recipe.yaml"),
        "packaging/spack/package.py": found(r'^    version\("(\S+)"', "packaging/spack/package.py"),
        "docs/release.md": found(r"^\| version \| (\S+) \|", "docs/release.md")}
    check("every file tells the version of CMakeLists.txt", set(told.values()) == {version}, f"{version}, but {told}")
    check("docs/release.md tells the ABI version of mud.h", found(r"^\| ABI version \| (\d+) \|", "docs/release.md")
          == found(r"^#define MUD_ABI_VERSION (\d+)", "umat/include/mud.h"))


def test_a_source_without_a_licence_is_seen_and_nothing_else():
    texts = {"a.f90": "module a", "b.f90": f"! {TAG}: MIT\nmodule b", "c.md": "# c"}
    check("a source without a licence is seen, and nothing else", unlicensed(texts, texts.get) == ["a.f90"])
    names = committed()
    bare = unlicensed(names, lambda name: (root / name).read_text(encoding="utf-8"))
    check("every source names its licence", not bare, bare)
    annotations = tomllib.loads((root / "REUSE.toml").read_text(encoding="utf-8"))["annotations"]
    gone = [pattern for one in annotations for pattern in (one["path"] if isinstance(one["path"], list) else [])
            if not list(root.glob(pattern))]
    check("REUSE.toml names files that there are", not gone, gone)
    licences = {one[TAG] for one in annotations}
    check(
    "the text of every licence is there",
    licences == {
        path.stem for path in (
            root /
            "LICENSES").iterdir()},
             licences)

    # A table that says in its first lines whose data it holds is not ours to license.
    ours = {str(path.relative_to(root)) for one in annotations if one[TAG] != "MIT"
            for pattern in one["path"] for path in root.glob(pattern)}
    foreign = [name for name in names if name.endswith(".csv") and name not in ours and re.search(
        r"(?i)\bCC-BY|digitised from|licen[cs]e:", "".join(
            (root / name).read_text(encoding="utf-8").splitlines(True)[:3]))]
    check("tables of other people keep their licence", not foreign and len(ours) >= 5, foreign)
