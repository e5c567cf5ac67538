"""UVs cut along edges of the caller's, in place of a cut of our own."""

import holomorph
import numpy as np
import pytest

SAME = 1e-12  # the same numbers, added in another order
AROUND, ACROSS = 12, 8


def torus(rows=AROUND, closed=True):
    """Quads of a torus of uneven thickness, or of the tube that is left without its last ring of faces; vertex
    i ACROSS + j."""
    i, j = np.meshgrid(np.arange(rows), np.arange(ACROSS), indexing="ij")
    u, v = 2 * np.pi * i / AROUND, 2 * np.pi * j / ACROSS
    r = 0.4 + 0.1 * np.sin(2 * u) + 0.05 * np.cos(v)
    vertices = np.stack([(1 + r * np.cos(v)) * np.cos(u), (1 + r * np.cos(v)) * np.sin(u), r * np.sin(v)], -1)
    i, j = (k[: rows if closed else rows - 1] for k in (i, j))
    i2, j2 = (i + 1) % rows, (j + 1) % ACROSS
    faces = np.stack([i * ACROSS + j, i2 * ACROSS + j, i2 * ACROSS + j2, i * ACROSS + j2], -1)
    return holomorph.Surface(vertices.reshape(-1, 3), faces.reshape(-1, 4))


def meridian(row=0):
    j = np.arange(ACROSS)
    return np.stack([row * ACROSS + j, row * ACROSS + (j + 1) % ACROSS], 1)


def parallel(rows=AROUND, closed=True):
    i = np.arange(rows if closed else rows - 1)
    return np.stack([i * ACROSS, (i + 1) % rows * ACROSS], 1)


def torn(structure, uv):
    """The edges across which the UVs jump, as a set of pairs of vertices."""
    surface = structure.surface
    corners, offsets = surface.corner_vertices.astype(np.int64), surface.face_offsets
    following = np.arange(1, len(corners) + 1)
    following[offsets[1:] - 1] = offsets[:-1]
    ends = np.stack([corners, corners[following]], 1)
    upwards = ends[:, 0] < ends[:, 1]
    low, high = (
        np.where(upwards, np.arange(len(corners)), following),
        np.where(upwards, following, np.arange(len(corners))),
    )
    key = ends.min(axis=1) * len(surface.vertices) + ends.max(axis=1)
    order = np.argsort(key, kind="stable")
    twice = np.flatnonzero(key[order][:-1] == key[order][1:])
    one, other = order[twice], order[twice + 1]
    jumps = np.maximum(
        np.abs(uv[low[one]] - uv[low[other]]).max(axis=1), np.abs(uv[high[one]] - uv[high[other]]).max(axis=1)
    )
    return {tuple(sorted(pair)) for pair in ends[one[jumps > SAME]].tolist()}


def pairs(edges):
    return {tuple(sorted(pair)) for pair in np.asarray(edges).tolist()}


CUTS = {
    "torus": (torus(), np.concatenate([meridian(), parallel()])),
    "tube": (torus(8, closed=False), parallel(8, closed=False)),
}


@pytest.mark.parametrize("name", ["torus", "tube"])
def test_the_map_jumps_at_the_cut_and_nowhere_else(name):
    surface, cut = CUTS[name]
    structure = holomorph.cut_along(holomorph.conformal_structure(surface), cut)
    uv = structure.uv(structure.balanced_coefficients())
    assert torn(structure, uv) == pairs(cut)
    assert pairs(structure.edges[structure.seams]) == pairs(cut)


@pytest.mark.parametrize("name", ["torus", "tube"])
def test_only_the_sheets_change(name):
    surface, cut = CUTS[name]
    ours = holomorph.conformal_structure(surface)
    cut_up = holomorph.cut_along(holomorph.conformal_structure(surface), cut)
    assert np.array_equal(ours.balanced_coefficients(), cut_up.balanced_coefficients())
    c = ours.balanced_coefficients()
    qualities = [s.quality(s.uv(c)) for s in (ours, cut_up)]
    assert np.allclose(qualities[0].angle, qualities[1].angle, rtol=1e-9)
    assert np.array_equal(ours.holomorphic_forms, cut_up.holomorphic_forms)


def test_several_pieces_are_each_continuous():
    cut = np.concatenate([meridian(0), meridian(3), parallel()])
    structure = holomorph.cut_along(holomorph.conformal_structure(torus()), cut)
    assert torn(structure, structure.uv([1])) <= pairs(cut)


