# SPDX-License-Identifier: MIT
"""Heads of laboratory tables: the quantity, its unit, and whether a stress is effective or total.

Words and units are data: another language, laboratory or unit is another entry of the tables below.
"""

from __future__ import annotations

import dataclasses
import functools
import re
import unicodedata

import numpy as np

WATER = 9.80665  # [kPa] pressure of a metre of water
# Unit: what it measures, its worth (a fraction, or kPa), other spellings in the form of ``_plain_unit``.
UNITS = {
    "percent": ("share", 0.01, "% pct pc prozent vol% vol.%"),
    "permille": ("share", 1e-3, "‰ promille"),
    "microstrain": ("share", 1e-6, "με μm/m"),
    "fraction": ("share", 1.0, "m/m mm/mm cm/cm m3/m3"),
    "kPa": ("stress", 1.0, "kn/m2 knm-2 knpersqm kilopascal"),
    "Pa": ("stress", 1e-3, "n/m2 nm-2 pascal"),
    "hPa": ("stress", 0.1, ""),
    "MPa": ("stress", 1e3, "mn/m2 mnm-2 n/mm2 nmm-2 megapascal"),
    "GPa": ("stress", 1e6, ""),
    "bar": ("stress", 100.0, "bars"),
    "mbar": ("stress", 0.1, "millibar"),
    "atm": ("stress", 101.325, ""),
    "kg/cm2": ("stress", 98.0665, "kgf/cm2 kp/cm2 kgcm-2 kgfcm-2 at"),
    "t/m2": ("stress", 9.80665, "tf/m2"),
    "psi": ("stress", 6.894757293168361, "lb/in2 lbf/in2 lbs/in2"),
    "ksi": ("stress", 6894.757293168361, ""),
    "psf": ("stress", 0.04788025898033584, "lb/ft2 lbf/ft2 lbs/ft2"),
    "ksf": ("stress", 47.88025898033584, "kip/ft2"),
    "tsf": ("stress", 95.76051796067168, "ton/ft2 tons/ft2"),
    "m": ("water", WATER, "mh2o mws mwater"),
    "cm": ("water", WATER / 100, "cmh2o cmws cmwater"),
    "mm": ("suction", WATER / 1000, "mmh2o mmws"),  # of a pore pressure nobody gives it
    "pF": ("pF", WATER / 100, "logcm log10cm"),  # decimal logarithm of centimetres of water
}
NO_UNITS = ("", "-", "–", "—", "1", "[-]", "none", "ohne")

