"""What small meshes that cost much take, in operations and bytes: hardly more than in proportion to their size."""

import sys
import threading
import tracemalloc

import costly
import holomorph
import numpy as np
import pytest
from families import torus
from holomorph import Surface, _native, automatic_map, automatic_maps, island_map
from holomorph.mesh.copies import copies
from holomorph.quality.overlap import overlapping_part

MOST = 1.4  # exponent of growth
MOST_BYTES = 70_000_000  # half a million crossings
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


def wheel():
    mesh = torus(120, 60)
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


FUNCTIONS = {
    "maps": lambda surface: automatic_maps(surface.components, threads=1),
    "copies": lambda surface: copies(surface.components),
    "island map": lambda surface: island_map(surface.components[0], evenness=0.5, threads=1),
}


@pytest.mark.parametrize(
    ("function", "measure", "size"),
    [
        ("maps", calls, 200),
        ("copies", calls, 200),
        ("island map", calls, 200),
        ("island map", operations, 500),
        ("island map", peak, 1500),
    ],
)
@pytest.mark.parametrize("shape", costly.SHAPES)
def test_cost_grows_with_the_size(shape, function, measure, size):
    found = []
    for times in (1, 2, 4):
        surface = Surface(*costly.SHAPES[shape](times * size))
        found.append(measure(lambda surface=surface: FUNCTIONS[function](surface)))
    assert found[2] <= found[0] * 4**MOST, found


@pytest.mark.parametrize(("make", "size"), [(costly.plate, 12_800), (costly.latin, 1200)])
def test_hundreds_of_loops_cost_no_more_than_their_triangles(make, size):
    small, large = (operations(lambda n=n: automatic_map(Surface(*make(n)), threads=1)) for n in (size, 4 * size))
    assert large <= small * 4**MOST


@pytest.mark.parametrize("shape", [*costly.SHAPES, "torus"])
def test_a_search_can_be_cancelled_soon(shape):
    surface = Surface(*costly.SHAPES[shape](4000)) if shape in costly.SHAPES else wheel()
    calls = [_native.work()]

    def hear(*_progress):
        calls.append(_native.work())
        return True

    automatic_map(surface.components[0], turns=4, threads=1, progress=hear)
    calls.append(_native.work())
    assert np.diff(calls).max() < SILENT


def test_lines_across_a_star_are_few():
    points = costly.star(8000)[0][:, :2] @ [1, 1j]
    border = np.stack([points, np.roll(points, -1)], axis=1)
    assert peak(lambda: overlapping_part(border)) < MOST_BYTES
