"""What pyproject.toml says and other files need in their own text: the version, and where the project is found.

An address that its owner has not filled in is named nowhere.
"""

import re
from pathlib import Path

import tomllib

ROOT = Path(__file__).resolve().parents[1]
NUMBER = r"\d+\.\d+\.\d+"
# The files that have the number, and what stands before and after it, each time.
NUMBERS = {
    "pyproject.toml": [r'(?m)^version = "(NUMBER)"$'],
    "CITATION.cff": [r"(?m)^version: (NUMBER)$"],
    "addon/blender_manifest.toml": [r'(?m)^version = "(NUMBER)"$'],
    "addon/__init__.py": [r'"version": \((\d+, \d+, \d+)\)'],
    "docs/blender/install.md": [r"holomorph-(NUMBER)-"],
}
NAMES = ("Homepage", "Documentation", "Issues", "Download")  # in the table [project.urls]
LINKS = {"Homepage": "Home", "Documentation": "Documentation", "Issues": "Report a fault", "Download": "Downloads"}
PICTURE = "![Bricks on a mug, scales on a critter and a lizard]({}/_images/tiling.jpg)"  # of the site


def addresses():
    """{name: address} of those that are filled in."""
    return tomllib.loads((ROOT / "pyproject.toml").read_text(encoding="utf-8"))["project"].get("urls", {})


def links(known):
    """A line of Markdown; empty where no address is known."""
    found = [f"[{LINKS[name]}]({known[name]})" for name in NAMES if name in known]
    return " · ".join(found) + "\n" if found else ""


def address(name, form="{}"):
    """The text for one address."""
    return lambda known: form.format(known[name].rstrip("/")) if name in known else ""


LINE = [(r"<!-- addresses -->\n((?:.+\n)?)", links)]
# The files that name addresses: the pattern of the place, whose group is the text, and what makes it.
ADDRESSES = {
    "README.md": LINE,
    "native/README.md": [*LINE, (r"<!-- picture -->\n((?:.+\n)?)", address("Documentation", PICTURE + "\n"))],
    "docs/blender/install.md": LINE,
    "docs/site/index.md": LINE,
    "CITATION.cff": [(r"(?m)^license: .*\n((?:url: .*\n)?)", address("Homepage", "url: {}\n"))],
    "addon/__init__.py": [
        (r'"doc_url": "(.*)"', address("Documentation")),
        (r'"tracker_url": "(.*)"', address("Issues")),
    ],
    "addon/addresses.py": [
        (r'(?m)^DOCUMENTATION = "(.*)"', address("Documentation")),
        (r'(?m)^DOWNLOAD = "(.*)"', address("Download")),
    ],
    "native/holomorph/core/addresses.py": [
        (r'(?m)^DOCUMENTATION = "(.*)"', address("Documentation")),
        (r'(?m)^ISSUES = "(.*)"', address("Issues")),
    ],
}


def numbers(file):
    """All version numbers of this software in the file, in their order."""
    text = (ROOT / file).read_text(encoding="utf-8")
    found = [n for pattern in NUMBERS[file] for n in re.findall(pattern.replace("NUMBER", NUMBER), text)]
    return [n.replace(", ", ".") for n in found]


def with_addresses(file):
    """The file's text with the addresses of pyproject.toml. @raises LookupError where a place for one is gone"""
    text, known = (ROOT / file).read_text(encoding="utf-8"), addresses()
    for pattern, made in ADDRESSES[file]:
        place = re.search(pattern, text)
        if place is None:
            raise LookupError(f"{file} has no place {pattern}")
        text = text[: place.start(1)] + made(known) + text[place.end(1) :]
    return text


def stale():
    """The files whose addresses are not those of pyproject.toml."""
    return [file for file in ADDRESSES if with_addresses(file) != (ROOT / file).read_text(encoding="utf-8")]


def write(version):
    for file, patterns in NUMBERS.items():
        path = ROOT / file
        text = path.read_text(encoding="utf-8")
        for pattern in patterns:
            new = version.replace(".", ", ") if r"\d+, " in pattern else version
            text = re.sub(pattern.replace("NUMBER", NUMBER), lambda m, new=new: m[0].replace(m[1], new), text)
        path.write_text(text, encoding="utf-8")
    for file in ADDRESSES:
        (ROOT / file).write_text(with_addresses(file), encoding="utf-8")
