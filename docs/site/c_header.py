# SPDX-License-Identifier: MIT
"""mud.h as a page: its comments as text, its functions as entries of the index, everything else unchanged."""
import re

SECTION = re.compile(r"/\* --- (.*?) -*\s*\*/")
FUNCTION = re.compile(r"(?:int|void|double)\s+\w+\s*\([^;{}]*\);")

# What a compiler alone needs; structures and enumerations, or a line.
FRAME = re.compile(r"#ifdef __cplusplus.*?#endif\n|#(?:ifndef|define) MUD_H\n|#endif\s*$|#endif\n", re.DOTALL)
CODE = re.compile(r"(?:typedef struct|enum)[^{]*\{.*?\}[^;]*;(?:\n(?=enum).*?\};)?|[^\n]*\n", re.DOTALL)


def escaped(text):
    return re.sub(r"([*_<>\[\]`$\\])", r"\\\1", text)


def prose(comment):
    """The text of a comment; lines that it sets in further than the rest stay as they are."""
    lines = [re.sub(r"^ ?\*? ?", "", line) if number else line.strip()
             for number, line in enumerate(comment.strip()[2:-2].strip("\n").splitlines())]
    made, literal = [], False
    for line in lines:
        inset = line.startswith("   ") or (line.startswith("  ") and not line.startswith("   "))
        if inset and line.strip():
            made += (["", "```text"] if not literal else []) + [line.strip()]
            literal = True
            continue
        made += ["```", ""] if literal else []
        literal = False
        made.append(escaped(line.strip()))
    return "\n".join(made + (["```"] if literal else [])).strip() + "\n"


def pieces(text):
    """("section", title), ("comment", text), ("function", prototype), ("code", text) in their order."""
    text = text[text.index("/* MUD:"):]
    while text := text.lstrip():
        if found := SECTION.match(text):
            yield "section", found[1]
        elif found := re.match(r"/\*.*?\*/", text, re.DOTALL):
            yield "comment", found[0]
        elif found := FUNCTION.match(text):
            yield "function", found[0]
        elif found := FRAME.match(text):
            pass
        elif found := CODE.match(text):
            yield "code", found[0].rstrip()
        else:
            raise ValueError(f"mud.h: what is this? {text[:80]!r}")
        text = text[found.end():]
        # A remark on the line of a declaration belongs to it.
        if remark := re.match(r"[ \t]*/\*[^\n]*?\*/(?=\n)", text):
            yield "comment", remark[0].strip()
            text = text[remark.end():]


def page(header):
    lines = ["# The C header", "", "`umat/include/mud.h`. A Fortran program uses "
             "`umat/include/mud_interface.f90`, whose procedures have the same names and arguments.", ""]
    first = True
    for kind, text in pieces(header.read_text(encoding="utf-8")):
        if kind == "section":
            lines += [f"## {text[0].upper()}{text[1:]}", ""]
        elif kind == "comment":
            lines += [prose(text), ""]
            if first:
                lines += ["## Constants and reports", ""]
            first = False
        elif kind == "function":
            lines += ["```{c:function} " + " ".join(text.rstrip(";").split()), "```", ""]
        else:
            lines += ["```c", text, "```", ""]
    return "\n".join(lines)
