"""Where the maps of parts lie in the UV plane: apart, at one density, tilings by whole units."""

from dataclasses import replace

import numpy as np
import pytest
from families import cylinder, geodesic_sphere, torus, united
from holomorph import arrangement, automatic_maps, automatic_structure, form_map
from holomorph.maps.arrangement import Arrangement, arranged, arranged_form, on_grid, square, unit_length
from holomorph.maps.map import SCATTERED
from holomorph.quality.distortion import drawn_density
from solved import surface_of

PARTS = {
    "tilings": ((torus(16, 10, R=3.0), torus(16, 10), torus(12, 8)), "seamless"),
    "forms": ((torus(16, 10, R=3.0), torus(16, 10), cylinder(12, 6)), "balanced"),
    "both": ((torus(16, 10, R=3.0), cylinder(12, 6), geodesic_sphere(4)), ["seamless", "balanced", "balanced"]),
}
MARGIN = 0.05
SINGLE = 2.0**-23  # relative, of single precision


@pytest.fixture(scope="module", params=PARTS)
def mesh(request):
    """(surface, maps of its parts)."""
    meshes, main = PARTS[request.param]
    surface = surface_of(united(*meshes))
    return surface, automatic_maps(surface, main=main, tiles=60)


def laid(mesh, **options):
    """[(map, its UVs where they lie)]."""
    surface, maps = mesh
    uv = arranged(maps, len(surface.corner_vertices), Arrangement(margin=MARGIN, **options))
    return [(made, uv[made.surface.corner_index]) for made in maps]


def boxes(parts):
    return [(uv.min(axis=0), uv.max(axis=0)) for _, uv in parts]


def test_parts_are_apart(mesh):
    found = boxes(laid(mesh))
    for k, (low, high) in enumerate(found):
        for other_low, other_high in found[:k]:
            assert np.maximum(other_low - high, low - other_high).max() >= -SINGLE


def test_maps_are_moved_and_scaled_alone(mesh):
    """Tilings by whole units, turned by quarters; others by one factor each."""
    for quarters in range(4):
        for made, uv in laid(mesh, quarters=quarters):
            raw, lies = made.uv @ [1, 1j], uv @ [1, 1j]
            if made.tiling:
                shift = lies - raw * 1j**quarters
                assert np.abs(shift - np.round(shift[0].real) - 1j * np.round(shift[0].imag)).max() < 1e-5
                assert np.array_equal(uv, uv.astype(np.float32))
                continue
            steps = np.abs(raw - raw[0]) > 1e-3 * np.ptp(raw.real)
            factor = (lies - lies[0])[steps] / (raw - raw[0])[steps]
            assert np.abs(factor / np.median(factor.real) - 1).max() < 1e-3


def test_all_maps_have_one_median_density(mesh):
    found = [drawn_density(made.surface, uv) for made, uv in laid(mesh)]
    tilings = [made for made, _ in laid(mesh) if made.tiling]
    assert max(found) <= (1.2 if len(tilings) > 1 else 1 + 1e-5) * min(found)  # whole tiles: a tenth either way


def test_maps_of_forms_fill_the_square(mesh):
    parts = laid(mesh)
    if any(made.tiling for made, _ in parts):
        assert min(low.min() for low, _ in boxes(parts)) >= 0
        return
    for density in (1.0, 2.5):
        found = boxes(laid(mesh, density=density))
        low, high = np.min([low for low, _ in found], axis=0), np.max([high for _, high in found], axis=0)
        assert (low + high) / 2 == pytest.approx([0.5, 0.5], abs=1e-9)
        assert (high - low).max() == pytest.approx(density, rel=1e-9)
    maps = [made for made, _ in parts]
    wanted = Arrangement(margin=MARGIN)
    filled = Arrangement(margin=MARGIN, per_length=square(maps, wanted).filling)
    surface = mesh[0]
    assert np.allclose(*(arranged(maps, len(surface.corner_vertices), one) for one in (wanted, filled)), atol=1e-12)


def test_a_unit_has_the_length_that_is_told(mesh):
    """On the largest part, or in the median of the tilings."""
    parts = laid(mesh)
    told = unit_length([made for made, _ in parts], Arrangement(margin=MARGIN))
    densities = [made.density for made, _ in parts if made.tiling]
    if not densities:
        largest, uv = max(parts, key=lambda pair: arrangement.diagonal(pair[0].surface))
        densities = [drawn_density(largest.surface, uv)]
    assert told == pytest.approx(np.median(densities) ** -0.5, rel=1e-6)


def test_single_forms_lie_as_their_parts(mesh):
    surface, maps = mesh
    parts, corners = [(made.surface, made.structure) for made in maps], len(surface.corner_vertices)
    counts = [len(structure.balanced_coefficients()) for _, structure in parts]
    for form in range(max(counts) + 1):
        uv = arranged_form(parts, form, corners)
        for (part, _), count in zip(parts, counts):
            assert uv[part.corner_index].any() == (form < count)


def test_a_map_without_area_is_a_point():
    surface = surface_of(torus(10, 6))
    made = automatic_maps(surface, main="balanced")[0]
    made = replace(made, uv=0 * made.uv, quality=made.structure.quality(0 * made.uv), coefficients=np.zeros(1))
    assert np.array_equal(arranged([made], len(surface.corner_vertices)), np.full_like(made.uv, 0.5))
    assert unit_length([made]) == 0 and square([made], Arrangement()).filling == np.inf


def test_a_scattered_map_leaves_others_their_precision():
    """As where a triangle without area reaches far between others: nobody would see that it does."""
    surface = surface_of(united(geodesic_sphere(4), cylinder(12, 6)))
    whole, other = (form_map(part, automatic_structure(part)) for part in surface.components)
    uv = other.uv.copy()
    uv[0] += 1e9
    scattered = replace(other, uv=uv)
    assert scattered.cost == np.inf > other.cost
    both = square([whole, scattered])
    assert max(both.sizes[1]) <= SCATTERED * np.sqrt(other.surface.area) * (1 + SINGLE)
    assert both.sizes[0] == square([whole]).sizes[0]


def test_no_maps_give_zeros():
    assert not arranged([], 7).any() and arranged([], 7).shape == (7, 2)


@pytest.mark.parametrize("size", [0.7, 1, 13, 5000])
def test_whole_differences_survive_single_precision(size):
    rng = np.random.default_rng(1)
    base = rng.random((10_000, 2))
    whole = rng.integers(-int(size), int(size) + 1, (10_000, 2))
    both = on_grid(np.concatenate([base, base + whole]))
    assert np.array_equal(both, both.astype(np.float32))
    first, second = np.split(both, 2)
    assert np.array_equal(second - first, whole)
    assert np.abs(first - base).max() <= 2**-24 * max(2 * size + 2, 2)
