"""One word, one scale and one default for each quantity, at each door: docs/vocabulary.md says which."""

import ast
import inspect
import re
from dataclasses import MISSING, fields

import holomorph
import pytest
from families import torus
from holomorph.batch.recipe import Tiles
from holomorph.maps.report import part_report, whole_report
from holomorph.tiling.request import Request
from repository import ROOT
from solved import surface_of

PAGE = ROOT / "docs" / "vocabulary.md"
TEXTS = [*(ROOT / "addon").rglob("*.py"), *(ROOT / "native" / "holomorph").rglob("*.py")]
OF_THE_METHOD = {"method", "performance"}  # pages that have formulas of their own
PAGES = [
    page
    for page in [ROOT / "README.md", *(ROOT / "docs").rglob("*.md")]
    if page != PAGE and not OF_THE_METHOD & {page.stem, page.parent.name}
]
OVERVIEW = ROOT / "native" / "holomorph" / "batch" / "overview.html"
EXEMPT = {"density_ratio"}  # `Quality.density_ratio`, for the method


def tables():
    """The rows of the two tables: {heading: cell} each."""
    found = []
    for table in re.findall(r"(?:^\|.*\n)+", PAGE.read_text(encoding="utf-8"), re.MULTILINE):
        head, _, *rows = (
            [cell.strip().strip("*") for cell in line.strip("|").split("|")] for line in table.splitlines()
        )
        found.append([dict(zip(head, row, strict=True)) for row in rows])
    return found


WORDS, DEFAULTS = tables()
NEVER = [(row["quantity"], word.strip()) for row in WORDS for word in row["never"].split(",") if word.strip()]


def strings(path):
    """What Python texts say: strings and docstrings, with a space for each value that is put in."""
    for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
        if isinstance(node, ast.JoinedStr):
            yield " ".join(part.value if isinstance(part, ast.Constant) else "" for part in node.values)
        elif isinstance(node, ast.Constant) and isinstance(node.value, str):
            yield node.value


def said():
    """(where, text) of all that is said to people."""
    for path in TEXTS:
        yield path, "\n".join(text for text in strings(path) if text not in EXEMPT)
    yield OVERVIEW, OVERVIEW.read_text(encoding="utf-8")
    for page in PAGES:
        yield page, page.read_text(encoding="utf-8")


@pytest.mark.parametrize(("quantity", "word"), NEVER, ids=str)
def test_nothing_has_a_second_name(quantity, word):
    words = r"\s+".join(map(re.escape, word.split()))
    pattern = re.compile(rf"\b{words}\b", re.IGNORECASE)
    found = [f"{path.relative_to(ROOT)}: {match[0]}" for path, text in said() for match in pattern.finditer(text)]
    assert not found, f"the word is {quantity!r}"


@pytest.mark.parametrize("row", WORDS, ids=lambda row: row["quantity"])
def test_the_doors_have_these_names(row):
    addon = {text for path in (ROOT / "addon").rglob("*.py") for text in strings(path)}
    for name in re.findall(r"`([^`]+)`", row["Python"]):
        kind, attribute = name.split(".")
        owner = getattr(holomorph, kind, None) or getattr(holomorph.distortion, kind)
        assert hasattr(owner, attribute) or attribute in {field.name for field in fields(owner)}
    if row["panel"]:
        assert row["panel"] in addon or row["panel"].title() in addon
    assert any(row["Details"] in text for text in addon)
    assert f'"{row["batch"]}"' in OVERVIEW.read_text(encoding="utf-8")


def keys(value):
    """All names in a report."""
    if isinstance(value, dict):
        return set(value) | {name for inner in value.values() for name in keys(inner)}
    return {name for inner in value for name in keys(inner)} if isinstance(value, list) else set()


def test_reports_have_these_names():
    surface = surface_of(torus(24, 12))
    made = holomorph.automatic_map(surface, main="seamless")
    parts = [part_report(made)]
    found = keys([*parts, whole_report([made], parts, surface.repairs)])
    own = {row["report"].strip("`") for row in WORDS} - {""}
    assert own <= found and not (found - own) & {word.replace(" ", "_") for _, word in NEVER}


# ---- defaults -------------------------------------------------------------------------------------------------------


def of_function(function):
    return {name: one.default for name, one in inspect.signature(function).parameters.items()}


def of_class(kind):
    """The defaults of a dataclass, of the `default_factory` too."""
    return {one.name: one.default if one.default is not MISSING else one.default_factory() for one in fields(kind)}


DOORS = {
    "Structure.tile": of_function(holomorph.ConformalStructure.tile),
    "Tiler.tile": of_function(holomorph.Tiler.tile),
    "automatic_map": of_function(holomorph.automatic_map),
    "automatic_maps": of_function(holomorph.automatic_maps),
    "batch": of_class(Tiles),
    "Request": of_class(Request),
}


@pytest.mark.parametrize("door", DOORS)
def test_all_doors_have_the_same_defaults(door):
    expected = {row["option"].strip("`"): ast.literal_eval(row["default"].split(":")[0]) for row in DEFAULTS}
    if door.endswith(".tile"):
        expected |= {"evenness": 0.0, "lines": "none"}
    found = {name: DOORS[door][name] for name in expected if name in DOORS[door]}
    assert found and found == {name: expected[name] for name in found}
