"""What the paper constructs on the way (§ 4 to § 7, Eq. 13), seen from Python."""

import families
import numpy as np
import pytest
from forms import edge_forms, edge_weights, energy_matrix, on_triangle_sides
from holomorph import InvalidMesh, ProgressiveMesh, conformal_structure
from solved import BOUNDED, BOUNDED_FLAT, CLOSED, FLAT, solved, solved_bounded, surface_of

SOLVER = 1e-9
EMBEDDED = [*((solved, name) for name in CLOSED), *((solved_bounded, name) for name in BOUNDED)]
ALL = [*EMBEDDED, *((solved, name) for name in FLAT), *((solved_bounded, name) for name in BOUNDED_FLAT)]


def over(cases):
    return pytest.mark.parametrize(("solve", "name"), cases, ids=[f"{s.__name__} {n}" for s, n in cases])


everywhere, embedded = over(ALL), over(EMBEDDED)
closed = pytest.mark.parametrize("name", [*CLOSED, *FLAT])


def sides_of_edges(structure):
    """(#E,) how many triangles have each edge."""
    return np.bincount(structure.surface._native.triangle_edges.ravel(), minlength=len(structure.edges))


# ---- the fundamental domain --------------------------------------------------------------------------------------


@everywhere
def test_the_domain_grows_by_one_triangle_at_a_time(solve, name):
    """Each once, across an edge of a triangle before it, and no edge twice: so it is a disk."""
    structure = solve(name)
    domain, count = structure.fundamental_domain, len(structure.surface.triangles)
    assert (np.sort(domain.faces) == np.arange(count)).all()
    assert domain.joined[0] == -1 and len(np.unique(domain.joined)) == count
    place = np.argsort(domain.faces)
    triangle = np.repeat(np.arange(count), 3)
    order = np.argsort(structure.surface._native.triangle_edges.ravel(), kind="stable")
    ends = np.searchsorted(structure.surface._native.triangle_edges.ravel()[order], domain.joined[1:])
    places = np.sort(place[triangle[order[np.stack([ends, ends + 1])]]], axis=0)
    assert (places[1] == np.arange(1, count)).all() and (places[0] < places[1]).all()


@everywhere
def test_boundary_of_the_domain(solve, name):
    """A closed walk with each seam in both directions and each boundary edge in one, and never there and back."""
    structure = solve(name)
    domain = structure.fundamental_domain
    (start, end), edges = domain.boundary.T, domain.boundary_edges
    assert (end == np.roll(start, -1)).all()
    assert (np.sort(domain.boundary, axis=1) == structure.edges[edges]).all()
    assert (edges != np.roll(edges, -1)).all() or len(np.unique(edges)) == 1
    times = np.bincount(edges, minlength=len(structure.edges))
    expected = (sides_of_edges(structure) == 1).astype(int)
    expected[structure.seams] = 2
    assert (times == expected).all()
    balance = np.bincount(edges, np.sign(end - start), len(structure.edges))
    assert not balance[structure.seams].any()


@embedded
def test_the_domain_lies_on_the_left(solve, name):
    structure = solve(name)
    triangles = structure.surface.triangles
    sides = np.stack([triangles, np.roll(triangles, -1, axis=1)], -1).reshape(-1, 2) @ [len(triangles), 1]
    assert np.isin(structure.fundamental_domain.boundary @ [len(triangles), 1], sides).all()


@everywhere
def test_spanning_tree(solve, name):
    """All vertices, each after the one that it hangs on, on edges that the domain does not cross."""
    structure = solve(name)
    tree, domain = structure.spanning_tree, structure.fundamental_domain
    count = int(structure.edges.max()) + 1
    assert len(tree) == count - 1 and not np.isin(tree, domain.joined).any()
    first = np.full(count, len(tree))
    np.minimum.at(first, structure.edges[tree].ravel(), np.repeat(np.arange(len(tree)), 2))
    new = first[structure.edges[tree]] == np.arange(len(tree))[:, None]
    assert new[:1].all() and (new[1:].sum(axis=1) == 1).all()
    # G is T, the generators' edges, and of each boundary loop one edge.
    loops, rest = structure.surface.boundary_count, np.concatenate([tree, domain.joined[1:], domain.generator_edges])
    assert len(np.unique(rest)) == len(rest) == len(structure.edges) - loops
    assert (sides_of_edges(structure)[np.setdiff1d(np.arange(len(structure.edges)), rest)] == 1).all()


def parents(structure):
    """(#V,) the next vertex towards the root of the spanning tree, -1 at the root."""
    result = np.full(len(structure.surface.vertices), -1)
    known = {int(v) for v in structure.edges[structure.spanning_tree[:1], :1].ravel()}
    for a, b in structure.edges[structure.spanning_tree].tolist():
        a, b = (a, b) if a in known else (b, a)
        result[b] = a
        known.add(b)
    return result


