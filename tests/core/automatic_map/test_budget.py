"""The work on a map: counted alike on any number of threads, and bounded."""

import holomorph
import pytest
from families import block_with_holes, geodesic_sphere, punched, torus
from holomorph import _native
from solids import bracket, can

LITTLE, MUCH = 1e-9, 1e6
SHORT = "not all was tried"
SURFACES = {
    "sphere": lambda: geodesic_sphere(8),
    "torus": lambda: torus(24, 12),
    "handles": lambda: block_with_holes(4),
    "holes": lambda: punched(geodesic_sphere(10), 12),
}
SOLIDS = {"can": can, "bracket": bracket}


def surface_of(name):
    if name in SOLIDS:
        return SOLIDS[name]()
    mesh = SURFACES[name]()
    return holomorph.Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


def worked(compute):
    before = _native.work()
    made = compute()
    return made, _native.work() - before


@pytest.mark.parametrize("name", [*SURFACES, *SOLIDS])
def test_work_does_not_depend_on_threads(name):
    surface, counts = surface_of(name), []
    for threads in (1, 2, 3):
        _, count = worked(lambda threads=threads: holomorph.automatic_map(surface, turns=4, threads=threads))
        counts.append(count)
    assert counts[0] > 0 and counts == counts[:1] * 3


@pytest.mark.parametrize("name", [*SURFACES, *SOLIDS])
def test_with_little_work_there_is_a_map_and_it_says_so(name):
    surface = surface_of(name)
    short, little = worked(lambda: holomorph.automatic_map(surface, turns=4, effort=LITTLE))
    full, much = worked(lambda: holomorph.automatic_map(surface, turns=4, effort=MUCH))
    assert full.cost <= short.cost and little <= 1.01 * much
    assert SHORT not in full.why
    assert SHORT in short.why or short.cost == full.cost and short.kind == full.kind
    assert short.quality.lost_part < 0.02


def test_a_tiling_that_is_asked_for_is_made_whatever_it_takes():
    surface = surface_of("handles")
    assert holomorph.automatic_map(surface, main="seamless", turns=4, effort=LITTLE).tiling


@pytest.mark.parametrize("effort", [0, -1, float("nan"), float("inf"), "much", None])
def test_wrong_efforts_are_refused(effort):
    for call in (holomorph.automatic_map, holomorph.automatic_maps):
        with pytest.raises(ValueError, match="effort"):
            call(surface_of("torus"), effort=effort)
