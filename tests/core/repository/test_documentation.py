"""The examples of the documentation: they run, in the repository's folder, and print what the page says."""

import contextlib
import io
import re
import subprocess
import sys
from pathlib import Path

import families
import holomorph
import numpy as np
import pytest
from repository import ROOT
from solved import surface_of

EXAMPLE = re.compile(r"^```python\n(.*?)^```\n^```\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
IMPORTED = re.compile(r"^import (\w+)", re.MULTILINE)
COMMAND = re.compile(r"`python -m holomorph (examples/[^`]*)`")
LINK = re.compile(r"\]\((?!https?:)([^)#\s]*)#?([^)\s]*)\)")
HEADING = re.compile(r"^#+ (.*)$", re.MULTILINE)
CORNERS = [3, 90, 214, 401]  # vertices on the boundary of a disk, in order, of docs/python/structures.md
DOCS = ROOT / "docs"
PAGES = sorted(str(path.relative_to(ROOT)) for path in [*DOCS.rglob("*.md"), *ROOT.glob("[CR]*.md")])
OF_THE_PACKAGE = [page for page in PAGES if page.startswith("docs/python")]
PRINTING = ("tiling", "things", "relief", "howto", "paper")  # pages whose examples print something
MOST_WORDS = 1500  # on a page
MOST_BYTES = 1_000_000  # in a file
LONG = {"CHANGELOG.md"}  # is a list


def text_of(page):
    return (ROOT / page).read_text(encoding="utf-8")


def printed_by(code, page, names):
    written = io.StringIO()
    with contextlib.redirect_stdout(written):
        exec(compile(code, page, "exec"), names)
    return written.getvalue()


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with the examples of the repository."""
    (tmp_path / "examples").symlink_to(ROOT / "examples")
    monkeypatch.chdir(tmp_path)
    return tmp_path


@pytest.mark.parametrize("page", ["README.md", *(f"docs/{name}.md" for name in PRINTING)])
def test_example_prints_what_the_page_says(page, folder):
    examples = EXAMPLE.findall(text_of(page))
    assert len(examples) == len(CODE.findall(text_of(page))) > 0
    for code, printed in examples:
        assert printed_by(code, page, {}) == printed


def test_the_command_of_the_readme_runs(folder):
    (arguments,) = COMMAND.findall(text_of("README.md"))
    search = f"import sys; sys.path.insert(0, {str(Path(holomorph.__file__).parents[1])!r}); "
    program = search + "import runpy; runpy.run_module('holomorph', run_name='__main__')"
    subprocess.run(
        [sys.executable, "-c", program, *arguments.split()], timeout=300, check=True, stdout=subprocess.DEVNULL
    )
    assert (folder / "mapped.obj").stat().st_size > 0 and (folder / "report.json").stat().st_size > 0


def disk_with_corners():
    """A disk, numbered so that four vertices of its boundary have the numbers that the page takes as corners."""
    disk = families.hemisphere(14)
    x, y, z = disk.vertices.T
    rim = np.flatnonzero(z < 1e-9)
    around = rim[np.argsort(np.arctan2(y[rim], x[rim]))]
    number = np.arange(len(disk.vertices))
    corners = around[:: len(around) // 4][:4]
    number[CORNERS], number[corners] = corners, CORNERS
    return holomorph.Surface.from_polygons(disk.vertices[number], number[disk.corners], disk.offsets)


@pytest.fixture(scope="module")
def files(tmp_path_factory):
    """The files that the examples of the package read."""
    folder = tmp_path_factory.mktemp("files")
    surface_of(families.block_with_holes(2, 4)).write(folder / "chain.obj")
    surface_of(families.cylinder(24, 12)).write(folder / "pipe.obj")
    surface_of(families.geodesic_sphere(16)).write(folder / "spot.obj")
    disk_with_corners().write(folder / "face.obj")
    return folder


@pytest.mark.parametrize(
    ("page", "place"), [(page, place) for page in OF_THE_PACKAGE for place in range(len(CODE.findall(text_of(page))))]
)
def test_example_of_the_package_runs(files, page, place, monkeypatch):
    code = CODE.findall(text_of(page))[place]
    for package in IMPORTED.findall(code) + ["matplotlib"] * ("plot" in code):
        pytest.importorskip(package)
    monkeypatch.chdir(files)
    surface = holomorph.Surface.read("chain.obj")
    structure = holomorph.conformal_structure(surface)
    names = dict(holomorph=holomorph, surface=surface, structure=structure, a=structure, b=structure)
    names |= dict(uv=structure.uv(structure.balanced_coefficients()), seams=structure.edges[structure.seams])
    names |= dict(soles=np.ones(len(surface.vertices), bool), mesh=holomorph.ProgressiveMesh(surface))
    names |= dict(log_map=holomorph.log_map(holomorph.Surface.read("spot.obj")))
    printed_by(code, page, names)


def anchors_of(page):
    """As GitHub and the site name headings."""
    headings = (re.sub(r"[^\w\- ]", "", heading.lower()) for heading in HEADING.findall(page.read_text("utf-8")))
    return {heading.strip().replace(" ", "-") for heading in headings}


def leads_somewhere(page, target, anchor):
    """Pages of docs/site are beside those of docs, where the site is built."""
    folder = DOCS if page.startswith("docs/site") else (ROOT / page).parent
    places = [ROOT / page] if not target else [folder / target, DOCS / "site" / target]
    found = [place for place in places if place.exists()]
    return bool(found) and (not anchor or anchor in anchors_of(found[0]))


@pytest.mark.parametrize("page", PAGES)
def test_links_of_a_page_lead_somewhere(page):
    assert not [link for link in LINK.findall(text_of(page)) if not leads_somewhere(page, *link)]


@pytest.mark.parametrize("page", PAGES)
def test_no_link_reads_like_a_file(page):
    assert not re.findall(r"\[[^\]]*\.md\]\(", text_of(page))


def test_a_broken_link_is_found():
    assert not leads_somewhere("docs/tiling.md", "nowhere.md", "") and not leads_somewhere("docs/tiling.md", "", "no")
    assert leads_somewhere("docs/tiling.md", "method/tilings.md", "round-the-periods")
    assert leads_somewhere("README.md", "", "more")


def test_pages_can_be_read_at_once():
    words = {page: len(text_of(page).split()) for page in set(PAGES) - LONG}
    assert not {page: count for page, count in words.items() if count > MOST_WORDS}


def test_the_reference_has_every_public_name():
    """The site makes the page of docstrings from these directives. Completion shows these names alone."""
    directive = re.compile(r"^\.\. auto\w+:: holomorph\.(?:[a-z]+\.)?(\w+)", re.MULTILINE)
    listed = directive.findall(text_of("docs/site/reference.md"))
    assert set(dir(holomorph)) - {"__version__"} <= set(listed)


def test_the_page_for_artists_needs_no_mathematics():
    text = text_of("docs/artists.md")
    assert text.split("\n\n")[1].startswith("![") and not re.search(r"\bforms?\b", text)


def test_troubleshooting_quotes_what_is_said():
    files = [
        *(ROOT / "addon").rglob("*.py"),
        *ROOT.glob("native/holomorph/**/*.py"),
        *ROOT.glob("native/src/**/*.cpp"),
    ]
    said = "\n".join(path.read_text("utf-8") for path in files).lower()
    quoted = re.findall(r'"([^"]+)"', text_of("docs/troubleshooting.md"))
    assert len(quoted) > 40 and not [words for words in quoted if words.lower() not in said]


def test_every_picture_is_shown():
    text = "\n".join(map(text_of, PAGES))
    assert not [
        path.name for name in ("figures", "pictures") for path in (DOCS / name).iterdir() if path.name not in text
    ]


def test_no_file_is_heavy():
    folders = ("docs", "blend_examples", "examples", "tests", "benchmarks", "native")
    assert not [path for name in folders for path in (ROOT / name).rglob("*") if path.stat().st_size > MOST_BYTES]
