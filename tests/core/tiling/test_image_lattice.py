"""Which translations leave an image as it is: families of drawn images, whose lattices are known."""

import math

import holomorph
import numpy as np
import pytest
from drawn_images import bricks, checker, cut_noise, hexagons, middles, periodic_noise

SEEDS = range(12)


def found(pixels):
    return holomorph.image_lattice(pixels)


def is_whole(vectors, lattice):
    """Whether (2, n) vectors are points of a lattice."""
    inside = np.linalg.solve(lattice, vectors)
    return np.allclose(inside, np.rint(inside), atol=1e-9)


@pytest.mark.parametrize("squares", [2, 4, 8, 32])
def test_a_checker(squares):
    made = found(checker(128, squares))
    assert made.tiles and made.cells == squares**2 // 2
    assert is_whole([[1 / squares, 2 / squares], [1 / squares, 0]], made.translations)
    assert not is_whole([[1 / squares], [0]], made.translations)


@pytest.mark.parametrize(
    ("rows", "columns", "shift", "text"),
    [
        (8, 4, 1 / 2, "Tiles; bricks, rows shifted by half, 32 cells in the image"),
        (6, 4, 1 / 3, "Tiles; rows shifted by 1/3, 24 cells in the image"),
        (8, 3, 1 / 4, "Tiles; rows shifted by 1/4, 24 cells in the image"),
        (10, 4, 3 / 10, "Tiles; rows shifted by 3/10, 40 cells in the image"),
        (6, 4, 0, "Tiles; it repeats 4 by 6 times within itself"),
        (1, 1, 0, "Tiles"),
    ],
)
@pytest.mark.parametrize("size", [(240, 240), (480, 240), (240, 360)])
def test_bricks(rows, columns, shift, text, size):
    made = found(bricks(*size, rows, columns, shift))
    assert made.text == text and made.cells == rows * columns
    step = [[1 / columns, -shift / columns], [0, 1 / rows]]
    assert is_whole(step, made.translations) and is_whole(made.translations, np.array(step))


def test_hexagons():
    single = found(hexagons(222, 128, 2, 1))
    assert single.text == "Tiles; hexagons, rows shifted by half, 2 cells in the image"
    assert np.allclose(single.lattice, [[1, 0.5], [0, math.sqrt(0.75)]], rtol=2e-3)
    assert found(hexagons(512, 512, 8, 7)).cells == 56


@pytest.mark.parametrize("size", [(64, 64), (60, 100), (200, 96)])
def test_the_lattice_is_that_of_square_pixels(size):
    """A unit is the width of an image; the first translation lies along u, and the second is upright."""
    made = found(bricks(*size, 2, 1, 0.5))
    assert np.allclose(made.lattice, np.diag([1, size[0] / size[1]]) @ made.translations)
    assert np.allclose(made.lattice, [[1, 0.5], [0, size[0] / size[1] / 2]])


@pytest.mark.parametrize("fall", [0, 0.5, 1, 1.5])
@pytest.mark.parametrize("size", [(64, 64), (100, 70), (33, 200)])
def test_periodic_noise_tiles_and_has_no_finer_lattice(fall, size):
    for seed in SEEDS:
        made = found(periodic_noise(*size, fall, seed))
        assert made.tiles and made.cells == 1 and made.text == "Tiles"
        assert np.array_equal(made.translations, np.eye(2))


@pytest.mark.parametrize("fall", [1.5, 2])
@pytest.mark.parametrize("size", [(64, 64), (100, 70), (80, 200)])
def test_what_is_cut_out_does_not_tile(fall, size):
    for seed in SEEDS:
        made = found(cut_noise(*size, fall, seed))
        assert not made.tiles and made.cells == 1 and "does not tile" in made.text.lower()


def test_which_borders_differ():
    photo = cut_noise(128, 128, 1.5, 0)
    whole = periodic_noise(128, 128, 1, 1)
    blend = np.linspace(0, 3, 128)
    assert found(photo).text == ("Does not tile: its left and right borders and its lower and upper borders differ")
    assert found(whole + blend[None, :]).text == "Does not tile: its left and right borders differ"
    assert found(whole + blend[:, None]).text == "Does not tile: its lower and upper borders differ"


def test_a_slow_change_of_light_is_seen_below_noise():
    """Across the border it is no larger than noise from pixel to pixel."""
    noise, ramp = np.random.default_rng(0).standard_normal((256, 256)), np.linspace(0, 1, 256)
    assert found(noise).tiles and not found(noise + ramp).tiles


@pytest.mark.parametrize("pixels", [np.ones((1, 1, 4)), np.full((64, 48, 3), 0.3), np.zeros((2, 2)), np.ones((1, 9))])
def test_one_colour(pixels):
    made = found(pixels)
    assert made.tiles and made.text == "Tiles: it has one colour" and made.jumps == (0, 0)


