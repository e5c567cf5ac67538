"""Exact: integers and identities of integers."""

import counting
import numpy as np
import pytest
from equivalence import symplectic_unit
from families import Mesh, components
from forms import determinant, edge_forms
from solved import CLOSED, FLAT, RESULTS, solved

ALL = [*CLOSED, *FLAT]
everywhere = pytest.mark.parametrize("name", ALL)
embedded = pytest.mark.parametrize("name", CLOSED)


def genus_of(name):
    return (CLOSED | FLAT)[name].genus


@everywhere
def test_number_of_loops_and_forms(name):
    structure, g = solved(name), genus_of(name)
    assert len(structure.homology_basis) == 2 * g
    assert structure.harmonic_forms.shape == (2 * g, len(structure.edges))
    assert structure.holomorphic_forms.shape == (g, len(structure.edges))
    assert structure.period_matrix.shape == (g, g)


@everywhere
def test_edges_are_numbered_once_lower_vertex_first(name):
    structure = solved(name)
    assert (structure.edges[:, 0] <= structure.edges[:, 1]).all()
    assert 2 * len(structure.edges) == structure.surface.triangles.size
    if name in CLOSED:
        triangles = structure.surface.triangles
        edge, _ = edge_forms(structure).index(triangles, np.roll(triangles, -1, axis=1))
        assert (np.bincount(edge.ravel()) == 2).all()


@everywhere
def test_intersection_matrix(name):
    crossings = solved(name).intersection_matrix
    assert np.issubdtype(crossings.dtype, np.integer)
    assert (crossings == -crossings.T).all()
    assert determinant(crossings) == 1


@everywhere
def test_canonical_basis(name):
    structure, g = solved(name), genus_of(name)
    cycles = structure.canonical_basis
    assert np.issubdtype(cycles.dtype, np.integer)
    assert abs(determinant(cycles)) == 1
    assert (cycles @ structure.intersection_matrix @ cycles.T == symplectic_unit(g)).all()


@embedded
def test_loops_run_along_input_edges(name):
    structure, mesh = solved(name), CLOSED[name]
    edges, _ = counting.undirected_edges(mesh)
    keys = edges @ [len(mesh.vertices), 1]
    for loop in structure.homology_basis:
        ends = np.sort(np.stack([loop, np.roll(loop, -1)], axis=1), axis=1)
        assert np.isin(ends @ [len(mesh.vertices), 1], keys).all()


@embedded
def test_seams_run_along_input_edges(name):
    structure, mesh = solved(name), CLOSED[name]
    edges, _ = counting.undirected_edges(mesh)
    size = len(mesh.vertices)
    assert np.isin(structure.edges[structure.seams] @ [size, 1], edges @ [size, 1]).all()
    assert len(np.unique(structure.seams)) == len(structure.seams)


@embedded
def test_cut_along_the_seams_the_surface_is_a_disk(name):
    """The faces stay connected; V - E + F of what is cut open is 1; no seam ends in the middle."""
    structure = solved(name)
    surface, triangles = structure.surface, structure.surface.triangles
    following = np.roll(triangles, -1, axis=1)
    edge, _ = edge_forms(structure).index(triangles, following)
    by_edge = np.argsort(edge.ravel(), kind="stable").reshape(-1, 2)  # the two sides of each edge
    sewn = by_edge[~np.isin(np.arange(len(structure.edges)), structure.seams)]
    assert (components(len(triangles), *(sewn // 3).T) == 0).all()
    corner = np.arange(triangles.size)
    after = corner - corner % 3 + (corner + 1) % 3
    fans = components(
        triangles.size, np.concatenate([sewn[:, 0], after[sewn[:, 0]]]), np.concatenate([after[sewn[:, 1]], sewn[:, 1]])
    )
    vertices, edges = len(np.unique(fans)), len(structure.edges) + len(structure.seams)
    assert vertices - edges + len(triangles) == 1
    degree = np.bincount(structure.edges[structure.seams].ravel(), minlength=len(surface.vertices))
    assert degree[degree > 0].min() >= 2


@embedded
def test_polygons_are_not_cut(name):
    """All corners of a polygon get their UVs from one sheet: no seam is a diagonal."""
    structure, mesh = solved(name), CLOSED[name]
    edges, edge_of_corner = counting.undirected_edges(mesh)
    assert isinstance(mesh, Mesh)
    assert (np.bincount(edge_of_corner) == 2).all()
    size = len(mesh.vertices)
    diagonal = ~np.isin(structure.edges @ [size, 1], edges @ [size, 1])
    assert not diagonal[structure.seams].any()


@pytest.mark.parametrize("result", RESULTS)
def test_results_are_read_only(result):
    values = getattr(solved("torus of quads"), result)
    with pytest.raises(ValueError, match="read-only"):
        values[...] = 0


def test_loops_bounds_coefficients_and_uvs_are_read_only():
    structure = solved("torus of quads")
    coefficients = structure.balanced_coefficients()
    quality = structure.quality(structure.uv(coefficients))
    for values in (
        *structure.homology_basis,
        *structure.period_bounds,
        coefficients,
        quality.angle,
        quality.area,
        quality.flipped,
    ):
        with pytest.raises(ValueError, match="read-only"):
            values[...] = 0


def test_results_are_frozen():
    with pytest.raises(AttributeError):
        solved("torus of quads").residuals = None
