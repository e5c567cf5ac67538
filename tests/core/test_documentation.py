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
from solved import surface_of

ROOT = Path(__file__).resolve().parents[2]
EXAMPLE = re.compile(r"^```python\n(.*?)^```\n^```\n(.*?)^```$", re.MULTILINE | re.DOTALL)
CODE = re.compile(r"^```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
COMMAND = re.compile(r"`python -m holomorph (examples/[^`]*)`")
CORNERS = [3, 90, 214, 401]  # vertices on the boundary of a disk, in order, of docs/python.md


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


@pytest.mark.parametrize("page", ["README.md", "docs/tiling.md", "docs/howto.md", "docs/paper.md"])
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
    """The files that docs/python.md reads."""
    folder = tmp_path_factory.mktemp("files")
    surface_of(families.block_with_holes(2, 4)).write(folder / "chain.obj")
    surface_of(families.cylinder(24, 12)).write(folder / "pipe.obj")
    surface_of(families.geodesic_sphere(16)).write(folder / "spot.obj")
    disk_with_corners().write(folder / "face.obj")
    return folder


@pytest.mark.parametrize("place", range(len(CODE.findall(text_of("docs/python.md")))))
def test_example_of_the_package_runs(files, place, monkeypatch):
    """Each with what those before it have made."""
    if "plot" in CODE.findall(text_of("docs/python.md"))[place]:
        pytest.importorskip("matplotlib")
    monkeypatch.chdir(files)
    surface = holomorph.Surface.read("chain.obj")
    structure = holomorph.conformal_structure(surface)
    names = dict(holomorph=holomorph, surface=surface, structure=structure, a=structure, b=structure)
    names |= dict(uv=structure.uv(structure.balanced_coefficients()), seams=structure.edges[structure.seams])
    names |= dict(soles=np.ones(len(surface.vertices), bool), mesh=holomorph.ProgressiveMesh(surface))
    names |= dict(log_map=holomorph.log_map(holomorph.Surface.read("spot.obj")))
    printed_by(CODE.findall(text_of("docs/python.md"))[place], "docs/python.md", names)