@pytest.mark.parametrize("pixels", [[[0, 1]], [[0], [1]], [[0, 1], [1, 0]], [[1, 2, 3]]])
def test_few_pixels(pixels):
    made = found(pixels)
    assert made.lattice.shape == (2, 2) and np.isfinite(made.lattice).all() and made.text


@pytest.mark.parametrize("axis", [0, 1])
def test_stripes_have_the_image_along_them(axis):
    """Any translation along them would do: none is taken that says nothing."""
    wave = np.sin(2 * np.pi * 8 * (np.arange(128) + 0.5) / 128)
    made = found(np.broadcast_to(np.expand_dims(wave, 1 - axis), (128, 128)))
    assert np.allclose(made.translations, np.diag([1, 1 / 8] if axis == 0 else [1 / 8, 1]))


def test_kinds_of_numbers_and_channels_are_alike():
    grey = bricks(128, 128, 8, 4, 0.5)
    expected = found(grey).translations
    kinds = [
        np.rint(255 * grey).astype(np.uint8),
        np.rint(65535 * grey).astype(np.uint16),
        grey.astype(np.float32),
        1e6 * grey,
        -grey,
        grey > 0.5,
        grey[..., None],
        np.dstack([grey, grey]),
        np.dstack([grey, 1 - grey, 0 * grey]),
        np.dstack([0 * grey, 0 * grey + 1, grey, 0 * grey + 1]),
    ]
    for pixels in kinds:
        assert np.array_equal(found(pixels).translations, expected)


def test_opacity_counts_and_colours_behind_it_do_not():
    grey, noise = bricks(128, 128, 8, 4, 0.5), np.random.default_rng(0).random((128, 128))
    holes = np.dstack([grey, grey, grey, grey < 0.5])
    behind = np.dstack([np.where(grey < 0.5, grey, noise)] * 3 + [grey < 0.5])
    assert np.array_equal(found(holes).translations, found(behind).translations)
    assert found(np.dstack([0 * grey] * 3 + [noise])).cells == 1
    assert found(np.dstack([noise] * 3 + [0 * grey])).text == "Tiles: it has one colour"


def test_noise_of_a_file_is_forgiven_and_tints_are_not():
    grey, chance = bricks(256, 256, 8, 4, 0.5), np.random.default_rng(0)
    noisy = np.rint(255 * grey + chance.standard_normal(grey.shape)).clip(0, 255)
    assert found(noisy).cells == 32
    y, x = middles(256, 256, 8, 4)
    brick = (np.floor(y) * 4 + np.floor(x + np.floor(y) / 2) % 4).astype(int)
    assert found(grey * (0.7 + 0.3 * chance.random(32))[brick]).cells == 1


def test_where_an_image_begins_does_not_matter():
    grey = bricks(120, 120, 6, 4, 0.5)
    for shift in ((0, 7), (11, 0), (50, 33)):
        assert np.array_equal(found(np.roll(grey, shift, (0, 1))).translations, found(grey).translations)


def test_large_images_are_reduced():
    small, large = bricks(512, 512, 8, 4, 0.5), bricks(1700, 2100, 8, 4, 0.5)
    assert np.array_equal(found(large).translations, found(small).translations)
    fine = np.indices((2048, 2048)).sum(axis=0) % 2  # is grey when it is reduced
    assert found(fine).tiles and found(fine).cells == 1


@pytest.mark.parametrize(
    "pixels", [np.zeros((0, 4)), np.zeros(3), np.zeros((2, 2, 5)), np.zeros((2, 2, 2, 2)), [["a"]], [[1j]]]
)
def test_other_shapes_are_refused(pixels):
    with pytest.raises(ValueError, match="are needed"):
        found(pixels)


@pytest.mark.parametrize("value", [math.nan, math.inf])
def test_numbers_that_are_not_finite_are_refused(value):
    with pytest.raises(ValueError, match="must be finite"):
        found([[0.0, value]])


def test_a_tiling_of_a_torus_jumps_by_the_translations_of_its_image():
    """The lattice goes straight to `Structure.tile`."""
    around = 2 * np.pi * np.arange(24) / 24
    u, v = np.meshgrid(around, around[::2], indexing="ij")
    r = 1 + 0.4 * np.cos(v)
    vertices = np.stack([r * np.cos(u), r * np.sin(u), 0.4 * np.sin(v)], -1).reshape(-1, 3)
    i, j = np.indices((24, 12))
    faces = np.stack([i * 12 + j, (i + 1) % 24 * 12 + j, (i + 1) % 24 * 12 + (j + 1) % 12, i * 12 + (j + 1) % 12], -1)
    made = found(bricks(96, 64, 4, 2, 0.5))
    tiling = holomorph.conformal_structure(holomorph.Surface(vertices, faces.reshape(-1, 4))).tile(
        tiles=40, poles=0, lattice=made.lattice
    )
    assert np.array_equal(tiling.lattice, made.lattice) and tiling.periods.dtype.kind == "i"