# Quantity: what it is measured in, and its names: letters and figures alone, in lower case, ä as ae. Behind the quantity
# stands what its names say of the stress. A name in the form of the library, as eps_a, is one of them.
WORDS = {
    "test": (
        "sample specimen testno testname sampleno testid probe probennummer probenr versuch versuchsnr ensayo "
        "muestra essai"
    ),
    "control": "",
    "cycle_by": "cycleby",
    "eps_a": (
        "eps1 epsaxial axialeverformung epsilona epsilon1 εa ε1 axialstrain verticalstrain axialdehnung "
        "axialedehnung vertikaldehnung vertikaledehnung dehnung stauchung axialstauchung axialestauchung "
        "axialverformung vertikalverformung strain"
    ),
    "eps_v": (
        "epsvol volumetrischeverformung epsilonv epsilonvol εv εvol volumetricstrain volumestrain volstrain "
        "volumechange volumendehnung volumenaenderung volumetrischedehnung volumenstauchung volumenverformung"
    ),
    "gamma": "γ shearstrain engineeringshearstrain scherdehnung gleitung schubverzerrung scherverzerrung schiebung",
    "q": (
        "sigma1sigma3 σ1σ3 deviatorstress deviatoricstress stressdifference principalstressdifference "
        "deviator deviatorspannung spannungsdeviator deviatorischespannung spannungsdifferenz "
        "hauptspannungsdifferenz"
    ),
    "p": (
        "meanstress meannormalstress meanprincipalstress mittlerespannung mittlerehauptspannung "
        "mittlerenormalspannung mittlererdruck"
    ),
    "sigma_a": (
        "sigma1 sigmav sigmaa sig1 siga sigv σ1 σv σa s1 axialstress verticalstress axialspannung "
        "axialespannung vertikalspannung vertikalespannung auflastspannung"
    ),
    "sigma_r": (
        "sigma3 sigmah sigmar sig3 sigr sigh σ3 σh σr s3 sigmac σc radialstress lateralstress "
        "horizontalstress confiningstress confiningpressure confpressure confstress radialspannung "
        "radialespannung horizontalspannung seitenspannung seitendruck"
    ),
    "sigma_r cell": "cellpressure chamberpressure zelldruck",
    "u": "uw porepressure porewaterpressure pwp porenwasserdruck porendruck",
    "u back": "backpressure gegendruck saettigungsdruck",
    "u excess": "du δu excessporepressure excessporewaterpressure excesspwp porenwasserueberdruck porenueberdruck",
    "p_0": "p0 initialmeanstress consolidationstress consolidationpressure konsolidationsspannung",
    "amplitude": "stressamplitude strainamplitude spannungsamplitude dehnungsamplitude",
    "e": "voidratio porenzahl porenziffer",
    "e_0": (
        "e0 voidratioe0 porenzahle0 einit eini einitial initialvoidratio voidratioatstart anfangsporenzahl "
        "anfaenglicheporenzahl porenzahlzubeginn"
    ),
    "suction": (
        "pc soilsuction soilwatersuction suctionhead matrichead ψ matricsuction suctionpressure "
        "capillarypressure saugspannung saugdruck matrixsaugspannung kapillardruck"
    ),
    "S_w": "sw degreeofsaturation saturation saturationdegree saettigung saettigungsgrad wassersaettigung",
    "stress_ratio": (
        "sr sigma1/sigma3 σ1/σ3 sigmaa/sigmar stressratio principalstressratio hauptspannungsverhaeltnis "
        "spannungsverhaeltnis"
    ),
    "cycle": "cycleno cyclenumber zyklus zyklusnr zyklusnummer",
    "r_u": "ru porepressureratio porenwasserdruckverhaeltnis porendruckverhaeltnis",
    "G_max": "gmax g0 smallstrainshearmodulus maximumshearmodulus anfangsschubmodul",
    "G_ratio": "gratio g/gmax g/g0 modulusratio",
    "damping": "dampingratio daempfung daempfungsgrad daempfungsmass",
    "csr": "cyclicstressratio crr zyklischesspannungsverhaeltnis",
    "N": "cyclestoliquefaction numberofcycles nliq zyklenzahl zyklenbiszurverfluessigung",
}
MEASURES = (
    dict.fromkeys(("eps_a", "eps_v", "gamma"), ("share",))
    | dict.fromkeys(("q", "p", "sigma_a", "sigma_r", "p_0", "G_max"), ("stress",))
    | {"u": ("stress", "water"), "suction": ("stress", "water", "suction", "pF"), "amplitude": ("share", "stress")}
    | dict.fromkeys(("S_w", "r_u", "damping"), ("share",))
)
# Words that mean something else in tables of one kind.
OF_A_KIND = {
    "retention": {"sr": "S_w"},
    "oedometer": dict.fromkeys(("stress", "pressure", "spannung", "druck"), "sigma_a"),
    "isotropic": dict.fromkeys(("stress", "pressure", "spannung", "druck"), "p")
    | dict.fromkeys(("cellpressure", "chamberpressure", "zelldruck"), "p cell")
    | dict.fromkeys(("strain", "dehnung"), "eps_v"),
}
# Words before a symbol that leave it to the symbol what is meant.
GENERAL = ("stress", "strain", "pressure", "spannung", "hauptspannung", "principalstress", "dehnung", "druck")
UNIT_IN_NAME = {"pf": ("suction", "pF"), "pfwert": ("suction", "pF"), "pfvalue": ("suction", "pF")}
# What a head says of a stress; a prime says effective too.
STATES = {
    "effective": "effective effektive effektiver effektives effektiv effektiven eff wirksame wirksamer wirksam wirksamen",
    "total": "total totale totaler totales totalen tot gesamt",
}
PRIMES = "'′’´`ʹ"
NOISE = re.compile(r"[\s_]+(derived|initial|measured|gemessen)(?=$|[\s_])")  # words behind a name that change nothing
CAPITALS = ("P", "Q", "U")  # loads, forces and voltages unless a stress stands behind them
OTHERS = ("E", "n")  # Young's modulus, porosity

