"""Riemann maps of disks, and poles on surfaces with boundary: exact boundaries, discretisation errors, refusals."""

import families
import numpy as np
import pytest
from boundaries import boundary_mask
from exact_maps import riemann_map_error
from forms import edge_forms
from holomorph import (
    DiskMap,
    FreeBoundaryMap,
    PoleStructure,
    RectangleMap,
    Surface,
    TopologyError,
    automatic_structure,
    conformal_structure,
    disk_map,
    free_boundary_map,
    log_map,
    rectangle_map,
)
from plane_meshes import flat, ring
from solved import surface_of
from stars import mean_angle_off_the_stars, neighbours, vertex_at

EXACT = 1e-12
SOLVER = 1e-8
KEPT = 1e-3  # relative, by which lengths along a free boundary of few edges change for it to close


# ---- the Riemann map ---------------------------------------------------------------------------------------------


def test_the_boundary_goes_to_the_circle_and_the_centre_to_0():
    surface = surface_of(families.hemisphere(12, jitter=0.2))
    structure = disk_map(surface, 20)
    assert isinstance(structure, DiskMap)
    z = structure.disk_map()
    on_boundary = boundary_mask(surface)
    assert np.abs(np.abs(z[on_boundary]) - 1).max() < EXACT
    assert z[20] == 0
    assert (np.abs(z[~on_boundary]) < 1).all()
    uv = structure.uv([])
    assert np.abs(uv @ [1, 1j] - z[surface.corner_vertices]).max() == 0
    assert not structure.quality(uv).flipped.any()
    assert len(structure.seams) == len(structure.balanced_coefficients()) == len(structure.holomorphic_forms) == 0
    assert structure.description == "disk map, centre at vertex 20"
    assert max(vars(structure.residuals).values()) < SOLVER


def test_the_boundary_is_passed_once_counter_clockwise():
    surface = surface_of(flat(10))
    z = disk_map(surface, 0).disk_map()
    start = np.nonzero(boundary_mask(surface))[0]
    start = start[np.argsort(np.arctan2(*surface.vertices[start, 1::-1].T))]  # counter-clockwise in the plane
    turn = np.angle(np.roll(z[start], -1) / z[start])
    assert (turn > 0).all()
    assert abs(turn.sum() - 2 * np.pi) < EXACT


def test_riemann_map_of_a_jittered_hemisphere_converges():
    """Geometric means over several jitters; the finest mesh has 32137 vertices."""
    coarse, fine = (
        np.exp(np.mean([np.log(riemann_map_error(n, seed)) for seed in range(count)]))
        for n, count in ((13, 6), (103, 1))
    )
    assert np.log2(coarse / fine) / np.log2(103 / 13) >= 1.7, (coarse, fine)
    assert fine < 4e-4, fine


@pytest.mark.parametrize(
    ("name", "most"), [("face_34k_b1.obj", 1.05), ("disk_b1.obj", 1.01), ("hemisphere_b1.obj", 1.03)]
)
def test_real_disks(meshes, name, most):
    """Without a choice: the unit disk around the vertex deepest inside."""
    (part,) = Surface.read(meshes / name).components
    structure = automatic_structure(part)
    assert isinstance(structure, DiskMap)
    assert np.abs(np.abs(structure.disk_map()[boundary_mask(part)]) - 1).max() < EXACT
    assert structure.quality(structure.uv([])).mean_angle < most


# ---- without a choice --------------------------------------------------------------------------------------------


def test_a_round_disk_is_centred_deepest_inside():
    structure = automatic_structure(surface_of(flat(8, jitter=0)))
    assert isinstance(structure, DiskMap)
    assert structure.centre == 0


def test_a_patch_with_four_corners_becomes_a_rectangle():
    grid = families.grid_quads(9, 6).reshape(9, 6, 4)[:-1, :-1].reshape(-1, 4)
    i, j = np.divmod(np.arange(54), 6)
    structure = automatic_structure(Surface(np.column_stack([i, j, 0.3 * np.sin(i)]), grid))
    assert isinstance(structure, RectangleMap)
    assert sorted(structure.corners) == [0, 5, 48, 53]


@pytest.mark.parametrize("count", [12, 300])
def test_no_room_for_a_centre(count):
    """A polygon, cut into triangles without an inner vertex: it keeps its shape, where a rectangle would collapse the
    triangles along its sides."""
    angle = 2 * np.pi * np.arange(count) / count
    points = np.column_stack([np.cos(angle), np.sin(angle), 0 * angle])
    structure = automatic_structure(Surface(points, [list(range(count))]))
    assert isinstance(structure, FreeBoundaryMap)
    assert np.abs(structure.scale_factors - 1).max() < EXACT
    distances = np.linalg.norm(structure.uv([]) - structure.uv([]).mean(axis=0), axis=1)
    assert np.ptp(distances) < EXACT * distances.max()


