"""Surface: construction, topology, components, triangulation, repairs."""

import counting
import families
import numpy as np
import pytest
from holomorph import InvalidMesh, Surface, TopologyError, conformal_structure
from small_families import FLAT, MESHES

ROUNDING = 1e-12  # relative: sums of a few thousand numbers of order 1

CONNECTED = [name for name in MESHES if len(MESHES[name].topology) == 1]


def surface_of(mesh):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets)


def vector_area(points):
    """Twice the vector area of one polygon."""
    return np.cross(points, np.roll(points, -1, axis=0)).sum(axis=0)


# ---- what goes in comes out ----------------------------------------------------------------------


@pytest.mark.parametrize("name", MESHES)
def test_polygons_are_kept(name):
    mesh = MESHES[name]
    surface = surface_of(mesh)
    assert (surface.vertices == mesh.vertices).all()
    assert (surface.corner_vertices == mesh.corners).all()
    assert (surface.face_offsets == mesh.offsets).all()
    assert not surface.repairs


@pytest.mark.parametrize("integers", [np.int8, np.uint8, np.int16, np.uint16, np.int32, np.uint32, np.int64, np.uint64])
def test_every_integer_type_is_taken(integers):
    mesh = families.torus(5, 4)
    surface = Surface.from_polygons(mesh.vertices, mesh.corners.astype(integers), mesh.offsets.astype(integers))
    assert (surface.corner_vertices == mesh.corners).all()
    assert (Surface(mesh.vertices, mesh.corners.reshape(-1, 4).astype(integers)).corner_vertices == mesh.corners).all()
    mixed = Surface.from_polygons(mesh.vertices, mesh.corners.astype(integers), mesh.offsets.astype(np.int32))
    assert (mixed.corner_vertices == mesh.corners).all() and (mixed.face_offsets == mesh.offsets).all()


@pytest.mark.parametrize("reals", [np.float32, np.float64, np.int32])
def test_every_real_type_is_taken(reals):
    mesh = families.block_with_holes(1)
    assert Surface(mesh.vertices.astype(reals), mesh.corners.reshape(-1, 4)).vertices.dtype == np.float64


def test_arrays_in_any_layout():
    mesh = families.torus(6, 5, shape="triangles")
    faces = mesh.corners.reshape(-1, 3)
    straight = Surface(mesh.vertices, faces)
    crooked = Surface(np.asfortranarray(mesh.vertices), np.repeat(faces, 2, axis=1)[:, ::2])
    assert (crooked.triangles == straight.triangles).all()
    assert (crooked.vertices == straight.vertices).all()


def test_list_of_lists():
    mesh = families.washer(7)
    surface = Surface(mesh.vertices.tolist(), [face.tolist() for face in mesh.faces])
    assert (surface.corner_vertices == mesh.corners).all()
    assert (surface.face_offsets == mesh.offsets).all()


def test_input_is_not_written_to():
    mesh = families.reversed_faces(families.torus(6, 5), np.arange(30) % 3 == 0)
    before = mesh.vertices.copy(), mesh.corners.copy(), mesh.offsets.copy()
    surface_of(mesh)
    for array, copy in zip((mesh.vertices, mesh.corners, mesh.offsets), before, strict=True):
        assert (array == copy).all()


@pytest.mark.parametrize(
    "array", ["vertices", "corner_vertices", "face_offsets", "triangles", "triangle_corners", "triangle_faces"]
)
def test_arrays_are_read_only(array):
    values = getattr(surface_of(families.torus(6, 5)), array)
    with pytest.raises(ValueError, match="read-only"):
        values[0] = values[1]


# ---- topology ------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", CONNECTED)
def test_genus_and_boundaries(name):
    mesh = MESHES[name]
    surface = surface_of(mesh)
    assert (surface.genus, surface.boundary_count) == counting.topology(mesh)[0]
    edges, _ = counting.undirected_edges(mesh)
    assert surface.euler_characteristic == len(mesh.vertices) - len(edges) + mesh.face_count


def test_area():
    side = np.ptp(families.cube().vertices[:, 0])
    assert surface_of(families.cube()).area == pytest.approx(6 * side**2, rel=1e-14)
    right_triangles = Surface.from_edge_lengths([[0, 1, 2], [0, 2, 1]], [[5, 4, 3], [5, 3, 4]])
    assert right_triangles.area == pytest.approx(12, rel=1e-14)


@pytest.mark.parametrize("name", MESHES)
def test_components(name):
    mesh = MESHES[name]
    parts = surface_of(mesh).components
    assert tuple((part.genus, part.boundary_count) for part in parts) == counting.topology(mesh)
    expected = counting.face_components(mesh)
    for which, part in enumerate(parts):
        assert (part.face_index == np.flatnonzero(expected == which)).all()


