"""Plots by PyVista, by their pixels, and the same arguments and refusals as those by matplotlib."""

import inspect
import re
import subprocess
import sys
from pathlib import Path

import holomorph
import numpy as np
import pytest
import pyvista
from holomorph import InvalidMesh, Surface, plot, plot_pyvista
from matplotlib.colors import to_rgb
from repository import ROOT

FUNCTIONS = ("checker", "density", "forms", "zeros", "loops")
WITHOUT = "import sys; sys.modules['pyvista'] = None; sys.path.insert(0, {!r}); from holomorph import plot_pyvista"


@pytest.fixture(scope="module", autouse=True)
def off_screen():
    pyvista.OFF_SCREEN = True
    yield
    pyvista.OFF_SCREEN = False


@pytest.fixture(scope="module")
def pretzel():
    path = ROOT / "examples" / "pretzel.obj"
    return holomorph.conformal_structure(Surface.read(path))


def pixels(plotter, path=None):
    """(n, 3) colours from 0 to 1 of what is not white."""
    image = np.asarray(plotter.screenshot(path, return_img=True))[..., :3].reshape(-1, 3) / 255
    plotter.close()
    return image[image.min(axis=1) < 0.97]


def share(colours, wanted, tolerance=0.1):
    """The part of the pixels that have the hue of a colour, whatever their shade."""
    unit = [values / np.linalg.norm(values, axis=-1, keepdims=True) for values in (colours + 1e-9, np.array(wanted))]
    return np.mean(np.linalg.norm(unit[0] - unit[1], axis=-1) < tolerance)


@pytest.mark.parametrize("name", FUNCTIONS)
def test_the_functions_are_those_of_the_other_backend(name):
    ours, theirs = (inspect.signature(getattr(module, name)).parameters for module in (plot_pyvista, plot))
    assert list(ours.values()) == list(theirs.values())


def test_a_checker_has_both_colours(pretzel, pictures):
    uv = pretzel.uv(pretzel.balanced_coefficients())
    found = pixels(plot_pyvista.checker(pretzel.surface, uv, squares=40), pictures / "pyvista_checker.png")
    shares = [share(found, colour) for colour in plot_pyvista.SQUARES]
    assert min(shares) > 0.3 and sum(shares) > 0.8


def test_one_square_has_one_colour(pretzel):
    uv = np.full((len(pretzel.surface.corner_vertices), 2), 0.5)
    found = pixels(plot_pyvista.checker(pretzel.surface, uv, squares=1))
    assert share(found, plot_pyvista.SQUARES[0]) > 0.9 and share(found, plot_pyvista.SQUARES[1]) < 0.01


def test_a_dense_part_is_red_and_a_sparse_one_is_blue(pretzel, pictures):
    uv = pretzel.uv(pretzel.balanced_coefficients())
    found = pixels(plot_pyvista.density(pretzel.surface, uv), pictures / "pyvista_density.png")
    assert share(found, (0.23, 0.30, 0.75), 0.2) > 0.01


def test_each_form_has_a_picture(pretzel, pictures):
    plotter = plot_pyvista.forms(pretzel, squares=20)
    assert plotter.shape == (1, 3)
    assert share(pixels(plotter, pictures / "pyvista_forms.png"), plot_pyvista.SQUARES[1]) > 0.2


def test_zeros_are_marked(pretzel, pictures):
    found = pixels(plot_pyvista.zeros(pretzel), pictures / "pyvista_zeros.png")
    assert 1e-4 < share(found, plot_pyvista.ZERO, 0.15) < 0.1


def test_each_loop_has_a_colour(pretzel, pictures):
    found = pixels(plot_pyvista.loops(pretzel), pictures / "pyvista_loops.png")
    assert all(share(found, to_rgb(colour), 0.08) > 0 for colour in plot_pyvista.LOOPS[:6])


def test_y_may_be_upwards(pretzel):
    uv = np.zeros((len(pretzel.surface.corner_vertices), 2))
    lying, standing = (plot_pyvista.checker(pretzel.surface, uv, up=up).bounds for up in "ZY")
    assert (lying.z_min, lying.z_max) == pytest.approx((-standing.y_max, -standing.y_min))
    with pytest.raises(ValueError, match='"Y" or "Z" is needed'):
        plot_pyvista.checker(pretzel.surface, uv, up="X")


def test_the_page_s_examples_run(pretzel, tmp_path, monkeypatch):
    """In the suite core they are left out where there is no PyVista."""
    monkeypatch.chdir(tmp_path)
    pretzel.surface.write("chain.obj")
    names = dict(holomorph=holomorph, surface=pretzel.surface, uv=pretzel.uv(pretzel.balanced_coefficients()))
    page = (ROOT / "docs" / "python" / "packages.md").read_text(encoding="utf-8")
    for code in re.findall(r"^```python\n(import pyvista\n.*?)^```$", page, re.MULTILINE | re.DOTALL):
        exec(compile(code, "packages.md", "exec"), dict(names))
    forms = pyvista.read("forms.vtp").cell_data
    assert set(forms.keys()) == {f"form {number + 1}" for number in range(2 * pretzel.surface.genus)}
    assert Path("picture.png").stat().st_size > 10_000


def test_what_cannot_be_drawn_is_refused(pretzel):
    with pytest.raises(ValueError, match="uv has the shape"):
        plot_pyvista.checker(pretzel.surface, np.zeros((3, 2)))
    tetrahedron = np.array([[0, 1, 2], [0, 2, 3], [0, 3, 1], [1, 3, 2]])
    intrinsic = Surface.from_edge_lengths(tetrahedron, np.ones((4, 3)))
    with pytest.raises(InvalidMesh, match="cannot be drawn"):
        plot_pyvista.density(intrinsic, np.zeros((12, 2)))


def test_without_pyvista_there_is_a_sentence():
    program = WITHOUT.format(str(Path(holomorph.__file__).parents[1]))
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert run.returncode == 1
    last = run.stderr.splitlines()[-1]
    assert last == 'ModuleNotFoundError: these plots need the library PyVista: pip install "holomorph[pyvista]"'