def test_no_room_for_a_centre_and_nothing_collapses():
    """A strip of quads keeps the rectangle."""
    points = np.array([[x, y, 0] for x in range(4) for y in (0, 1.0)])
    structure = automatic_structure(Surface(points, [[2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1] for i in range(3)]))
    assert isinstance(structure, RectangleMap)


NESTED = [[3, 4, 5], [0, 1, 3], [1, 4, 3], [1, 2, 4], [2, 5, 4], [2, 0, 5], [0, 3, 5]]


@pytest.mark.parametrize(
    "faces", [[[0, 1, 2]], [[0, 1, 3], [1, 2, 3], [2, 0, 3]], NESTED], ids=["one triangle", "with a middle", "nested"]
)
def test_three_boundary_edges_without_room(faces):
    points = np.array([[0, 0, 0], [6, 0, 1], [2, 5, 0], [2.2, 1, 0.4], [3.5, 1.4, 0.3], [2.4, 2.6, 0.5]])
    structure = automatic_structure(Surface(points[: 1 + max(map(max, faces))], faces))
    assert isinstance(structure, FreeBoundaryMap)
    uv = np.empty((len(structure.surface.vertices), 2))
    uv[structure.surface.corner_vertices] = structure.uv([])
    expected, sides = (np.linalg.norm(p[[0, 1, 2]] - p[[1, 2, 0]], axis=1) for p in (points, uv))
    assert np.abs(sides - expected).max() < KEPT * expected.max()
    quality = structure.quality(structure.uv([]))
    assert not quality.flipped.any()
    assert quality.mean_angle < (1 + 1e-9 if len(faces) == 1 else 2)
    assert max(vars(structure.residuals).values()) < SOLVER


def test_a_triangle_without_positions():
    structure = automatic_structure(Surface.from_edge_lengths(np.array([[0, 1, 2]]), np.array([[3.0, 4.0, 5.0]])))
    uv = structure.uv([])
    assert np.abs(np.linalg.norm(np.roll(uv, -1, axis=0) - np.roll(uv, 1, axis=0), axis=1) - [3, 4, 5]).max() < 1e-9


def test_a_long_disk_becomes_a_log_map():
    """A tube with one end closed: a map to the disk shrinks that end like exp(-length / radius)."""
    theta, height = np.meshgrid(2 * np.pi * np.arange(12) / 12, np.arange(60) / 2)
    tube = np.stack([np.cos(theta), np.sin(theta), height], axis=2).reshape(-1, 3)
    quads = families.grid_quads(60, 12).reshape(60, 12, 4)[:-1].reshape(-1, 4)
    end = [[(k + 1) % 12, k, 60 * 12] for k in range(12)]
    surface = Surface(np.concatenate([tube, [[0, 0, -0.3]]]), [*quads.tolist(), *end])
    structure = automatic_structure(surface)
    assert isinstance(structure, PoleStructure)
    assert structure.poles.tolist() == [60 * 12]
    assert structure.description == "log map with a pole at 720"
    quality = structure.quality(structure.uv(structure.balanced_coefficients()))
    assert quality.density_ratio < 3
    assert not quality.flipped.any()


# ---- other surfaces with boundary --------------------------------------------------------------------------------

BOUNDED = {
    "disk with residues": (flat(10), {"poles": [0, 100], "residues": [1, 2]}),
    "disk, one residue": (flat(10), {"poles": [5], "residues": [1]}),
    "ring": (ring(24), {"poles": [vertex_at(ring(24), [0.75, 0, 0])]}),
    "punctured torus": (families.punctured_torus(32, 24), {"poles": [200, 500]}),
}


@pytest.mark.parametrize("name", BOUNDED)
def test_poles_on_surfaces_with_boundary(name):
    mesh, options = BOUNDED[name]
    surface = surface_of(mesh)
    structure = log_map(surface, **options)
    assert max(vars(structure.residuals).values()) < SOLVER
    forms = structure.holomorphic_forms
    for pole, residue in zip(structure.poles, structure.residues, strict=True):
        around = edge_forms(structure).integrals(forms, [neighbours(structure, pole)])[:, 0]
        assert abs(around[0] - residue) < EXACT * abs(residue)
        assert np.abs(around[1:]).max(initial=0) < EXACT * np.abs(np.nan_to_num(forms)).max()
    on_boundary = boundary_mask(surface)
    uv = structure.uv(structure.balanced_coefficients())
    assert np.abs(uv[on_boundary[surface.corner_vertices], 1]).max() == 0
    assert np.isfinite(uv).all()
    assert not structure.quality(uv).flipped.all()
    for pole in structure.poles:
        assert str(pole) in structure.description