def closed_in_tree(edge, parent):
    """The edge's loop through the tree, from its first vertex."""
    paths = []
    for v in edge.tolist():
        path = [v]
        while parent[path[-1]] >= 0:
            path.append(parent[path[-1]])
        paths.append(path)
    first, second = paths
    while len(first) > 1 and len(second) > 1 and first[-2] == second[-2]:
        first, second = first[:-1], second[:-1]
    return [first[0], *second[:-1], *first[:0:-1]]


def assert_generators(structure, loops):
    parent, edges = parents(structure), structure.fundamental_domain.generator_edges
    assert len(edges) == 2 * structure.surface.genus
    for edge, loop in zip(structure.edges[edges], loops, strict=False):
        assert closed_in_tree(edge, parent) == loop.tolist()


@embedded
def test_generators_are_closed_in_the_tree(solve, name):
    structure = solve(name)
    assert_generators(structure, structure.homology_basis)


@pytest.mark.parametrize("name", ["genus 2 block", "torus knot"])
def test_generators_of_levels_come_from_the_base(name):
    mesh = ProgressiveMesh(surface_of(CLOSED[name]))
    base = mesh.conformal_structure(0)
    assert_generators(base, base.homology_basis)
    fine = mesh.conformal_structure(10**9)
    assert len(fine.fundamental_domain.generator_edges) == len(fine.homology_basis)
    for lifted, loop in zip(mesh.lift_loops(base.homology_basis, 10**9), fine.homology_basis, strict=True):
        assert (lifted == loop).all()


# ---- integer classes -----------------------------------------------------------------------------------------------


@embedded
def test_integer_classes_are_closed_and_dual_to_the_loops(solve, name):
    """Equations 1 and 2, in integers; and of the same classes as the harmonic forms."""
    structure = solve(name)
    classes, loops = structure.integer_classes, structure.homology_basis
    assert classes.shape == (len(loops), len(structure.edges)) and classes.dtype == np.int32
    assert not on_triangle_sides(structure, classes).sum(axis=2).any()
    assert (edge_forms(structure).integrals(classes, loops) == np.eye(len(loops), dtype=int)).all()


@closed
def test_wedge_products_of_integer_classes(name):
    """They are minus the inverse of the intersection numbers, |det| 1."""
    structure = solved(name)
    native, classes = structure.surface._native, structure.integer_classes
    start, end = native.triangles, np.roll(native.triangles, -1, axis=1)
    if (start == end).any():
        pytest.skip("at loops the direction of a side is not known from its ends")
    sides = classes[:, native.triangle_edges] * np.where(start < end, 1, -1)
    product = np.einsum("it,jt->ij", sides[..., 0], sides[..., 1])
    wedge = product - product.T
    assert (wedge @ structure.intersection_matrix == -2 * np.eye(len(wedge), dtype=int)).all()


@pytest.mark.parametrize("name", ["bumpy torus", "tube"])
def test_integer_classes_of_the_papers_solver(name):
    """Pulled back from the base mesh."""
    mesh = families.torus(50, 30, shape="triangles", jitter=0.25) if name == "bumpy torus" else BOUNDED[name]
    structure = conformal_structure(surface_of(mesh), solver="paper")
    classes, loops = structure.integer_classes, structure.homology_basis
    assert not on_triangle_sides(structure, classes).sum(axis=2).any()
    assert (edge_forms(structure).integrals(classes, loops) == np.eye(len(loops), dtype=int)).all()


# ---- weights and vectors -------------------------------------------------------------------------------------------


@embedded
def test_edge_weights(solve, name):
    structure = solve(name)
    expected = edge_weights(structure)
    assert np.abs(structure.edge_weights - expected).max() < 1e-9 * np.abs(expected).max()


def harmonic(structure):
    return structure.harmonic_forms if structure.surface.boundary_count == 0 else structure.natural_forms


def triangle_sides(structure):
    """(#T, 3, 3) from each corner to the next, and (#T, 3) unit normals."""
    p = structure.surface.vertices[structure.surface.triangles]
    sides = np.roll(p, -1, axis=1) - p
    normals = np.cross(sides[:, 0], sides[:, 1])
    return sides, normals


@embedded
def test_vectors_have_the_values_of_the_form(solve, name):
    """Along all sides, and in the plane of the triangle; their energy is that of Eq. 4."""
    structure = solve(name)
    form = harmonic(structure)[0]
    field = structure.vectors(form)
    sides, normals = triangle_sides(structure)
    along = on_triangle_sides(structure, form[None])[0]
    size = np.linalg.norm(field, axis=1)[:, None] * np.linalg.norm(sides, axis=2)
    assert (np.abs(np.einsum("tk,tik->ti", field, sides) - along) < 1e-9 * np.maximum(size, 1)).all()
    areas = np.linalg.norm(normals, axis=1)
    assert (np.abs((field * normals).sum(axis=1)) < 1e-9 * np.linalg.norm(field, axis=1) * areas).all()
    (energy,) = energy_matrix(structure, form[None]).ravel()
    assert abs((areas / 2) @ (field**2).sum(axis=1) - energy) < 1e-8 * energy