@pytest.mark.parametrize("name", MESHES)
def test_components_point_into_their_parent(name):
    surface = surface_of(MESHES[name])
    for part in surface.components:
        assert (surface.vertices[part.vertex_index] == part.vertices).all()
        assert (surface.corner_vertices[part.corner_index] == part.vertex_index[part.corner_vertices]).all()
        assert (np.diff(surface.face_offsets)[part.face_index] == np.diff(part.face_offsets)).all()
        assert (surface.face_offsets[part.face_index] == part.corner_index[part.face_offsets[:-1]]).all()


@pytest.mark.parametrize("name", MESHES)
def test_components_cover_everything_once(name):
    surface = surface_of(MESHES[name])
    for index, count in (("vertex_index", len(surface.vertices)), ("corner_index", len(surface.corner_vertices))):
        covered = np.concatenate([getattr(part, index) for part in surface.components])
        assert (np.sort(covered) == np.arange(count)).all()


@pytest.mark.parametrize("question", ["genus", "boundary_count", "euler_characteristic"])
def test_several_components_have_no_genus(question):
    surface = surface_of(MESHES["several"])
    with pytest.raises(TopologyError, match="4 connected components"):
        getattr(surface, question)


# ---- triangulation -------------------------------------------------------------------------------


@pytest.mark.parametrize("name", MESHES)
def test_triangles_are_made_of_their_polygon_s_corners(name):
    surface = surface_of(MESHES[name])
    corners = surface.triangle_corners
    assert (surface.corner_vertices[corners] == surface.triangles).all()
    face_of_corner = np.repeat(np.arange(len(surface.face_offsets) - 1), np.diff(surface.face_offsets))
    assert (face_of_corner[corners] == surface.triangle_faces[:, None]).all()


@pytest.mark.parametrize("name", MESHES)
def test_each_polygon_has_two_triangles_less_than_corners(name):
    surface = surface_of(MESHES[name])
    assert (np.bincount(surface.triangle_faces) == np.diff(surface.face_offsets) - 2).all()
    assert len(np.unique(surface.triangle_corners)) == len(surface.corner_vertices)


@pytest.mark.parametrize("name", MESHES)
def test_triangles_form_the_same_surface(name):
    """Manifold, oriented like the polygons, and of the same topology."""
    mesh, surface = MESHES[name], surface_of(MESHES[name])
    cut = families.uniform(surface.vertices, surface.triangles)
    start, end = counting.sides(cut)
    directed = start * len(mesh.vertices) + end
    assert len(np.unique(directed)) == len(directed)
    given_start, given_end = counting.sides(mesh)
    assert np.isin(given_start * len(mesh.vertices) + given_end, directed).all()
    assert counting.topology(cut) == mesh.topology


@pytest.mark.parametrize("name", ["ring of straight n-gons", "washer of C-shaped n-gons", "cage"])
def test_planar_polygons_are_covered_once(name):
    """The triangles of a planar polygon all lie on its side and have its area: none overlap, none leave a C."""
    surface = surface_of(MESHES[name])
    p = surface.vertices[surface.triangles]
    normal = np.cross(p[:, 1] - p[:, 0], p[:, 2] - p[:, 0])
    polygon = np.stack([vector_area(surface.vertices[face]) for face in MESHES[name].faces])
    area = np.linalg.norm(polygon, axis=1)
    along = (normal * polygon[surface.triangle_faces]).sum(axis=1) / area[surface.triangle_faces]
    assert (along > 0).all()
    assert np.abs(np.bincount(surface.triangle_faces, along) - area).max() < ROUNDING * area.max()


def test_parallelograms_are_cut_along_the_short_diagonal():
    mesh = families.block_with_holes(2)
    sheared = mesh.vertices @ np.array([[1, 0.3, 0.2], [0, 1, 0.4], [0, 0, 1]])
    surface = Surface.from_polygons(sheared, mesh.corners, mesh.offsets)
    quads = sheared[mesh.corners.reshape(-1, 4)]
    shortest = np.linalg.norm(quads[:, :2] - quads[:, 2:], axis=2).min(axis=1)
    missing = 6 - (surface.triangle_corners % 4).sum(axis=1)
    first = (missing + 1) % 2  # the diagonal joins the two corners next to the missing one
    used = np.linalg.norm(quads[surface.triangle_faces, first] - quads[surface.triangle_faces, first + 2], axis=1)
    assert np.abs(used - shortest[surface.triangle_faces]).max() < ROUNDING


# ---- repairs -------------------------------------------------------------------------------------