PLAIN = ("eps_1", "sigma_1", "sigma_3", "e0", "sr")  # other names that calibration/README.md lists
STRESSES = ("p", "sigma_a", "sigma_r", "p_0")  # that are effective or total; q is the same in both
_NAMES = {word: key.partition(" ")[::2] for key, words in WORDS.items() for word in words.split()}
_NAMES |= {key.replace("_", "").lower(): (key, "") for key in WORDS if " " not in key}
_STATES = {word: state for state, words in STATES.items() for word in words.split()}
_UNITS = {word: unit for unit, (_, _, words) in UNITS.items() for word in (unit.lower(), *words.split())}


@dataclasses.dataclass(frozen=True)
class Head:
    """A column's head. quantity : a key of WORDS, empty if the head is not understood."""

    title: str  #: as the sheet has it
    quantity: str = ""
    state: str = ""  #: of a stress: effective, total, cell (pressure) or unsaid; of u: back, excess or unsaid
    unit: str = ""  #: a key of UNITS
    strange: str = ""  #: what stands where a unit should, and is none
    near: str = ""  #: the quantity where ``strange`` may as well be a part of another name

    def inside(self, values: np.ndarray) -> np.ndarray:
        """Numbers of the column as fractions and kPa."""
        measures = UNITS[self.unit][0] if self.unit else ""
        return self.worth * (10.0**values if measures == "pF" else values)

    @property
    def worth(self) -> float:
        """What one of its unit is as a fraction or in kPa; 1 without a unit."""
        return UNITS[self.unit][1] if self.unit else 1.0

    def is_plain(self) -> bool:
        """Whether it is written as the library writes it: the name, or one of PLAIN, and the unit behind it."""
        return self.title.removesuffix(f"_{self.unit}") in (self.quantity, *PLAIN)

    def told(self) -> str:
        """What it is understood as."""
        unit = f" in {self.unit}".replace("percent", "%") if self.unit else ", no unit"
        return f"{self.state} {self.quantity}".strip().replace("cell ", "total ") + unit

    def wrong_unit(self) -> str:
        """Why its unit cannot be, or nothing."""
        quantity = self.quantity or self.near
        allowed = MEASURES.get(quantity, ())
        if self.strange:
            reason = f"{self.strange} is no unit that is known"
        elif self.unit and quantity and UNITS[self.unit][0] not in allowed:
            reason = f"{self.unit} is a unit that {quantity} cannot have"
        else:
            return ""
        known = ", ".join(unit for unit, (measures, _, _) in UNITS.items() if measures in allowed)
        return f"{self.title}: {reason}; {quantity} has {known or 'no unit'}"


