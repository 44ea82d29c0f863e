# SPDX-License-Identifier: MIT
"""Reads the symbols of both MFront behaviours as MGIS does when it loads a library: by name, the count first."""
import ctypes
import os
import pathlib
import re
import subprocess
import sys
import tempfile

sys.path.append(str(pathlib.Path(__file__).parents[1] / "support"))
from checking import build, check, loads_library

library = build / "umat/libmud.so"
HYPOTHESES = ["Tridimensional", "PlaneStrain", "Axisymmetrical", "GeneralisedPlaneStrain",
              "AxisymmetricalGeneralisedPlaneStrain"]
SCALAR, SYMMETRIC = 0, 1
# Names that hosts give to variables of their own (OpenGeoSys, MGIS, FEniCSx wrappers): a state variable of one of them
# is fatal or silently another one.
TAKEN = {"saturation", "void_ratio", "suction", "porosity", "layout", "Saturation", "Stress", "Strain", "Temperature",
         "EquivalentPlasticStrain", "material_state_variable_saturation", "displacement", "pressure", "sigma", "open"}


class Behaviour:
    """What MGIS reads of one behaviour. A symbol that is not there raises ValueError."""

    def __init__(self, mud, name):
        self.mud, self.name = mud, name

    def flag(self, what):
        return ctypes.c_ushort.in_dll(self.mud, f"{self.name}_{what}").value

    def text(self, what):
        return ctypes.c_char_p.in_dll(self.mud, f"{self.name}_{what}").value.decode()

    def names(self, what):
        n = self.flag(f"n{what}")
        array = (ctypes.c_char_p * max(n, 1)).in_dll(self.mud, f"{self.name}_{what}")
        return [array[i].decode() for i in range(n)]

    def types(self, what):
        n = self.flag(f"n{what}")
        return list((ctypes.c_int * max(n, 1)).in_dll(self.mud, f"{self.name}_{what}Types"))[:n]


def common(mud, name, props, statev):
    b = Behaviour(mud, name)
    expected = {"mfront_mkt": 1, "api_version": 1, "SymmetryType": 0, "ElasticSymmetryType": 0,
                "requiresStiffnessTensor": 0, "requiresThermalExpansionCoefficientTensor": 0, "nParameters": 0,
                "ComputesInternalEnergy": 0, "ComputesDissipatedEnergy": 0, "nInitializeFunctions": 0,
                "nPostProcessings": 0, "TemperatureRemovedFromExternalStateVariables": 1,
                "nExternalStateVariables": 0, "UsableInPurelyImplicitResolution": 1}
    found = {what: b.flag(what) for what in expected}
    check(f"{name} is a behaviour of API version 1 that asks for nothing", found == expected, found)
    check(f"{name} says its name and interface",
          (b.text("mfront_ept"), b.text("mfront_interface")) == (name, "Generic"))
    for what in ("tfel_version", "unit_system", "src", "author", "date", "validator", "build_id", "description"):
        check(f"{name} has the text {what}", b.text(what) is not None)
    check(f"{name} takes PROPS by the names of the registry", b.names("MaterialProperties") == props)
    variables = b.names("InternalStateVariables")
    check(f"{name} keeps STATEV behind a prefix", variables == [f"mud_{word}" for word in statev], variables[:3])
    check(f"{name} keeps numbers only", set(b.types("InternalStateVariables")) == {SCALAR})
    check(f"no variable of {name} has a name that is taken", not TAKEN & set(variables), TAKEN & set(variables))
    check(f"every variable of {name} is an identifier", all(re.fullmatch(r"[A-Za-z]\w*", word) for word in variables))
    hypotheses = b.names("ModellingHypotheses")
    check(f"{name} lists its hypotheses", hypotheses == HYPOTHESES, hypotheses)
    check(f"{name} has a function for each hypothesis and no other",
          all(hasattr(mud, f"{name}_{word}") for word in hypotheses) and not hasattr(mud, f"{name}_PlaneStress"))
    for empty in ("ExternalStateVariables", "Parameters", "InitializeFunctions", "PostProcessings"):
        check(f"{name} has no {empty}", b.names(empty) == [])
    check(f"types of what {name} does not have are there all the same",
          b.types("ExternalStateVariables") == b.types("Parameters") == [])
    return b


def shape(b):
    return [b.names(what) for what in ("Gradients", "ThermodynamicForces", "TangentOperatorBlocks")] + [
        b.types("Gradients"), b.types("ThermodynamicForces"),
        b.flag("BehaviourType"), b.flag("BehaviourKinematic"), b.flag("nMainVariables")]


def linked(mud, what):
    n = ctypes.c_int.in_dll(mud, f"mud_{what}_count").value
    return [[word.decode() for word in (ctypes.c_char_p * n).in_dll(mud, f"mud_{what}_{field}")]
            for field in ("names", "units")]