@pytest.mark.parametrize("name", MESHES)
def test_reversed_faces_are_found(name):
    """Where fewer than half of a component's faces are reversed, those are the ones read in reverse."""
    mesh = MESHES[name]
    which = np.random.default_rng(5).random(mesh.face_count) < 0.2
    surface = surface_of(families.reversed_faces(mesh, which))
    assert tuple((part.genus, part.boundary_count) for part in surface.components) == mesh.topology
    cut = families.uniform(surface.vertices, surface.triangles)
    start, end = counting.sides(cut)
    assert len(np.unique(start * len(mesh.vertices) + end)) == len(cut.corners)
    component = counting.face_components(mesh)
    found = np.zeros(mesh.face_count, dtype=bool)
    found[surface.repairs.reversed_faces] = True
    differs = found != which
    for part in range(component.max() + 1):
        assert len(np.unique(differs[component == part])) == 1


def test_the_majority_keeps_its_orientation():
    mesh = families.torus(12, 9, jitter=0.2)
    which = np.arange(mesh.face_count) % 5 == 0
    surface = surface_of(families.reversed_faces(mesh, which))
    assert (surface.repairs.reversed_faces == np.flatnonzero(which)).all()
    directed = [
        np.sort(np.stack([x.triangles, np.roll(x.triangles, -1, axis=1)], axis=-1).reshape(-1, 2) @ [1, 1000])
        for x in (surface, surface_of(mesh))
    ]
    assert (directed[0] == directed[1]).all()


def test_isolated_vertices_are_reported():
    mesh = families.torus(6, 5)
    points = np.insert(mesh.vertices, [0, 7], [[9.0, 9, 9], [8, 8, 8]], axis=0)
    kept = np.setdiff1d(np.arange(32), [0, 8])
    surface = Surface(points, kept[mesh.corners].reshape(-1, 4))
    assert (surface.repairs.isolated_vertices == [0, 8]).all()
    assert surface.genus == 1
    (part,) = surface.components
    assert (part.vertex_index == kept).all()


def test_zero_area_faces_are_reported_and_handled():
    """A vertex moved onto an edge of its neighbour: one triangle is flat, the surface is still a torus."""
    mesh = families.torus(12, 9, shape="triangles")
    faces = mesh.corners.reshape(-1, 3)
    points = mesh.vertices.copy()
    points[faces[0, 0]] = (points[faces[0, 1]] + points[faces[0, 2]]) / 2
    surface = Surface(points, faces)
    assert 0 in surface.repairs.zero_area_faces
    assert surface.repairs.mollification > 0
    assert surface.genus == 1
    structure = conformal_structure(surface)
    assert np.linalg.eigvalsh(structure.period_matrix.imag).min() > 0


def test_nothing_to_repair_is_false():
    assert not surface_of(families.torus(6, 5)).repairs


# ---- intrinsic surfaces --------------------------------------------------------------------------


@pytest.mark.parametrize("name", FLAT)
def test_intrinsic_surface(name):
    flat = FLAT[name]
    surface = Surface.from_edge_lengths(flat.faces, flat.edge_lengths, flat.face_edges)
    assert surface.vertices is None
    assert (surface.genus, surface.boundary_count) == (flat.genus, 0)
    assert (surface.triangles == flat.faces).all()


def test_edges_are_told_apart_by_their_ends_where_no_names_are_given():
    mesh = families.torus(7, 6, shape="triangles")
    faces = mesh.corners.reshape(-1, 3)
    p = mesh.vertices[faces]
    lengths = np.linalg.norm(np.roll(p, -2, axis=1) - np.roll(p, -1, axis=1), axis=2)
    intrinsic, embedded = Surface.from_edge_lengths(faces, lengths), Surface(mesh.vertices, faces)
    assert intrinsic.genus == 1
    difference = conformal_structure(intrinsic).period_matrix - conformal_structure(embedded).period_matrix
    assert np.abs(difference).max() < 1e-9  # solver: the same metric up to rounding


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"edge_lengths": lambda x: -x}, "face 0"),
        ({"edge_lengths": lambda x: np.where(np.arange(3) == 1, np.nan, x)}, "face 0"),
        ({"edge_lengths": lambda x: x * np.where(np.arange(len(x)) == 2, 1.5, 1)[:, None]}, "edge"),
        ({"edge_lengths": lambda x: x[:-1]}, "rows|lengths|shape"),
        ({"face_edges": lambda x: x[:-1]}, "rows"),
        ({"face_edges": lambda x: 0 * x}, "edge 0"),
        ({"faces": lambda x: x - 1}, "negative"),
        ({"faces": lambda x: x + 10**12}, "far beyond"),
        ({"faces": lambda x: x[:, :2]}, "shape"),
        ({"faces": lambda x: x.astype(float)}, "integers"),
    ],
)
def test_invalid_intrinsic_surface(change, message):
    flat = families.flat_torus(1j, 3)
    given = {"faces": flat.faces, "edge_lengths": flat.edge_lengths, "face_edges": flat.face_edges}
    given |= {name: edit(given[name]) for name, edit in change.items()}
    with pytest.raises(InvalidMesh, match=message):
        Surface.from_edge_lengths(**given)
