"""Differentials of the third kind: residues (exact), linearity (solver accuracy), log maps (discretisation)."""

import families
import numpy as np
import pytest
from exact_maps import log_map_errors
from forms import edge_forms
from holomorph import Cancelled, Surface, TopologyError, conformal_structure, log_map
from solved import CLOSED, surface_of
from stars import mean_angle_off_the_stars, neighbours, star_triangles, triangulation, vertex_at
from uv_jumps import corner_sides, jumps

EXACT = 1e-12
SOLVER = 1e-8
TAU = 2 * np.pi


RING = families.square_ring(5)
SPHERE = families.geodesic_sphere(7, jitter=0.25)
FLAT_QUADS = families.block_with_holes(2, refine=4, jitter=0.2)
CASES = {
    "sphere, two far apart": (SPHERE, {}),
    "sphere, three": (SPHERE, {"poles": [3, 100, 400], "residues": [1, 2, -3]}),
    "sphere, complex residues": (SPHERE, {"poles": [3, 100, 400], "residues": [1j, 2 - 1j, -2]}),
    "torus of triangles": (CLOSED["torus of triangles"], {"poles": [0, 200]}),
    "torus of quads": (CLOSED["torus of quads"], {"poles": [5, 222], "residues": [1 + 2j, -1 - 2j]}),
    "genus 2 block": (FLAT_QUADS, {"poles": [0, 600]}),
    "cube": (families.cube(), {}),
    "n-gons": (RING, {"poles": [vertex_at(RING, [2, 2, 0]), vertex_at(RING, [-3, -3, 1])]}),
}
everywhere = pytest.mark.parametrize("name", CASES)
solved_cases = {}


def solved(name):
    if name not in solved_cases:
        mesh, options = CASES[name]
        solved_cases[name] = log_map(surface_of(mesh), **options)
    return solved_cases[name]


def first(structure):
    """UVs of theta_0 alone, as complex numbers."""
    return structure.uv(np.eye(len(structure.holomorphic_forms))[0]) @ [1, 1j]


# ---- what a differential of the third kind is --------------------------------------------------------------------


@everywhere
def test_periods_around_the_poles_are_the_residues(name):
    structure = solved(name)
    assert abs(structure.residues.sum()) < EXACT
    for pole, residue in zip(structure.poles, structure.residues, strict=True):
        integrals = edge_forms(structure).integrals(structure.holomorphic_forms, [neighbours(structure, pole)])
        assert np.abs(integrals[0] - residue).max() < EXACT * abs(residue)
        assert np.abs(integrals[1:]).max(initial=0) < SOLVER


@everywhere
def test_forms_are_closed_off_the_poles_and_infinite_at_them(name):
    structure = solved(name)
    triangles, _ = triangulation(structure)
    sides = edge_forms(structure).along(structure.holomorphic_forms, triangles, np.roll(triangles, -1, axis=1))
    largest = np.nanmax(np.abs(structure.holomorphic_forms), axis=1)
    off = ~star_triangles(structure)
    assert (np.abs(sides[:, off].sum(axis=2)).max(axis=1) < EXACT * largest).all()
    infinite = np.isnan(structure.holomorphic_forms[0])
    assert (infinite == np.isin(structure.edges, structure.poles).any(axis=1)).all()
    assert not np.isnan(structure.holomorphic_forms[1:]).any()


@everywhere
def test_certificates(name):
    structure = solved(name)
    assert max(vars(structure.residuals).values()) < SOLVER
    assert structure.solver.residual < SOLVER
    assert structure.uv_solver == structure.solver
    for pole in structure.poles:
        assert str(pole) in structure.description


