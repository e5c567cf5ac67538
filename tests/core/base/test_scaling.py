"""What small meshes that cost much take, in operations and bytes: hardly more than in proportion to their size."""

import sys
import threading
import tracemalloc

import costly
import holomorph
import numpy as np
import pytest
from families import torus
from holomorph import Cancelled, Surface, TiledSurface, _native, automatic_map, automatic_maps, island_map
from holomorph.quality.appearance import overlapping_part
from holomorph.tiling.request import part_of
from tiled_grids import flat_square

MOST = 1.4  # exponent of growth
TIMES = 1, 2, 4, 8  # of the smallest size
FEW = 10_000  # operations: of what takes less it does not matter how it grows
MOST_CROSSINGS = 64 * 8000 * 2  # operations: 64 crossings for each edge
SILENT = 1e8  # operations between two calls of the progress function, which may cancel: about 0.1 s
PACKAGE = holomorph.__path__[0]


def calls(work):
    """How many functions of the package it calls, in all threads, but for those that wait."""
    count = [0]

    def profile(frame, event, _argument):
        name = frame.f_code.co_filename
        count[0] += event == "call" and name.startswith(PACKAGE) and not name.endswith("progress.py")

    threading.setprofile(profile)
    sys.setprofile(profile)
    try:
        work()
    finally:
        sys.setprofile(None)
        threading.setprofile(None)
    return count[0]


def operations(work):
    """What the native core counts."""
    before = _native.work()
    work()
    return _native.work() - before


def peak(work):
    """The most bytes of arrays at once."""
    tracemalloc.start()
    try:
        work()
        return tracemalloc.get_traced_memory()[1]
    finally:
        tracemalloc.stop()


def silence(work):
    """The most operations between two calls of the progress function that it gets."""
    counts = [_native.work()]

    def hear(*_progress):
        counts.append(_native.work())
        return True

    work(hear)
    counts.append(_native.work())
    return np.diff(counts).max()


def wheel():
    mesh = torus(120, 60)
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


FUNCTIONS = {
    "maps": lambda surface: automatic_maps(surface.components, threads=1),
    "copies": lambda surface: _native.copies([part_of(part) for part in surface.components], None),
    "island map": lambda surface: island_map(surface.components[0], evenness=0.5, threads=1),
}


@pytest.mark.parametrize(
    ("function", "measure", "size"),
    [
        ("maps", calls, 100),
        ("copies", operations, 100),
        ("island map", calls, 100),
        ("island map", operations, 250),
        ("island map", peak, 750),
    ],
)
@pytest.mark.parametrize("shape", costly.SHAPES)
def test_cost_grows_with_the_size(shape, function, measure, size):
    found = []
    for times in TIMES:
        surface = Surface(*costly.SHAPES[shape](times * size))
        found.append(measure(lambda surface=surface: FUNCTIONS[function](surface)))
    least = FEW if measure is operations else 0
    assert found[-1] <= max(found[0], least) * TIMES[-1] ** MOST, found


@pytest.mark.parametrize(("make", "size"), [(costly.plate, 12_800), (costly.latin, 1200)])
def test_hundreds_of_loops_cost_no_more_than_their_triangles(make, size):
    small, large = (operations(lambda n=n: automatic_map(Surface(*make(n)), threads=1)) for n in (size, 4 * size))
    assert large <= small * 4**MOST


@pytest.mark.parametrize("shape", [*costly.SHAPES, "torus"])
def test_a_search_can_be_cancelled_soon(shape):
    surface = Surface(*costly.SHAPES[shape](4000)) if shape in costly.SHAPES else wheel()
    part = surface.components[0]
    assert silence(lambda hear: automatic_map(part, turns=4, threads=1, progress=hear)) < SILENT


def test_lines_across_a_star_are_few():
    points = costly.star(8000)[0][:, :2] @ [1, 1j]
    border = np.stack([points, np.roll(points, -1)], axis=1)
    assert 0 < operations(lambda: overlapping_part(border)) < MOST_CROSSINGS


TILES = {
    "places": lambda on, n, **options: on.places((n, n), **options),
    "lines": lambda on, n, **options: on.lines("u", n * n, **options),
    "cells": lambda on, n, **options: on.cells((n, n), **options),
    "bricks": lambda on, n, **options: on.cells((n, n), True, **options),
}
find_tiles = pytest.mark.parametrize("find", TILES)


def two_triangles():
    """With 20 x 20 tiles."""
    surface, uv = flat_square((0.2, 0.3), 1)
    return TiledSurface(surface, 20 * uv, threads=1)


@find_tiles
def test_tiles_cost_as_much_as_they_are(find):
    """Also where one triangle has thousands."""
    on, found = two_triangles(), []
    for n in (6, 12, 24):
        found.append(operations(lambda n=n: TILES[find](on, n)))
    assert 0 < found[-1] <= found[0] * 16**MOST, found


@find_tiles
def test_tiles_can_be_cancelled_soon(find):
    on = two_triangles()
    assert silence(lambda hear: TILES[find](on, 24, progress=hear)) < SILENT
    with pytest.raises(Cancelled):
        TILES[find](on, 24, progress=lambda *_: False)
