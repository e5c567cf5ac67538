# SPDX-License-Identifier: GPL-3.0-or-later
"""Sphinx: the site's pages are those of docs and those beside this file, collected by scripts/site."""

import re
from pathlib import Path

from holomorph import __version__
from holomorph.core import addresses
from numpy.typing import ArrayLike
from sphinx.util.typing import stringify_annotation

WORK = Path(__file__).resolve().parents[2] / "build" / "site-work"

project, author, copyright = "Holomorph", "the authors of Holomorph", "GPL-3.0-or-later"
version = release = __version__
extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.mathjax",
    "sphinx_copybutton",
    "sphinx_design",
]
nitpicky = True
# Types of the annotations which have no page here.
nitpick_ignore_regex = [("py:.*", r"(?!holomorph).*"), ("py:.*", r"holomorph\.(core\.array_types|_native)\..*")]
# Bases, whose members stand with each of the public classes.
nitpick_ignore_regex += [("py:class", r"holomorph\.forms\.(results\.Structure|form_structure\.FormStructure)")]
nitpick_ignore_regex += [("py:class", r"holomorph\.plane\.cut\.AStructure")]  # a type variable

myst_enable_extensions = ["dollarmath", "colon_fence", "attrs_inline"]
myst_fence_as_directive = ["math"]
myst_heading_anchors = 4

default_role = "code"
autodoc_member_order = "bysource"
maximum_signature_line_length = 90
add_module_names = False

html_theme = "furo"
html_title = "Holomorph"
html_baseurl = addresses.DOCUMENTATION
html_static_path = [str(WORK / "static")]
html_css_files = ["site.css"]
html_show_search_summary = False  # it would fetch the pages, which files may not
html_show_sourcelink = html_copy_source = html_show_sphinx = False
mathjax_path = "mathjax.js"
mathjax3_config = {"svg": {"fontCache": "global"}}
html_theme_options = {
    "light_css_variables": {"color-brand-primary": "#a4431c", "color-brand-content": "#a4431c"},
    "dark_css_variables": {"color-brand-primary": "#f0925e", "color-brand-content": "#f0925e"},
}


ARRAY_LIKE = stringify_annotation(ArrayLike, "smart")
ENTRY = re.compile(r"^(\w+(?:, \w+)*) : (.*)$")


def without_substitutions(line):
    """|z| is an absolute value, not reStructuredText."""
    parts = line.split("`")
    parts[::2] = [part.replace("|", "\\|") for part in parts[::2]]
    return "`".join(parts)


def as_definitions(app, what, name, thing, options, lines):
    """Docstrings list arguments and fields as numpydoc does, `name : text`, with or without a heading above."""
    found, was_entry = [], False
    lines[:] = [without_substitutions(line) for line in lines]
    for line, below in zip(lines, [*lines[1:], ""]):
        entry = ENTRY.match(line)
        if entry:
            found += ["", f"``{entry[1]}``", f"    {entry[2]}"]
        elif below.startswith("----"):
            found += ["", f"**{line}**", ""]
        elif not line.startswith("----"):
            found += [""] * (was_entry and line[:1].strip() != "") + [line]
        was_entry = bool(entry) or (was_entry and line.startswith(" "))
    lines[:] = found


def short_types(app, what, name, thing, options, signature, returned):
    """NumPy's ArrayLike by its name, not by the union that it stands for."""
    return tuple(text and text.replace(ARRAY_LIKE, "ArrayLike") for text in (signature, returned))


def link_home(app, name, source):
    """The site's home takes the place of the repository's first page; pages of docs/site are beside those of docs."""
    source[0] = source[0].replace("](../README.md)", "](index.md)")
    source[0] = re.sub(r"\]\(((?:\.\./)*)site/", r"](\1", source[0])


def add_contents(app, name, source):
    """A page with a folder of its name has the pages there below it, in the order in which it links to them."""
    below = dict.fromkeys(re.findall(rf"\]\(({name}/[\w-]+)\.md", source[0]))
    if below:
        source[0] += "\n".join(["\n```{toctree}", ":hidden:", "", *below, "```", ""])


def setup(app):
    app.connect("source-read", link_home)
    app.connect("source-read", add_contents)
    app.connect("autodoc-process-signature", short_types)
    app.connect("autodoc-process-docstring", as_definitions)