@embedded
def test_the_averaged_star_turns_the_vectors(solve, name):
    """By a right angle; it is the mean over the triangles at an edge, of which there is one on the boundary."""
    structure = solve(name)
    form = harmonic(structure)[-1]
    sides, normals = triangle_sides(structure)
    turned = np.cross(normals / np.linalg.norm(normals, axis=1)[:, None], structure.vectors(form))
    start, end = structure.surface.triangles, np.roll(structure.surface.triangles, -1, axis=1)
    edge, sign = edge_forms(structure).index(start, end)
    total = np.bincount(edge.ravel(), (sign * np.einsum("tk,tik->ti", turned, sides)).ravel())
    star = structure.averaged_star(form)
    assert np.abs(total / np.bincount(edge.ravel()) - star).max() < 1e-8 * np.abs(star).max()


def test_vectors_of_holomorphic_forms():
    """The imaginary part is the real one, turned, up to the error of the mesh."""
    structure = conformal_structure(surface_of(families.torus(96, 64, shape="triangles", jitter=0.1)))
    field = structure.vectors(structure.holomorphic_forms[0])
    _, normals = triangle_sides(structure)
    turned = np.cross(normals / np.linalg.norm(normals, axis=1)[:, None], field.real)
    assert np.linalg.norm(turned - field.imag) < 0.1 * np.linalg.norm(field.imag)


def test_vectors_that_cannot_be():
    structure = solved("even torus")
    with pytest.raises(ValueError, match="form has the shape"):
        structure.vectors(np.zeros(3))
    with pytest.raises(ValueError, match="form is not an array of numbers"):
        structure.vectors(["a"] * len(structure.edges))
    flat = solved("jittered flat torus")
    with pytest.raises(InvalidMesh, match="edge lengths only"):
        flat.vectors(flat.harmonic_forms[0])


def test_vectors_in_triangles_without_area_are_not_numbers():
    mesh = families.torus(8, 6, shape="triangles")
    points = mesh.vertices.copy()
    a, b, c = mesh.corners[:3]
    points[b] = (points[a] + points[c]) / 2
    structure = conformal_structure(surface_of(families.uniform(points, mesh.corners.reshape(-1, 3), mesh.topology)))
    field = structure.vectors(structure.harmonic_forms[0])
    flat = np.linalg.norm(triangle_sides(structure)[1], axis=1) < 1e-12
    assert flat.any() and np.isfinite(field[~flat]).all()


# ---- the paper's period matrix -------------------------------------------------------------------------------------


@closed
def test_paper_period_matrix(name):
    """P = 1 + i S with S^2 = -1; normalised in the canonical basis it is Omega."""
    structure = solved(name)
    P, g = structure.paper_period_matrix, len(structure.period_matrix)
    assert (P.real == np.eye(2 * g)).all()
    S = P.imag
    assert np.abs(S @ S + np.eye(2 * g)).max() < SOLVER * np.abs(S).max() ** 2
    periods = structure.canonical_basis @ P
    omega = periods[g:] @ np.linalg.pinv(periods[:g], rcond=1e-9)
    assert np.abs(omega - structure.period_matrix).max() < 1e-7 * np.abs(structure.period_matrix).max()


def test_periods_of_the_averaged_star_converge_to_it():
    """Those of the paper's star depend on the loop, by less on finer meshes."""
    errors = []
    for n in (24, 96):
        structure = conformal_structure(surface_of(families.torus(n, n // 2, shape="triangles", jitter=0.1)))
        stars = np.stack([structure.averaged_star(form) for form in structure.harmonic_forms])
        periods = edge_forms(structure).integrals(stars, structure.homology_basis).T
        errors.append(np.abs(periods - structure.paper_period_matrix.imag).max())
    assert errors[1] < errors[0] / 2 and errors[1] > 1e-6


@pytest.mark.parametrize("result", ["integer_classes", "edge_weights", "spanning_tree", "paper_period_matrix"])
def test_results_are_read_only(result):
    with pytest.raises(ValueError, match="read-only"):
        getattr(solved("even torus"), result)[...] = 0


def test_the_domain_is_a_value():
    domain = solved("even torus").fundamental_domain
    assert repr(domain).startswith("<FundamentalDomain: 864 triangles, ")
    for name in ("faces", "joined", "boundary", "boundary_edges", "generator_edges"):
        with pytest.raises(ValueError, match="read-only"):
            getattr(domain, name)[...] = 0