@functools.lru_cache(maxsize=4096)
def head_of(title: str, kind: str) -> Head:
    """A head as it is understood in a table of a kind."""
    text = title.strip()
    for letters, letter in ((PRIMES, "'"), ("²", "2"), ("⁻−", "-")):
        text = re.sub(f"[{letters}]", letter, text)
    text, unit, strange, near = unicodedata.normalize("NFKC", text).split("=")[0], "", "", ""
    # Brackets: a unit; a remark on the stress or the symbol of the name; else something that should be a unit.
    for found in re.findall(r"[\[({<][^\[\](){}<>]*[\])}>]", text):
        bare, inner = text.replace(found, " ", 1), found[1:-1].strip()
        if unit_of(inner) or inner in NO_UNITS:
            text, unit = bare, unit_of(inner)
        elif not _quantity(text, kind)[0] and _quantity(bare, kind)[0]:
            text, strange = bare, inner
    if not _quantity(text, kind)[0]:
        text = NOISE.sub("", text)
    quantity, state = _quantity(text, kind)
    for cut, sure in ((r"/", True), (r"\sin\s", True), (r"[\s_,]+", False)) if not quantity else ():
        for place in re.finditer(cut, text):
            (stem, said), rest = _quantity(text[: place.start()], kind), text[place.end() :].strip(" /")
            measures = UNITS[unit_of(rest)][0] if unit_of(rest) else ""
            if not stem or quantity or _quantity(rest, kind)[0] not in ("", "N"):
                continue  # of two quantities: a ratio
            index = measures in ("water", "suction") and measures not in MEASURES.get(stem, ())  # as in p_m
            if measures and not index or rest in NO_UNITS:
                quantity, state, unit, near, strange = stem, said, unit_of(rest), "", ""
            elif sure:
                quantity, state, strange = stem, said, rest
            elif not unit:
                near, strange = stem, rest
    if not quantity and re.sub(r"[\s\-]", "", text).lower() in UNIT_IN_NAME:
        quantity, unit = UNIT_IN_NAME[re.sub(r"[\s\-]", "", text).lower()]
    if text.strip(" _") in CAPITALS and not (unit and UNITS[unit][0] == "stress"):
        quantity = strange = ""
    return Head(title.strip(), quantity, state if quantity else "", unit, strange, near)


def unit_of(text: str) -> str:
    """A unit as UNITS has it, empty if it is none: MPa in letters of any size, since nobody measures soil in mPa."""
    return _UNITS.get(re.sub(r"[\s^*·]", "", text).lower(), "")


def _quantity(text: str, kind: str) -> tuple[str, str]:
    """(quantity, what is said of the stress) of a name without a unit; empty if it is not understood."""
    words, said = [], ["effective"] if "'" in text else []
    for word in re.split(r"[\s_.,:;\-'\[\](){}<>]+", text):
        plain = word.lower()
        mark = next(
            (
                m
                for m in _STATES
                if plain == m or len(m) > 2 and _known(plain.removeprefix(m).removesuffix(m), plain, kind)
            ),
            "",
        )
        said += [_STATES[mark]] if mark else []  # Effektivspannung and sig3eff are one word
        words.append(word[len(mark) :] if plain.startswith(mark) else word[: -len(mark)])
    words = [word for word in words if word]
    quantity, own = _lookup(words, kind)
    for cut in range(1, len(words)) if not quantity else ():  # a name and its symbol
        (left, own_left), (right, own_right) = _lookup(words[:cut], kind), _lookup(words[cut:], kind)
        if right and (left == right or "".join(words[:cut]).lower() in GENERAL):
            quantity, own = right, own_left or own_right
            break
    state = said[0] if said else own
    if quantity in STRESSES or own and quantity == "u":
        return quantity, state if quantity in STRESSES else own
    # The effective degree of saturation is another quantity; q, strains and pore pressures are the same.
    return ("", "") if state == "effective" and quantity in ("S_w", "e", "e_0") else (quantity, "")


def _known(rest: str, word: str, kind: str) -> bool:
    return rest != word and bool(rest in GENERAL or _lookup([rest], kind)[0])


def _lookup(words: list[str], kind: str) -> tuple[str, str]:
    plain = "".join(words)
    if plain in OTHERS:
        return "", ""
    plain = plain.lower()
    for letter, other in (("ä", "ae"), ("ö", "oe"), ("ü", "ue"), ("ß", "ss")):
        plain = plain.replace(letter, other)
    special = OF_A_KIND.get(kind, {}).get(plain)
    return special.partition(" ")[::2] if special else _NAMES.get(plain, ("", ""))
