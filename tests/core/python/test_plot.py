"""Plots, by their pixels."""

import io
import subprocess
import sys
from pathlib import Path

import families
import holomorph
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface
from solved import CLOSED, solved, surface_of

WITHOUT_MATPLOTLIB = "import sys; sys.modules['matplotlib'] = None; sys.path.insert(0, {!r}); import holomorph; {}"


@pytest.fixture(scope="module")
def plot():
    pytest.importorskip("matplotlib")
    return pytest.importorskip("holomorph.plot")


def pixels(picture):
    """(n, 3) colours from 0 to 1 of what is not white, as a notebook shows the picture."""
    from matplotlib.image import imread

    image = imread(io.BytesIO(picture._repr_png_()))[..., :3].reshape(-1, 3)
    return image[image.min(axis=1) < 0.99]


def share(colours, wanted, tolerance=0.06):
    """The part of the pixels that have the hue of a colour, whatever their shade."""
    unit = [
        values / np.linalg.norm(values, axis=-1, keepdims=True).clip(1e-9) for values in (colours, np.array(wanted))
    ]
    return np.mean(np.linalg.norm(unit[0] - unit[1], axis=-1) < tolerance)


def square(n=4):
    """A flat square that looks up, and its corners' positions as UVs."""
    x, y = (axis.ravel() for axis in np.meshgrid(np.arange(n + 1), np.arange(n + 1), indexing="ij"))
    points = np.stack([x, y, 0 * x], axis=1) / n
    first = (np.arange(n)[:, None] * (n + 1) + np.arange(n)).ravel()
    surface = Surface(points, first[:, None] + np.array([0, n + 1, n + 2, 1]))
    return surface, points[surface.corner_vertices, :2]


def test_a_checker_has_both_colours_in_equal_parts(plot):
    surface, uv = square()
    found = pixels(plot.checker(surface, uv, squares=8))
    shares = [share(found, colour) for colour in plot.SQUARES]
    assert sum(shares) > 0.8
    assert shares[0] == pytest.approx(shares[1], abs=0.1)
    assert share(pixels(plot.checker(surface, uv / 100, squares=8)), plot.SQUARES[1]) < 0.01  # one square alone


def test_a_dense_half_is_red_and_a_sparse_one_is_blue(plot):
    surface, uv = square()
    uneven = np.where(uv > 0.5, uv * 30, uv)
    red, blue = (0.71, 0.02, 0.15), (0.23, 0.30, 0.75)
    even, found = pixels(plot.density(surface, uv)), pixels(plot.density(surface, uneven))
    assert share(found, red, 0.2) > share(even, red, 0.2) + 0.1
    assert share(found, blue, 0.2) >= share(even, blue, 0.2)


def test_zeros_are_marked(plot):
    two, one = solved("genus 2 block"), solved("torus of quads")
    colour = plot.ZERO
    assert share(pixels(plot.zeros(two)), colour, 0.02) > 100 * share(pixels(plot.zeros(one)), colour, 0.02)
    assert share(pixels(plot.zeros(two, [1, 0])), colour, 0.02) > 0


def test_each_loop_has_a_colour(plot):
    from matplotlib.colors import to_rgb

    structure = solved("genus 2 block")
    found = pixels(plot.loops(structure))
    assert all(share(found, to_rgb(f"C{number}"), 0.02) > 0 for number in range(4))
    assert not any(share(found, to_rgb(f"C{number}"), 0.005) for number in (4, 5))


def test_each_form_has_a_checker(plot):
    structure = solved("genus 2 block")
    picture = plot.forms(structure, squares=8)
    assert [axes.get_title() for axes in picture.axes] == ["form 1", "form 2"]
    shares = [share(pixels(picture), colour) for colour in plot.SQUARES]
    assert min(shares) > 0.1


def test_y_may_be_upwards(plot):
    surface, uv = square()
    lying, standing = (pixels(plot.checker(surface, uv, up=up)) for up in "ZY")
    assert len(lying) != len(standing)
    with pytest.raises(ValueError, match='"Y" or "Z" is needed'):
        plot.checker(surface, uv, up="X")


@pytest.mark.parametrize("wrong", [np.zeros((3, 2)), np.full((64, 2), np.nan)])
def test_maps_that_do_not_fit_are_refused(plot, wrong):
    for draw in (plot.checker, plot.density):
        with pytest.raises(ValueError, match="uv has the shape"):
            draw(square()[0], wrong)


def test_a_surface_without_positions_is_refused(plot):
    double = holomorph.double_cover(surface_of(families.cylinder(8, 2)))
    with pytest.raises(InvalidMesh, match="cannot be drawn"):
        plot.checker(double, np.zeros((len(double.corner_vertices), 2)))
    with pytest.raises(InvalidMesh, match="cannot be drawn"):
        plot.loops(holomorph.conformal_structure(double))


def test_without_matplotlib_there_is_a_sentence():
    program = WITHOUT_MATPLOTLIB.format(str(Path(holomorph.__file__).parents[1]), "from holomorph import plot")
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, timeout=120)
    assert run.returncode == 1
    last = run.stderr.splitlines()[-1]
    assert last == 'ModuleNotFoundError: plots need the library matplotlib: pip install "holomorph[plot]"'


def test_the_package_alone_does_not_import_it():
    program = WITHOUT_MATPLOTLIB.format(
        str(Path(holomorph.__file__).parents[1]), "assert 'holomorph.plot' not in sys.modules"
    )
    assert subprocess.run([sys.executable, "-c", program], timeout=120).returncode == 0


def test_many_triangles_are_drawn_without_cutting(plot):
    surface = surface_of(CLOSED["torus of triangles"])
    assert plot._cuts(1).tolist() == [np.eye(3).tolist()]
    assert np.allclose(plot._cuts(5).sum(axis=2), 1) and len(plot._cuts(5)) == 25
    assert len(pixels(plot.checker(surface, np.zeros((len(surface.corner_vertices), 2)))))