def test_edges_on_the_boundary_do_not_matter():
    surface = torus(8, closed=False)
    cut = np.concatenate([meridian(0), parallel(8, closed=False)])
    structure = holomorph.cut_along(holomorph.conformal_structure(surface), cut)
    assert pairs(structure.edges[structure.seams]) == pairs(parallel(8, closed=False))


def test_the_structure_that_is_cut_stays_as_it_was():
    """The cut one has the same forms and invariants."""
    surface = torus()
    ours = holomorph.conformal_structure(surface)
    seams, uv = ours.seams.copy(), ours.uv([1])
    cut_up = holomorph.cut_along(ours, np.concatenate([meridian(3), parallel()]))
    again = holomorph.cut_along(cut_up, ours.edges[ours.seams])
    assert np.array_equal(ours.seams, seams) and np.array_equal(ours.uv([1]), uv)
    assert not np.array_equal(cut_up.seams, seams) and np.array_equal(np.sort(again.seams), np.sort(seams))
    assert cut_up.harmonic_forms.tobytes() == ours.harmonic_forms.tobytes()
    assert cut_up.period_matrix.tobytes() == ours.period_matrix.tobytes()
    assert holomorph.cut_along(ours, np.empty((0, 2), int)) is ours


def test_a_disk_needs_no_cut():
    i, j = np.meshgrid(np.arange(5), np.arange(5), indexing="ij")
    a = (5 * i + j)[:-1, :-1].ravel()
    vertices = np.stack([i, j, 0.1 * i * j], -1).reshape(-1, 3).astype(float)
    surface = holomorph.Surface(vertices, np.stack([a, a + 5, a + 6, a + 1], 1))
    structure = holomorph.cut_along(holomorph.automatic_structure(surface), [[6, 7], [7, 8]])
    assert len(structure.seams) == 0


def test_poles_keep_their_spokes_as_seams():
    surface = torus()
    poles = [2 * ACROSS + 4, 7 * ACROSS + 4]
    # From one pole to the other, and around both handles.
    i = np.arange(2, 7)
    between = np.stack([i * ACROSS + 4, (i + 1) * ACROSS + 4], 1)
    cut = np.concatenate([meridian(), parallel(), between])
    j = np.arange(4)
    joined = np.stack([2 * ACROSS + j, 2 * ACROSS + j + 1], 1)  # the slit is joined to the rest
    structure = holomorph.cut_along(holomorph.log_map(surface, poles), np.concatenate([cut, joined]))
    spokes = structure.edges[np.isin(structure.edges, poles).any(axis=1)]
    assert pairs(spokes) <= pairs(structure.edges[structure.seams])
    uv = structure.uv(structure.balanced_coefficients())
    assert torn(structure, uv) <= pairs(structure.edges[structure.seams])


@pytest.mark.parametrize(
    ("cut", "message"),
    [
        (meridian(), "does not leave disks"),
        (parallel(), "does not leave disks"),
        ([[0, 1]], "does not leave disks"),
        ([[0, 3 * ACROSS]], "between the vertices 0 and 24, which no edge"),
        ([[0, ACROSS + 1]], "between the vertices 0 and 9, which no edge"),
        ([[0, 1, 2]], "shape"),
        ([[0, 1000]], "cut vertex 1000"),
        ([[0.5, 1]], "vertex indices"),
    ],
)
def test_a_cut_that_does_not_fit_is_refused(cut, message):
    with pytest.raises(holomorph.TopologyError, match=message):
        holomorph.cut_along(holomorph.conformal_structure(torus()), cut)


def test_messages_name_the_vertices_of_the_surface():
    surface = torus()
    shifted = holomorph.Surface(
        np.vstack([np.full((100, 3), 9.0), surface.vertices]),
        (surface.corner_vertices + 100).reshape(-1, 4).astype(np.int64),
    )
    with pytest.raises(holomorph.TopologyError, match=r"vertices 1\d\d and 1\d\d, where"):
        holomorph.cut_along(holomorph.conformal_structure(shifted), meridian() + 100)


def test_a_mesh_too_coarse_for_stars_takes_no_cut():
    vertices = [[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]]
    surface = holomorph.Surface(np.array(vertices, float), [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]])
    with pytest.raises(holomorph.TopologyError, match="too coarse"):
        holomorph.cut_along(holomorph.log_map(surface), [[0, 1], [1, 2]])
