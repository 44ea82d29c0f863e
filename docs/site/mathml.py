# SPDX-License-Identifier: MIT
"""Formulas as MathML: made when the site is built, so that the browser needs no script and no network.

latex2mathml reads the formula. What browsers do not draw (they know no attribute for bold letters) or what it leaves
to chance (the space around the name of a function, bars and brackets that open and close) is put right here. A formula
that cannot be read, or has a command that latex2mathml does not know, is an error.
"""
import re
import xml.etree.ElementTree as ElementTree

from docutils import nodes
from latex2mathml.converter import convert
from sphinx.errors import ExtensionError

NAMESPACE = "http://www.w3.org/1998/Math/MathML"
FUNCTIONS = {"ln", "exp", "cos", "sin", "tan", "min", "max", "tr", "dev", "sgn", "diag"}
OPENING, CLOSING = "([⟨", ")]⟩"
# Bold letters are characters of their own: the first of each alphabet, upright, and Greek in italics.
BOLD = [("A", "Z", 0x1D400), ("a", "z", 0x1D41A), ("0", "9", 0x1D7CE), ("Α", "Ω", 0x1D71C), ("α", "ω", 0x1D736)]
THIN, PLUS_LIKE = "0.167em", set("+-−=±<>≤≥≠≈,;:/·→←⇒")


def bold(text):
    for first, last, place in BOLD:
        if len(text) == 1 and first <= text <= last:
            return chr(place + ord(text) - ord(first))
    raise ExtensionError(f"there is no bold letter for {text!r}")


def joined(row):
    """An upright word comes as a letter each: one identifier of it."""
    letters = list(row)
    if len(letters) > 1 and all(one.tag == "mi" and one.get("mathvariant") == "normal" for one in letters):
        word = ElementTree.Element("mi")
        word.text = "".join(one.text for one in letters)
        return word
    return letters[0] if len(letters) == 1 and row.tag == "mrow" else row


def is_function(element):
    """A name, or a name with an index: max over i."""
    if element.tag in ("msub", "msup", "munder", "mrow") and len(element):
        return is_function(element[0]) and (element.tag != "mrow" or len(element) == 1)
    return element.tag in ("mi", "mo") and element.text in FUNCTIONS


def fence(element, opens):
    element.tag = "mo"
    element.attrib.update(form="prefix" if opens else "postfix", stretchy="false", lspace="0", rspace="0")


def starts_operand(element):
    """An operator or an opening bracket, behind which a name needs no space and a minus is a sign."""
    text = element.text or " "
    return element.tag == "mo" and (text in PLUS_LIKE or text in OPENING or element.get("form") == "prefix")


def spaced(row):
    """The children with space around names of functions, and bars that open or close."""
    made, bars = [], 0
    for element in row:
        text = element.text or ""
        if element.tag in ("mi", "mo") and text in "⟨⟩" and text and "fence" not in element.attrib:
            fence(element, text == "⟨")
        elif element.tag == "mo" and text == "|" and "fence" not in element.attrib:
            bars += 1
            fence(element, bars % 2 == 1)
        elif element.tag == "mi" and text == ":":
            element.tag = "mo"
            element.attrib.update(lspace="0.2em", rspace="0.2em")
        before = made[-1] if made else None
        if text in ("-", "−") and element.tag == "mo" and (before is None or starts_operand(before)):
            element.attrib.update(form="prefix", lspace="0", rspace="0")
        opens = text.startswith(tuple(OPENING))
        if before is not None and is_function(before) and not opens and element.tag != "mspace":
            made.append(ElementTree.Element("mspace", width=THIN))
        elif before is not None and is_function(element) and before.tag != "mspace" and not starts_operand(before):
            made.append(ElementTree.Element("mspace", width=THIN))
        made.append(element)
    return made


def corrected(element):
    children = [corrected(child) for child in element]
    if variant := element.attrib.get("mathvariant"):
        if variant.startswith("bold"):
            element.text = bold(element.text)
            del element.attrib["mathvariant"]
    for child in list(element):
        element.remove(child)
    element.extend(children)
    if element.tag == "mrow":
        element = joined(element)
    if element.tag in ("mrow", "math", "mtd"):
        row = spaced(list(element))
        for child in list(element):
            element.remove(child)
        element.extend(row)
    if element.tag == "mo" and element.text in FUNCTIONS:
        element.attrib.update(lspace="0", rspace="0")
    return element


def mathml(source, display):
    """The element <math> of a formula in LaTeX; ExtensionError where it cannot be read or has an unknown command."""
    if environment := re.search(r"\\(?:begin|end)\{(?!aligned|cases|pmatrix|bmatrix)", source):
        raise ExtensionError(f"an environment that is not known: {environment[0]} in {source!r}")
    try:
        made = convert(source.strip(), display="block" if display else "inline")
        tree = ElementTree.fromstring(made.replace(f' xmlns="{NAMESPACE}"', ""))
    except Exception as error:
        raise ExtensionError(f"the formula cannot be read: {source!r}: {error}") from error
    if unknown := [one.text for one in tree.iter() if (one.text or "").startswith("\\")]:
        raise ExtensionError(f"the formula has an unknown command, {unknown[0]}: {source!r}")
    return ElementTree.tostring(corrected(tree), encoding="unicode")


def inline(writer, node):
    writer.body.append(mathml(node.astext(), False))
    raise nodes.SkipNode


def block(writer, node):
    writer.body.append(f'<div class="formula">{mathml(node.astext(), True)}</div>\n')
    raise nodes.SkipNode


def setup(app):
    app.add_html_math_renderer("mathml", (inline, None), (block, None))
    app.config.html_math_renderer = "mathml"
    return {"parallel_read_safe": True, "parallel_write_safe": True}