@everywhere
def test_steps_are_the_values_of_the_form(name):
    structure = solved(name)
    surface = structure.surface
    c = np.random.default_rng(3).normal(size=(2, len(structure.holomorphic_forms))).T @ [1, 1j]
    uv = structure.uv(c) @ [1, 1j]
    form = c @ structure.holomorphic_forms
    start, end = corner_sides(surface)
    off = ~np.isin(surface.corner_vertices[[start, end]], structure.poles).any(axis=0)
    start, end = start[off], end[off]
    step = edge_forms(structure).along(form[None], surface.corner_vertices[start], surface.corner_vertices[end])[0]
    assert np.abs(uv[end] - uv[start] - step).max() < SOLVER * np.nanmax(np.abs(form))


@everywhere
def test_jumps(name):
    """Across an edge away from the poles the UVs jump by a translation, and only at seams. On genus 0 it is an
    integer combination of the residues; elsewhere, for real residues, at least real: v is single-valued."""
    structure = solved(name)
    surface = structure.surface
    uv = first(structure)
    jump, keys = jumps(surface, np.stack([uv.real, uv.imag], axis=1))
    jump = jump @ [1, 1j]
    scale = np.abs(uv).max()
    ends = np.stack(np.divmod(keys, len(surface.vertices)), axis=1)
    off = ~np.isin(ends, structure.poles).any(axis=1)
    assert np.abs(jump[off, 0] - jump[off, 1]).max() < SOLVER * scale
    seams = structure.edges[structure.seams].astype(np.int64) @ [len(surface.vertices), 1]
    assert np.abs(jump[off & ~np.isin(keys, seams)]).max() < SOLVER * scale
    if (structure.residues.imag == 0).all():
        assert np.abs(jump[off].imag).max() < SOLVER * scale
    if surface.genus == 0 and (structure.residues.imag == 0).all():
        assert np.abs(jump[off] - np.rint(jump[off].real)).max() < SOLVER * scale


@everywhere
def test_only_at_spokes_of_poles_a_side_is_turned_against_the_other(name):
    """They end where the map is infinite: the corners there are finite ones in its place."""
    structure = solved(name)
    surface = structure.surface
    uv = first(structure)
    jump, keys = jumps(surface, np.stack([uv.real, uv.imag], axis=1))
    turned = np.abs((jump[:, 0] - jump[:, 1]) @ [1, 1j])
    ends = np.stack(np.divmod(keys, len(surface.vertices)), axis=1)
    is_spoke = np.isin(ends, structure.poles).any(axis=1)
    assert turned[~is_spoke].max() < SOLVER * np.abs(uv).max() < 1e4 * SOLVER * turned[is_spoke].max()


@everywhere
def test_seams_are_input_edges_and_all_spokes(name):
    structure = solved(name)
    surface = structure.surface
    start, end = corner_sides(surface)
    sides = np.sort(surface.corner_vertices[[start, end]], axis=0)
    input_edges = np.unique(sides[0].astype(np.int64) * len(surface.vertices) + sides[1])
    seams = structure.edges[structure.seams].astype(np.int64) @ [len(surface.vertices), 1]
    assert np.isin(seams, input_edges).all()
    spokes = np.nonzero(np.isin(structure.edges, structure.poles).any(axis=1))[0]
    assert np.isin(spokes, structure.seams).all()


@everywhere
def test_no_angle_is_distorted_in_the_stars(name):
    structure = solved(name)
    uv = structure.uv(structure.balanced_coefficients())
    assert np.isfinite(uv).all()
    quality = structure.quality(uv)
    inside = star_triangles(structure)
    assert np.abs(quality.angle[inside] - 1).max() < 1e-9
    assert not quality.flipped[inside].any()


@pytest.mark.parametrize("name", ["sphere, two far apart", "torus of triangles"])
def test_residues_are_linear(name):
    """With the residues z r the differential is z times that of r."""
    structure = solved(name)
    z = 0.3 - 1.7j
    other = log_map(structure.surface, poles=structure.poles, residues=z * structure.residues)
    difference = other.holomorphic_forms[0] - z * structure.holomorphic_forms[0]
    assert np.nanmax(np.abs(difference)) < SOLVER * np.nanmax(np.abs(other.holomorphic_forms[0]))


