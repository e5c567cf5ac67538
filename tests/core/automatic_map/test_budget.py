"""The work on a map: counted alike on any number of threads, and bounded."""

import holomorph
import numpy as np
import pytest
from families import block_with_holes, geodesic_sphere, punched, torus
from holomorph import _native
from limbed import limbs
from shared_data import shared_folder
from solids import bracket, can

LITTLE, MUCH = 1e-9, 1e6
SHORT = "not all was tried"
SURFACES = {
    "sphere": lambda: geodesic_sphere(8),
    "torus": lambda: torus(24, 12),
    "handles": lambda: block_with_holes(4),
    "holes": lambda: punched(geodesic_sphere(10), 12),
    "limbs": limbs,
}
SOLIDS = {"can": can, "bracket": bracket}
SMALL = ["sphere", "torus", "handles", "holes", *SOLIDS]


def surface_of(name):
    if name in SOLIDS:
        return SOLIDS[name]()
    mesh = SURFACES[name]()
    return holomorph.Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


def worked(compute):
    before = _native.work()
    made = compute()
    return made, _native.work() - before


@pytest.mark.parametrize("name", SMALL)
def test_work_does_not_depend_on_threads(name):
    surface, counts = surface_of(name), []
    for threads in (1, 2, 3):
        _, count = worked(lambda threads=threads: holomorph.automatic_map(surface, turns=4, threads=threads))
        counts.append(count)
    assert counts[0] > 0 and counts == counts[:1] * 3


@pytest.mark.parametrize("name", SMALL)
def test_with_little_work_there_is_a_map_and_it_says_so(name):
    surface = surface_of(name)
    short, little = worked(lambda: holomorph.automatic_map(surface, turns=4, effort=LITTLE))
    full, much = worked(lambda: holomorph.automatic_map(surface, turns=4, effort=MUCH))
    assert full.cost <= short.cost and little <= 1.01 * much
    assert SHORT not in full.why
    assert SHORT in short.why or short.cost == full.cost and short.kind == full.kind
    assert short.quality.lost_part < 0.02


@pytest.mark.parametrize("evenness", [0.3, 0.8])
def test_what_a_dial_does_not_change_is_kept(evenness):
    """The structures and cones of pieces: a part is left of what a new map takes, and it has the same bits."""
    surface = surface_of("can")
    structure = holomorph.automatic_structure(surface)
    assert holomorph.automatic_map(surface, structure, turns=4).kind == "mixed"
    anew, much = worked(lambda: holomorph.automatic_map(surface_of("can"), turns=4, evenness=evenness))
    kept, little = worked(lambda: holomorph.automatic_map(surface, structure, turns=4, evenness=evenness))
    assert np.array_equal(anew.uv, kept.uv)
    assert little < 0.4 * much


def test_pieces_that_do_not_lead_are_looked_for_once():
    """The largest part is in pieces, so another one says the density of all; with that the same pieces are mapped."""
    mesh = torus(24, 12)
    body, ring = surface_of("limbs"), holomorph.Surface.from_polygons(0.3 * mesh.vertices, mesh.corners, mesh.offsets)
    alone = [worked(lambda part=part: holomorph.automatic_map(part, turns=4)) for part in (body, ring)]
    assert [made.kind for made, _ in alone] == ["mixed", "tiling"]
    together, work = worked(lambda: holomorph.automatic_maps([surface_of("limbs"), ring], turns=4))
    assert [made.kind for made in together] == ["mixed", "tiling"]
    assert work < 1.4 * sum(own for _, own in alone)


def test_what_is_made_of_hard_edges_gets_islands_however_much_is_round_between_them():
    """A mould, whose walls are round at their feet: its tilings cost more, and were looked for first."""
    parts = holomorph.Surface.read(shared_folder("cases") / "open" / "cad_mould.obj").components
    made = holomorph.automatic_map(max(parts, key=lambda part: part.area), turns=4)
    assert made.kind == "islands" and made.cost < 0.8 and SHORT not in made.why


def test_a_tiling_that_is_asked_for_is_made_whatever_it_takes():
    surface = surface_of("handles")
    assert holomorph.automatic_map(surface, main="seamless", turns=4, effort=LITTLE).tiling


@pytest.mark.parametrize("effort", [0, -1, float("nan"), float("inf"), "much", None])
def test_wrong_efforts_are_refused(effort):
    for call in (holomorph.automatic_map, holomorph.automatic_maps):
        with pytest.raises(ValueError, match="effort"):
            call(surface_of("torus"), effort=effort)
