# SPDX-License-Identifier: MIT
"""Configuration of Sphinx. The pages are those of stage.py; the output holds all that a browser needs."""
import pathlib
import re
import sys

here = pathlib.Path(__file__).parent
root = here.parents[1]
sys.path[:0] = [str(here), str(root / "python")]

project = "MUD"
author = "the MUD contributors"
release = re.search(r"project\(mud VERSION (\S+)", (root / "CMakeLists.txt").read_text(encoding="utf-8"))[1]
version = release

extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx.ext.mathjax",
              "sphinx-mathjax-offline"]
mathjax_path = "mathjax/tex-svg.js"   # from the package, drawn without fonts: a page needs no network
root_doc = "index"
nitpicky = False
templates_path = []

# The pages are written for the viewer of a forge: its headings are link targets, and ```math is a formula.
myst_enable_extensions = ["dollarmath"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4
myst_dmath_allow_digits = False
myst_links_external_new_tab = False

html_theme = "furo"
html_title = f"MUD {release}"
html_static_path = [str(here / "static")]
html_css_files = ["site.css"]
html_copy_source = False
html_show_copyright = False
html_show_sphinx = False
highlight_language = "none"

ARGUMENT = re.compile(r"^(\w[\w, ]*?) : (?=\S)")


def list_of_arguments(app, what, name, thing, options, lines):
    """Docstrings say `name : what it is` a line an argument: a list, with its further lines set in."""
    made, within = [], False
    for line in lines:
        if ARGUMENT.match(line):
            made += [] if within else [""]
            line, within = "- " + ARGUMENT.sub(r"**\1**: ", line), True
        elif within and line.strip():
            line = "  " + line.strip()
        elif within:
            within = False
        made.append(line)
    lines[:] = made


def setup(app):
    app.connect("autodoc-process-docstring", list_of_arguments, priority=100)


autodoc_member_order = "bysource"
autodoc_typehints = "signature"
autodoc_mock_imports = ["h5py", "matplotlib", "openpyxl", "pandas", "scipy"]