@pytest.mark.parametrize("mesh", [SPHERE, CLOSED["torus of triangles"]])
def test_poles_add_up(mesh):
    """Three poles are two pairs together: outside the stars, the differentials add."""
    surface = surface_of(mesh)
    all_three = log_map(surface, poles=[3, 100, 400], residues=[1, 2, -3])
    one = log_map(surface, poles=[3, 400], residues=[1, -1])
    two = log_map(surface, poles=[100, 400], residues=[2, -2])
    total = one.holomorphic_forms[0] + two.holomorphic_forms[0]
    in_a_star = np.unique(surface.triangles[star_triangles(all_three)])
    off = ~np.isin(surface.triangles, in_a_star).any(axis=1)

    def steps(structure, form):
        uv_forms = edge_forms(structure)
        triangles = surface.triangles[off]
        return uv_forms.along(form[None], triangles, np.roll(triangles, -1, axis=1))

    assert (all_three.edges == one.edges).all()
    # the classes may run through other faces: forms are compared around faces up to exact integers times residues
    difference = steps(all_three, all_three.holomorphic_forms[0]) - steps(all_three, total)
    assert np.abs(difference - np.rint(difference.real)).max() < SOLVER * np.nanmax(np.abs(total))


@pytest.mark.parametrize("name", ["sphere, three", "torus of quads"])
def test_solvers_agree_and_threads_do_not_matter(name):
    mesh, options = CASES[name]
    direct = log_map(surface_of(mesh), solver="direct", **options)
    multigrid = log_map(surface_of(mesh), solver="multigrid", threads=1, **options)
    again = log_map(surface_of(mesh), solver="multigrid", threads=3, **options)
    a, b, c = (s.holomorphic_forms for s in (direct, multigrid, again))
    assert np.nanmax(np.abs(a - b)) < 1e-7 * np.nanmax(np.abs(a))
    assert b.tobytes() == c.tobytes()


def test_coefficients_are_checked():
    with pytest.raises(ValueError, match="coefficients"):
        solved("torus of triangles").uv([1])
    with pytest.raises(ValueError, match="uv has the shape"):
        solved("torus of triangles").quality(np.zeros((3, 2)))


# ---- which poles, which residues -----------------------------------------------------------------------------


def test_two_far_apart_are_taken_by_themselves():
    """The ends of a long ellipsoid."""
    stretched = families.uniform(SPHERE.vertices * [1, 1, 3], SPHERE.corners.reshape(-1, 3))
    structure = log_map(surface_of(stretched))
    assert len(structure.poles) == 2
    heights = structure.surface.vertices[structure.poles, 2]
    assert (np.abs(heights) > 2.9).all()
    assert heights.prod() < 0
    assert (structure.residues == [1, -1]).all()
    assert "log map" in structure.description


def test_the_loneliest_of_several_takes_the_rest():
    points = SPHERE.vertices
    near = [int(np.argmax(points @ direction)) for direction in ([0, 0, 1], [0, 0.8, 0.6], [0.8, 0, 0.6])]
    far = int(np.argmin(points[:, 2]))
    structure = log_map(surface_of(SPHERE), poles=[near[0], far, *near[1:]])
    assert (structure.residues == [1, -3, 1, 1]).all()


def test_residues_are_not_sought_for_vertices_that_cannot_be_poles():
    """All vertices of a large selection: the search would take longer than anything else."""
    stages = []
    with pytest.raises(TopologyError, match="corners of one face"):
        log_map(
            surface_of(SPHERE),
            poles=np.arange(len(SPHERE.vertices)),
            progress=lambda _fraction, stage: stages.append(stage),
        )
    assert "stars" in stages
    assert "residues" not in stages


def test_the_search_for_the_loneliest_can_be_cancelled():
    with pytest.raises(Cancelled):
        log_map(surface_of(SPHERE), poles=[3, 100, 400], progress=lambda _fraction, stage: stage != "residues")


