"""punch_holes: one boundary loop more for each chosen vertex, and what is refused."""

import families
import numpy as np
import pytest
from holomorph import InvalidMesh, TopologyError, conformal_structure, punch_holes
from solved import BOUNDED, CLOSED, surface_of


def inner_apart(surface, count):
    """So many vertices whose polygons share none, and none with the boundary."""
    ends = surface._native.edges[np.bincount(surface._native.triangle_edges.ravel()) == 1]
    taken, chosen = np.isin(np.arange(len(surface.vertices)), ends), []
    polygons = [set(p.tolist()) for p in np.split(surface.corner_vertices, surface.face_offsets[1:-1])]
    for v in np.random.default_rng(0).permutation(len(surface.vertices)):
        star = np.array(sorted(set().union(*(p for p in polygons if v in p))))
        if len(chosen) < count and not taken[star].any():
            taken[star] = True
            chosen.append(int(v))
    return chosen


@pytest.mark.parametrize("name", [*CLOSED, *BOUNDED])
def test_topology_and_indices(name):
    surface = surface_of((CLOSED | BOUNDED)[name])
    holes = inner_apart(surface, 3)
    punched = punch_holes(surface, holes)
    assert punched.genus == surface.genus
    assert punched.boundary_count == surface.boundary_count + len(holes)
    assert (punched.vertices == surface.vertices[punched.vertex_index]).all()
    assert (punched.vertex_index[punched.corner_vertices] == surface.corner_vertices[punched.corner_index]).all()
    gone = np.setdiff1d(np.arange(len(surface.face_offsets) - 1), punched.face_index)
    face = np.repeat(np.arange(len(surface.face_offsets) - 1), np.diff(surface.face_offsets))
    assert (gone == np.unique(face[np.isin(surface.corner_vertices, holes)])).all()


def test_a_sphere_becomes_a_ring():
    sphere = surface_of(families.geodesic_sphere(8))
    ends = np.argmin(sphere.vertices[:, 2]), np.argmax(sphere.vertices[:, 2])
    assert conformal_structure(punch_holes(sphere, ends)).modulus > 0.5


def test_no_hole():
    surface = surface_of(CLOSED["even torus"])
    assert punch_holes(surface, []) is surface


def test_holes_in_a_component_name_the_mesh_as_given():
    mesh = families.united(families.torus(12, 8), families.geodesic_sphere(6))
    part = surface_of(mesh).components[1]
    punched = punch_holes(part, [3, 40])
    assert (punched.vertices == mesh.vertices[punched.vertex_index]).all()
    again = punch_holes(punched, inner_apart(punched, 1))
    assert again.boundary_count == 3 and (again.vertices == mesh.vertices[again.vertex_index]).all()


def neighbour(surface, vertex):
    edges = surface._native.edges
    return int(edges[(edges == vertex).any(axis=1)][0].sum() - vertex)


@pytest.mark.parametrize(
    ("holes", "message"),
    [
        ([0, 1, 0], "hole 0 is named twice"),
        ([-1], "hole -1 is not a vertex: there are 432"),
        ([432], "hole 432 is not a vertex: there are 432"),
        ([0.5], "holes must be a list of vertex indices"),
        ([[0]], "holes must be a list of vertex indices"),
    ],
)
def test_what_is_no_list_of_vertices(holes, message):
    with pytest.raises(TopologyError, match=message):
        punch_holes(surface_of(CLOSED["even torus"]), holes)


def test_holes_that_would_meet():
    surface = surface_of(CLOSED["even torus"])
    near = neighbour(surface, 100)
    with pytest.raises(TopologyError, match=f"holes 100 and {near} would meet"):
        punch_holes(surface, [100, near])
    edges = surface._native.edges
    ring = np.setdiff1d(edges[np.isin(edges, edges[(edges == 100).any(axis=1)]).any(axis=1)], [100])
    far = max(int(v) for v in ring if not ((edges == 100) & (edges[:, ::-1] == v)).any())
    with pytest.raises(TopologyError, match=f"holes 100 and {far} would meet"):
        punch_holes(surface, [100, far])


def test_holes_at_the_boundary():
    tube = surface_of(BOUNDED["tube"])
    on_rim = int(conformal_structure(tube).boundary_loops[0][0])
    for vertex in (on_rim, neighbour(tube, on_rim)):
        with pytest.raises(TopologyError, match=f"hole {vertex} would meet the boundary"):
            punch_holes(tube, [vertex])


def test_polygons_that_meet_behind_the_hole():
    """C-shaped ones, which close up around the tube."""
    with pytest.raises(TopologyError, match="the faces around hole 20 do not form a disk: refine the mesh there"):
        punch_holes(surface_of(CLOSED["washer of C-shaped n-gons"]), [20])


def test_one_triangle_is_left_of_a_tetrahedron():
    punched = punch_holes(surface_of(families.tetrahedron()), [0])
    assert punched.vertex_index.tolist() == [1, 2, 3] and punched.boundary_count == 1


def test_other_surfaces_are_refused():
    with pytest.raises(InvalidMesh, match="edge lengths only"):
        punch_holes(surface_of(families.flat_torus(0.3 + 1.1j, 6)), [0])
    two = surface_of(families.united(families.torus(6, 5), families.torus(6, 5)))
    with pytest.raises(TopologyError, match="2 connected components"):
        punch_holes(two, [0])
    with pytest.raises(TypeError, match="surface is of type list; a Surface is needed"):
        punch_holes([], [0])