@pytest.mark.parametrize("name", ["ring", "punctured torus"])
def test_holomorphic_forms_come_with_the_poles(name):
    """They are those of the surface without poles, on its own triangles, and mix with theta_0."""
    mesh, options = BOUNDED[name]
    surface = surface_of(mesh)
    structure, plain = log_map(surface, **options), conformal_structure(surface)
    n = len(plain.pairing)
    assert structure.holomorphic_forms.shape == (1 + n, len(structure.edges))
    assert structure.homology_basis[0].tolist() == plain.homology_basis[0].tolist()
    same = (structure.edges == plain.edges).all(axis=1)  # other diagonals are flipped away from the poles
    away = same & ~np.isin(structure.edges, structure.poles).any(axis=1)
    close = np.abs(structure.holomorphic_forms[1:, away] - plain.holomorphic_forms[:, away]).max()
    assert close < 0.02 * np.abs(plain.holomorphic_forms).max()  # it has another triangulation
    c = np.concatenate([[1.0], np.linspace(0.5, -0.7, n)])
    uv = structure.uv(c)
    mixed = structure.uv(np.eye(1 + n)[0]) + sum(c[j] * structure.uv(np.eye(1 + n)[j]) for j in range(1, 1 + n))
    at_star = np.isin(surface.corner_vertices, structure.poles)
    difference = (uv - mixed)[~at_star]
    assert np.abs(difference - difference[0]).max() < SOLVER * np.abs(uv).max()
    heights = uv[:, 1] / np.abs(uv[:, 1]).max()
    for loop in plain.boundary_loops:  # straight: one height, up to the periods where seams meet the loop
        found = np.unique(np.round(heights[np.isin(surface.corner_vertices, loop)], 9))
        assert len(found) <= 1 + 2 * (1 + n)


@pytest.mark.parametrize(
    ("mesh", "poles"), [(ring(48), [5]), (families.punctured_torus(64, 48), [800, 2000])], ids=["ring", "torus"]
)
def test_they_are_conformal(mesh, poles):
    """u is made orthogonal to the natural forms of all loops."""
    surface = surface_of(mesh)
    if len(poles) == 1:
        poles = [int(np.argmin(np.linalg.norm(surface.vertices - [0.75, 0, 0], axis=1)))]
    assert mean_angle_off_the_stars(log_map(surface, poles)) < 1.15


DISK = flat(6)
REFUSED = {
    "on the boundary": (DISK, {"poles": [126]}, "vertex 126 lies on the boundary"),
    "next to the boundary": (DISK, {"poles": [80]}, "faces around vertex 80 touch the boundary at vertex"),
    "out of range": (DISK, {"poles": [127]}, "pole 127 is not a vertex: there are 127"),
    "repeated": (DISK, {"poles": [3, 3]}, "given twice"),
    "stars": (DISK, {"poles": [0, 10]}, "share vertex|corners of one face"),
    "zero": (DISK, {"poles": [0], "residues": [0]}, "residue 0 is 0"),
}


@pytest.mark.parametrize(
    ("centre", "message"),
    [
        (126, "vertex 126 lies on the boundary"),
        (80, "faces around vertex 80 touch the boundary at vertex"),
        (127, "centre 127 is not a vertex: there are 127"),
        (0.5, "list of vertex indices"),
    ],
)
def test_centres_that_do_not_fit(centre, message):
    with pytest.raises(TopologyError, match=message):
        disk_map(surface_of(DISK), centre)


@pytest.mark.parametrize("make", [disk_map, rectangle_map, free_boundary_map])
def test_other_surfaces_have_no_map_of_a_disk(make):
    for mesh, words in ((families.cube(), "genus 0 and 0"), (ring(24), "genus 0 and 2")):
        with pytest.raises(TopologyError, match=f"{words} boundaries; a .* needs a disk"):
            make(surface_of(mesh))


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case):
    mesh, options, message = REFUSED[case]
    with pytest.raises(TopologyError, match=message) as caught:
        log_map(surface_of(mesh), **options)
    assert "\n" not in str(caught.value)


def test_coefficients_are_refused():
    structure = automatic_structure(surface_of(DISK))
    with pytest.raises(ValueError, match="coefficients"):
        structure.uv([1])


def test_a_coarse_disk_stays_in_the_unit_disk():
    """On a mesh so coarse and narrow the discrete function is negative at some inner vertices."""
    points, faces = families.hexagonal_disk(3, jitter=0.4, seed=1)
    surface = Surface(np.column_stack([points * [1, 0.15], 0 * points[:, 0]]), faces)
    assert log_map(surface, [1], [1]).uv([1])[:, 1].min() < -0.01
    assert np.abs(disk_map(surface, 1).disk_map()).max() < 1 + 1e-12