def test_isolated_vertices_keep_their_numbers():
    shifted = families.uniform(
        np.concatenate([[[9.0, 9, 9]], SPHERE.vertices]), SPHERE.corners.reshape(-1, 3) + 1, ((0, 0),)
    )
    structure = log_map(surface_of(shifted), poles=[4, 401])
    assert (structure.poles == [4, 401]).all()
    assert np.isnan(structure.sphere_map()[0]).all()
    with pytest.raises(TopologyError, match="pole 0 belongs to no face"):
        log_map(surface_of(shifted), poles=[0, 401])
    with pytest.raises(TopologyError, match="poles 4 and 4[0-9]* .*vertex|is given twice"):
        log_map(surface_of(shifted), poles=[4, 4])


def adjacent(mesh):
    return [int(v) for v in mesh.corners[:2]]


QUADS = CLOSED["torus of quads"]
REFUSED = {
    "one pole": (SPHERE, {"poles": [5]}, "5 is the only one"),
    "repeated": (SPHERE, {"poles": [5, 70, 5]}, "pole 5 is given twice"),
    "out of range": (SPHERE, {"poles": [5, 492]}, "pole 492 is not a vertex: there are 492"),
    "negative": (SPHERE, {"poles": [-1, 5]}, "pole -1 is not a vertex"),
    "no integers": (SPHERE, {"poles": [0.5, 5]}, "list of vertex indices"),
    "no list": (SPHERE, {"poles": 7}, "list of vertex indices"),
    "sum": (SPHERE, {"poles": [5, 300], "residues": [1, -2]}, "residues sum to -1;.* must sum to 0"),
    "complex sum": (SPHERE, {"poles": [5, 300], "residues": [1, -1 + 2j]}, "residues sum to 0 \\+ 2i"),
    "zero": (SPHERE, {"poles": [5, 300, 200], "residues": [1, 0, -1]}, "residue 1 is 0"),
    "infinite": (SPHERE, {"poles": [5, 300], "residues": [np.inf, -np.inf]}, "residue 0 is inf"),
    "too few": (SPHERE, {"poles": [5, 300], "residues": [1]}, "1 residues for 2 poles"),
    "residues are not numbers": (SPHERE, {"poles": [5, 300], "residues": [None, 1]}, "list of numbers"),
    "residues alone": (QUADS, {"residues": [1, -1]}, "2 residues for 0 poles"),
    "neighbours": (SPHERE, {"poles": adjacent(SPHERE)}, "corners of one face"),
    "one quad": (QUADS, {"poles": [int(QUADS.corners[0]), int(QUADS.corners[2])]}, "corners of one face"),
    "stars share a vertex": (QUADS, {"poles": [0, 36]}, "faces around the vertices 0 and 36 share vertex 18"),
    "star meets itself": (families.torus(3, 2 + 1), {"poles": [0, 4]}, "share vertex|corners of one face"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case):
    mesh, options, message = REFUSED[case]
    with pytest.raises(TopologyError, match=message) as caught:
        log_map(surface_of(mesh), **options)
    assert "\n" not in str(caught.value)


def test_a_star_that_meets_itself():
    flat = families.flat_torus(0.3 + 1.1j, 2)
    with pytest.raises(TopologyError, match="faces around vertex 0 touch each other at vertex"):
        log_map(surface_of(flat), poles=[0, 3])


def test_an_intrinsic_surface():
    structure = log_map(surface_of(families.flat_torus(0.3 + 1.1j, 12, jitter=0.2)), poles=[0, 78])
    uv = structure.uv(structure.balanced_coefficients())
    assert np.isfinite(uv).all()
    assert max(vars(structure.residuals).values()) < SOLVER


def test_poles_where_two_straight_edges_meet():
    """A vertex with two faces: its star is two triangles, with the same base."""
    ends = [vertex_at(RING, [2, 0.4, 0]), vertex_at(RING, [-3, 0.6, 1])]
    structure = log_map(surface_of(RING), poles=ends)
    quality = structure.quality(structure.uv([1, 0]))
    assert star_triangles(structure).sum() == 4
    assert np.abs(quality.angle[star_triangles(structure)] - 1).max() < 1e-6


def test_two_are_taken_on_a_surface_with_handles_too():
    """And the vertex farthest from the boundary on one with boundary."""
    made = log_map(surface_of(QUADS), poles=[], residues=[])
    assert len(made.poles) == 2 and (made.residues == [1, -1]).all() and "1 holomorphic form" in made.description
    assert len(log_map(surface_of(families.punctured_torus(32, 24))).poles) == 1


# ---- the exact log map -------------------------------------------------------------------------------------------


def test_log_map_of_a_jittered_sphere_converges():
    """Geometric means over several jitters; the finest mesh has 31362 vertices."""
    coarse, fine = (
        np.exp(np.mean([np.log(log_map_errors(n, seed)) for seed in range(count)], axis=0))
        for n, count in ((7, 8), (56, 2))
    )
    assert (np.log2(coarse / fine) / 3 >= 1.7).all(), (coarse, fine)
    assert (fine < 1e-4).all(), fine


def test_sphere_map_of_a_sphere_is_a_rotation():
    """Poles at opposite points: up to the discretisation the map is the identity, rotated about the axis."""
    mesh = families.geodesic_sphere(14, jitter=0.2)
    points = mesh.vertices
    north = int(np.argmax(points[:, 2]))
    south = int(np.argmin(points @ points[north]))
    structure = log_map(surface_of(mesh), poles=[north, south])
    image = structure.sphere_map()
    assert np.abs(np.linalg.norm(image, axis=1) - 1).max() < EXACT
    assert (image[[north, south]] == [[0, 0, 1], [0, 0, -1]]).all()
    left, _, right = np.linalg.svd(points.T @ image)
    assert np.linalg.det(left @ right) > 0
    assert np.linalg.norm(points @ (left @ right) - image, axis=1).max() < 0.03
    triangles = structure.surface.triangles
    corners = image[triangles]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    assert ((normal * corners.sum(axis=1)).sum(axis=1) > 0).all()


def test_sphere_map_needs_a_sphere_with_two_poles():
    for name in ("torus of triangles", "sphere, three"):
        with pytest.raises(TopologyError, match="map to the sphere"):
            solved(name).sphere_map()


# ---- real meshes and higher genus --------------------------------------------------------------------------------


@pytest.mark.parametrize(
    ("name", "most"),
    [("bunny_60k.obj", 1.028), ("nefertiti_70k.obj", 1.037), ("armadillo_29k.obj", 1.085), ("spot_quads.obj", 1.12)],
)
def test_log_maps_of_real_meshes(meshes, name, most):
    """Two poles far apart. With their stars cut out and the two holes made straight, angles are worse."""
    (part,) = Surface.read(meshes / name).components
    structure = log_map(part)
    mean = mean_angle_off_the_stars(structure)
    assert mean <= most
    assert max(vars(structure.residuals).values()) < SOLVER
    triangles, _ = triangulation(structure)
    used, faces = np.unique(triangles[~star_triangles(structure)], return_inverse=True)
    tube = conformal_structure(Surface(part.vertices[used], faces.reshape(-1, 3)))
    assert mean < tube.quality(tube.uv(tube.balanced_coefficients())).mean_angle


@pytest.mark.parametrize(
    ("mesh", "poles"),
    [
        (families.torus(96, 72, shape="triangles", jitter=0.2), [0, 96 * 72 // 2 + 36]),
        (families.block_with_holes(2, refine=8, jitter=0.1), [0, 3000]),
    ],
    ids=["torus", "genus 2"],
)
def test_differentials_of_the_third_kind_are_conformal(mesh, poles):
    """Without its harmonic part u would not be the conjugate of v: mean s1/s2 12 instead of 1.1."""
    structure = log_map(surface_of(mesh), poles=poles)
    assert mean_angle_off_the_stars(structure) < 1.15
