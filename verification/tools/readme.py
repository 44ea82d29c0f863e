# SPDX-License-Identifier: MIT
"""Parts of README files that the runner writes: between `<!-- made: MARK -->` and `<!-- end -->`."""
import re

from . import page, tables

INDEX_HEAD = ("page", "kind", "claim", "seconds")


def block(text, mark):
    """What stands between the marks; None if they are not there."""
    found = re.search(rf"<!-- made: {re.escape(mark)} -->\n(.*?)<!-- end -->", text, re.DOTALL)
    return found[1] if found else None


def replaced(text, mark, content):
    if block(text, mark) is None:
        raise ValueError(f"there is no mark <!-- made: {mark} -->")
    return re.sub(rf"(<!-- made: {re.escape(mark)} -->\n).*?(<!-- end -->)",
                  lambda m: m[1] + made(content) + m[2], text, flags=re.DOTALL)


def made(content):
    """What stands between the marks."""
    return tables.wrapped(content.rstrip("\n"))


def cell(text):
    return " ".join(str(text).split()).replace("|", "\\|")


def declaration(name, declared):
    """What the page declares, as the head of its README."""
    part = f"{declared.quick:g} s of it in the check run" if declared.quick else "not part of the check run"
    return tables.markdown(("", ""), [
        ("claim", cell(declared.claim)),
        ("kind", "; ".join(f"**{kind}**: {page.KINDS[kind]}" for kind in declared.kind)),
        ("input", cell(declared.input)),
        ("reference", cell(declared.reference)),
        ("run", f"`verification/run {name}`: {declared.seconds:g} s, {part}")])


def measured(checks):
    """The table of checks of a whole run, and the reasons of what is allowed."""
    reasons = list(dict.fromkeys(c.because for c in checks))
    lines = [(cell(c.name) + (f" [{c.unit}]" if c.unit else ""), f"{c.value:.8g}" if c.single else f"{c.value:.2g}"
              if c.bound else "",
              f"{c.reference:.8g}" if c.single else "", "" if c.bound else f"{c.off:.2g}",
              ("at most " if c.bound else "")
              + f"{c.allowed:.2g}",
              reasons.index(c.because) + 1) for c in checks]
    return (tables.markdown(("check", "measured", "reference", "off by", "allowed", "why"), lines) + "\n"
            + "\n".join(f"{i}. {cell(reason)}" for i, reason in enumerate(reasons, 1)) + "\n")


def kinds():
    """The list of kinds of verification/README.md."""
    return "".join(f"- **{kind}**: {meaning}\n" for kind, meaning in page.KINDS.items())


def index(pages, sections):
    """The tables of verification/README.md; pages: {name: Page}."""
    parts = []
    for section, title in sections.items():
        lines = [(f"[{name.split('/')[1]}]({name}/README.md)", ", ".join(p.kind), cell(p.claim),
                  f"{p.seconds:g}" + (f" ({p.quick:g})" if p.quick else "")) for name, p in pages.items()
                 if name.split("/")[0] == section]
        if lines:
            parts.append(f"## {section}: {title}\n\n" + tables.markdown(INDEX_HEAD, lines))
    return "\n".join(parts)
