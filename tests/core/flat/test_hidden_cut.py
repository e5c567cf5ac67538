"""Parts that are cut open between their tips, where few see it, so that a tiling that turns has squares of one size."""

import families
import numpy as np
import pytest
from holomorph import _native, automatic_map
from holomorph.mesh.edges import edge_keys
from holomorph.mesh.surgery import cut_open
from limbed import limbs, open_limbs, spikes
from solved import surface_of

EXACT = 1e-12
MESHES = {
    "limbs": limbs,
    "spikes": spikes,
    "sphere": lambda: families.geodesic_sphere(9, jitter=0.2, seed=1),
    "torus": lambda: families.torus(24, 18, jitter=0.2),
    "block": lambda: families.block_with_holes(2, refine=2, jitter=0.2),
}


@pytest.fixture(scope="module", params=MESHES)
def surface(request):
    return surface_of(MESHES[request.param]())


def hidden(surface, up=None):
    """((#E,) the cut of a closed surface, how far it is seen)."""
    ((native, index, *_),), seen = _native.cut_in_hiding(surface._native, up, threads=1, progress=None)
    edges, count = native.edges, len(surface.vertices)
    border = edges[np.bincount(native.triangle_edges.ravel(), minlength=len(edges)) == 1]
    return np.isin(edge_keys(surface._native.edges, count), edge_keys(index[border], count)), seen


def test_the_cut_is_one_tree(surface):
    is_cut, _ = hidden(surface)
    ends = surface._native.edges[is_cut]
    assert len(np.unique(ends)) == len(ends) + 1
    (opened,) = cut_open(surface, is_cut).components
    assert (opened.genus, opened.boundary_count) == (surface.genus, 1)


def test_no_more_is_seen_than_there_is(surface):
    is_cut, seen = hidden(surface)
    whole = surface._native.edge_lengths[is_cut].sum() / np.sqrt(surface.area)
    assert 0 < seen <= whole * (1 + EXACT)
    assert hidden(surface, [0, 0, 1])[1] < seen  # what is looked at from above alone


@pytest.mark.parametrize("make", [limbs, spikes])
def test_the_cut_is_below_what_is_seen_from_above(make):
    surface = surface_of(make())
    middles = surface.vertices[surface._native.edges].mean(axis=1)[:, 2]
    lengths = surface._native.edge_lengths
    from_above, from_below = (np.average(middles[is_cut], weights=lengths[is_cut]) for is_cut in both_ways(surface))
    assert from_above < from_below


def both_ways(surface):
    return [hidden(surface, [0, 0, z])[0] for z in (1, -1)]


def test_limbs_are_cut_open_for_squares_of_one_size():
    surface = surface_of(limbs())
    whole = automatic_map(surface, main="seamless", turns=4)
    made = automatic_map(surface, turns=4)
    assert made.kind == "mixed" and made.why.startswith("cut open where it is hardly seen")
    assert made.quality.density_ratio < 0.9 * whole.quality.density_ratio and made.cost < whole.cost
    is_cut, seen = hidden(surface, [0, 0, 1])
    length = surface._native.edge_lengths[is_cut].sum() / np.sqrt(surface.area)
    assert (made.seen.seams, made.seen.hidden) == pytest.approx((seen, length - seen), rel=EXACT)
    # Both sides of all edges agree up to turns and whole tiles, but for those of the cut.
    breaks_off = jumps_that_no_tile_has(surface, made.uv)
    assert not breaks_off[~is_cut].any() and breaks_off[is_cut].mean() > 0.9


@pytest.mark.parametrize("count", [2, 3])
def test_limbs_that_would_fall_apart_are_not_cut(count):
    """Though the squares differ so much that a cut is looked for."""
    surface = surface_of(open_limbs(count))
    parts, _ = _native.cut_in_hiding(surface._native, [0, 0, 1], threads=1, progress=None)
    assert len(parts) > 1
    made = automatic_map(surface, turns=4)
    assert made.kind == "tiling" and made.quality.density_ratio > 2.2


def test_textures_without_turns_have_no_hidden_cut():
    assert automatic_map(surface_of(limbs()), turns=1).kind != "mixed"


def jumps_that_no_tile_has(surface, uv):
    """(#E,) edges whose sides are neither turned by quarters nor moved by whole tiles to each other."""
    native = surface._native
    at = (uv @ [1, 1j])[native.triangle_corners]
    start, end = at.ravel(), np.roll(at, -1, axis=1).ravel()
    is_left = surface.triangles.ravel() == native.edges[native.triangle_edges.ravel(), 0]
    sides = np.zeros((2, len(native.edges), 2), complex)
    edges = native.triangle_edges.ravel()
    sides[0, edges[is_left]] = np.stack([start, end], axis=1)[is_left]
    sides[1, edges[~is_left]] = np.stack([end, start], axis=1)[~is_left]
    errors = []
    for turn in (1, 1j, -1, -1j):
        jumps = sides[1] - turn * sides[0]
        off = np.abs(jumps - np.rint(jumps.real) - 1j * np.rint(jumps.imag)).max(axis=1)
        errors.append(off + np.abs(jumps[:, 1] - jumps[:, 0]))
    return np.min(errors, axis=0) > 1e-9
