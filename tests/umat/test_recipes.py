# SPDX-License-Identifier: MIT
"""The recipes of conda and Spack ask CMake for what it knows, and for the tools that it needs.

The recipe of Spack is run here by stand-ins for the directives of Spack; scripts/try_recipes builds that of conda.
"""
import re
import subprocess
import sys
import types

from checking import build, check, root, work

read = lambda name: (root / name).read_text(encoding="utf-8")  # noqa: E731


class CMakePackage:
    """What a recipe inherits: definitions for CMake."""
    chosen = {}

    def define(self, name, value):
        return name, value

    def define_from_variant(self, name, variant):
        return name, self.chosen[variant]


def spack():
    """The class of the recipe, and its directives: (name, first argument, the rest)."""
    told = []

    def directive(name):
        return lambda first, *more, **named: told.append((name, first, {**dict(enumerate(more)), **named}))

    package = types.ModuleType("spack.package")
    names = ("version", "variant", "depends_on", "requires", "license")
    package.__dict__.update({name: directive(name) for name in names}, __all__=list(names))
    system = types.ModuleType("spack_repo.builtin.build_systems.cmake")
    system.CMakePackage = CMakePackage
    modules = {"spack.package": package, system.__name__: system}
    for name in list(modules):
        while "." in name:
            name = name.rpartition(".")[0]
            modules.setdefault(name, types.ModuleType(name))
    sys.modules.update(modules)
    scope = {}
    exec(compile(read("packaging/spack/package.py"), "package.py", "exec"), scope)
    return scope["Mud"], told


def test_spack_the_recipe_is_one_of_cmake_with_a_version_and_a_licence():
    OPTIONS = set(re.findall(r"^option\((MUD_\w+) ", read("CMakeLists.txt"), re.MULTILINE))
    CMAKE = re.search(r"cmake_minimum_required\(VERSION ([\d.]+)", read("CMakeLists.txt"))[1]
    PYTHON = re.search(r"sys.version_info < \((\d+), (\d+)\)", read("scripts/python_environment.sh")).groups()

    recipe, told = spack()
    variants = {first: more["default"] for name, first, more in told if name == "variant"}
    needs = {first: more for name, first, more in told if name == "depends_on"}
    check("Spack: the recipe is one of CMake, with a version and a licence", issubclass(recipe, CMakePackage) and
          {"version", "license"} <= {name for name, *_ in told}, told)
    recipe.chosen = variants
    usual = dict(recipe().cmake_args())
    check("Spack: what it defines are options of CMakeLists.txt", set(usual) <= OPTIONS, set(usual) - OPTIONS)
    for variant in variants:
        recipe.chosen = {**variants, variant: not variants[variant]}
        changed = [name for name, value in recipe().cmake_args() if value != usual[name]]
        check(f"Spack: the variant {variant} switches one option", len(changed) == 1, changed)
    unknown = [more["when"] for more in needs.values() if more.get("when", "+host").strip("+~") not in variants]
    check("Spack: what is needed sometimes depends on a variant that there is", not unknown, unknown)
    check("Spack: compilers, CMake and Python are those that the build needs",
          {"c", "fortran", f"cmake@{CMAKE}:", "python@{}.{}:".format(*PYTHON), "lapack"} <= set(needs), needs)

    # Only the host needs libraries of its own.
    check("Spack: the host brings its sparse solver and HDF5 with the Fortran interface",
          needs["suite-sparse"].get("when") == needs["hdf5+fortran"].get("when") == "+host", needs)

    text = read("packaging/conda/recipe.yaml")
    defined = dict(re.findall(r"-D(MUD_\w+)=(\w+)", text))
    check("conda: what it defines are options of CMakeLists.txt", defined and set(defined) <= OPTIONS, defined)
    check("conda: CMake and Python are those that the build needs",
          f"cmake >={CMAKE}" in text and "python >={}.{}".format(*PYTHON) in text, text)
    check("conda: without the host it needs neither a sparse solver nor HDF5",
          defined["MUD_BUILD_HOST"] == "OFF" and "suitesparse" not in text and "hdf5" not in text, text)


def test_only_the_host_needs_hdf5():
    # CMake, told that HDF5 is not there: the host says what is missing, and the rest is configured.
    def configured(*options):
        done = subprocess.run(["cmake", "-S", root, "-B", work / "tree", "-DCMAKE_DISABLE_FIND_PACKAGE_HDF5=ON",
                               "-DMUD_BUILD_TESTS=OFF", f"-DMUD_PYTHON={sys.executable}", *options],
                              capture_output=True, text=True)
        return done.returncode, " ".join((done.stdout + done.stderr).split())
    code, told = configured()
    check("the host asks for it by name, or to be left out", code != 0 and
          all(words in told for words in ("mud_host needs HDF5", "libhdf5-dev", "MUD_BUILD_HOST=OFF")), told)
    code, told = configured("-DMUD_BUILD_HOST=OFF")
    check("without the host nothing asks for it", code == 0, told)
    for file in ("drivers/mud_triax", "drivers/libmud_triax.so", "umat/libmud.so"):
        linked = subprocess.run(["objdump", "-p", build / file], capture_output=True, text=True).stdout
        check(f"{file} is not linked with it", "NEEDED" in linked and "hdf5" not in linked, linked)