def asked(mud, number, field):
    word = ctypes.create_string_buffer(200)
    return [word.value.decode() for i in range(mud.mud_count(number))
            if mud.mud_text(number, i, field, word, 200) == 0]


def main():
    mud = ctypes.CDLL(str(library))
    props, statev = asked(mud, 1, 1), asked(mud, 2, 1)
    check("names at link time are those of mud_text",
          [linked(mud, "props"), linked(mud, "statev")] == [[props, asked(mud, 1, 3)], [statev, asked(mud, 2, 3)]])
    check("there are names", len(props) == mud.mud_count(1) > 40 and len(statev) == mud.mud_count(2) > 60)
    props = props[:props.index("hysteresis")]   # what stands behind it no host of MFront gives
    statev = statev[:statev.index("turns")]    # likewise
    plain = common(mud, "MUD", props, statev)
    check("MUD is stress against strain", shape(plain) == [
        ["Strain"], ["Stress"], ["Stress", "Strain"], [SYMMETRIC], [SYMMETRIC], 1, 1, 1], shape(plain))
    wet = common(mud, "MUD_StressSaturation", props, statev)
    check("MUD_StressSaturation is stress and saturation against strain and liquid pressure", shape(wet) == [
        ["Strain", "LiquidPressure"], ["Stress", "Saturation"],
        ["Stress", "Strain", "Stress", "LiquidPressure", "Saturation", "Strain", "Saturation", "LiquidPressure"],
        [SYMMETRIC, SCALAR], [SYMMETRIC, SCALAR], 0, 0, 2], shape(wet))


def both_show_the_same():
    listing = subprocess.run(["nm", "-D", "--defined-only", library], check=True, capture_output=True, text=True).stdout
    shown = set(re.findall(r" (MUD_\w+)$", listing, re.MULTILINE))
    wet = {name for name in shown if name.startswith("MUD_StressSaturation_")}
    check("both behaviours show the same kinds of symbols", len(wet) > 40 and
          {name.replace("StressSaturation_", "") for name in wet} == shown - wet, shown)


class View(ctypes.Structure):
    """A point as MGIS hands it over: message, dt, K, rdt, speed of sound, and eight arrays of each state."""
    _fields_ = [("message", ctypes.c_void_p), ("dt", ctypes.c_double), ("rest", ctypes.c_void_p * 19)]


def fail():
    """An increment that is too hard; prints what the host sees."""
    mud = ctypes.CDLL(str(library))
    n, m = mud.mud_count(1), mud.mud_count(2)
    numbers = {"k": (ctypes.c_double * 36)(4.0), "rdt": ctypes.c_double(1.0), "g0": (ctypes.c_double * 6)(),
               "g1": (ctypes.c_double * 6)(-0.02, 0.01, 0.01), "f0": (ctypes.c_double * 6)(-100, -100, -100),
               "f1": (ctypes.c_double * 6)(), "props": (ctypes.c_double * n)(), "v0": (ctypes.c_double * m)(),
               "v1": (ctypes.c_double * m)()}
    mud.mud_default_props(numbers["props"], n)
    numbers["props"][mud.mud_index(1, b"max_substeps")] = 3.0
    message = ctypes.create_string_buffer(512)
    at = {word: ctypes.addressof(value) for word, value in numbers.items()}
    view = View(ctypes.addressof(message), 1.0, (ctypes.c_void_p * 19)(
        at["k"], at["rdt"], None, at["g0"], at["f0"], None, at["props"], at["v0"], None, None, None,
        at["g1"], at["f1"], None, at["props"], at["v1"], None, None, None))
    print(mud.MUD_Tridimensional(ctypes.byref(view)), numbers["rdt"].value < 0.6, message.value.decode())


def failures_are_heard_and_saved():
    with tempfile.TemporaryDirectory() as folder:
        done = subprocess.run([sys.executable, __file__, "fail"], capture_output=True, text=True,
                              env={**os.environ, "MUD_SAVE_FAILED": folder, "MUD_MESSAGES": ""})
        saved = [path.name for path in pathlib.Path(folder).iterdir()]
    check("the host gets code, factor and sentence", done.stdout.startswith("-1 True MUD: too many substeps"),
          done.stdout)
    check("a host that drops the sentence is heard all the same", "MUD: MFront refused the increment" in done.stderr
          and "too many substeps" in done.stderr, done.stderr)
    check("the increment is saved", saved == ["mud_failed_too_many_substeps.nml"], saved)


def test_both_views_show_the_same():
    both_show_the_same()


@loads_library
def test_a_host_of_mgis_reads_and_calls_the_behaviours():
    main()
    failures_are_heard_and_saved()


if __name__ == "__main__" and sys.argv[1:] == ["fail"]:
    fail()
