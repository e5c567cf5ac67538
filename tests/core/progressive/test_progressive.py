"""Progressive meshes: exact restoring, valid levels, minimal bases, files, and classes pulled back to levels."""

from functools import cache

import counting
import families
import numpy as np
import pytest
from forms import EdgeForms
from holomorph import Cancelled, Error, InvalidMesh, ProgressiveMesh, Surface, TopologyError, conformal_structure
from repository import SHARED
from solved import surface_of

ORDERS = ("quadric", "independent")
MESHES = {
    "cube": families.cube(),
    "tetrahedron": families.tetrahedron(),
    "torus of triangles": families.torus(24, 18, shape="triangles", jitter=0.3),
    "torus of quads": families.torus(16, 12, jitter=0.2),
    "thin torus": families.torus(40, 8, R=1.0, r=0.02, shape="triangles"),
    "torus knot": families.torus_knot(200, 10),
    "genus 2 block": families.block_with_holes(2, refine=3, jitter=0.25),
    "genus 8 block": families.block_with_holes(8),
    "cage": families.cage(),
    "ring of straight n-gons": families.square_ring(5),
    "washer of C-shaped n-gons": families.washer(20),
    "partly reversed": families.partly_reversed(families.block_with_holes(2, refine=2)),
    "slivers": families.torus(60, 5, R=1.0, r=0.9, shape="alternating", jitter=0.4),
    "cylinder": families.cylinder(24, 12),
    "punctured torus": families.punctured_torus(),
    "two components": families.united(families.torus(10, 8, shape="triangles"), families.cube()),
    "relabelled": families.relabelled(families.torus(20, 15, shape="triangles", jitter=0.3))[0],
}
REAL = (
    "spot_quads.obj",
    "hand_lowres_b1.obj",
    "kitten_19k.obj",
    "double-torus.obj",
    "rockerArm_ngon.obj",
    "plane_b27.obj",
    "tray_g23.stl",
    "torus_stein.obj",
    "featuretype_unwelded.ply",
    "suzanne_blender.obj",
)
FERTILITY = "fertility_ngon_g4.obj"
TORI = ("torus of triangles", "torus of quads", "thin torus", "torus knot", "slivers", "relabelled")


@cache
def surface(name):
    return surface_of(MESHES[name]) if name in MESHES else Surface.read(SHARED / "meshes" / name)


def assert_same_arrays(one, two):
    one, two = one.__getstate__(), two.__getstate__()
    assert one.keys() == two.keys()
    for name, array in one.items():
        assert (array.dtype, array.shape, array.tobytes()) == (two[name].dtype, two[name].shape, two[name].tobytes())


def corner_data(surface):
    return np.random.default_rng(7).normal(size=(len(surface.corner_vertices), 2)).astype(np.float32)


@cache
def progressive(name, order):
    return ProgressiveMesh(surface(name), corner_data=corner_data(surface(name)), order=order)


def levels(mesh, count=7):
    """Numbers of triangles from the base to the original."""
    low, high = len(mesh.base.triangles), len(mesh.level(2**31).triangles)
    return sorted(set(np.geomspace(low, high, count).astype(int).tolist()))


def as_mesh(surface):
    return families.Mesh(surface.vertices, surface.corner_vertices, surface.face_offsets)


def assert_same_bits(surface, other):
    assert surface.vertices.tobytes() == other.vertices.tobytes()
    assert surface.corner_vertices.tolist() == other.corner_vertices.tolist()
    assert surface.face_offsets.tolist() == other.face_offsets.tolist()


def available(name):
    if name not in MESHES and not (SHARED / "meshes" / name).is_file():
        pytest.skip(f"no ../shared/meshes/{name}")
    return name


everything = pytest.mark.parametrize("name", [*MESHES, *REAL])
in_both_orders = pytest.mark.parametrize("order", ORDERS)


# ---- exact: what the splits rebuild ----------------------------------------------------------------------------------


@everything
@in_both_orders
def test_restores_the_original_bit_for_bit(name, order):
    mesh = progressive(available(name), order)
    assert_same_bits(mesh.restore(), surface(name))
    assert mesh.corner_data.tobytes() == corner_data(surface(name)).tobytes()


@everything
@in_both_orders
def test_levels_are_manifolds_of_the_same_topology(name, order):
    """Surface refuses what is not a manifold; genus and boundaries are counted again, independently."""
    mesh = progressive(available(name), order)
    expected = sorted(counting.topology(as_mesh(surface(name))))
    for n_faces in levels(mesh):
        level = mesh.level(n_faces)
        assert sorted(counting.topology(as_mesh(level))) == expected
        assert not len(level.repairs.reversed_faces)
        assert not len(level.repairs.isolated_vertices)


@everything
@in_both_orders
def test_elements_of_levels_come_from_the_original(name, order):
    mesh, original = progressive(available(name), order), surface(name)
    for n_faces in levels(mesh, 3):
        level = mesh.level(n_faces)
        assert level.vertices.tobytes() == original.vertices[level.vertex_index].tobytes()
        face_of_corner = np.repeat(np.arange(len(original.face_offsets) - 1), np.diff(original.face_offsets))
        assert (face_of_corner[level.corner_index].reshape(-1, 3) == level.face_index[:, None]).all()
    finest = mesh.level(2**31)
    assert (finest.vertex_index[finest.corner_vertices] == original.corner_vertices[finest.corner_index]).all()


@everything
@in_both_orders
def test_a_level_has_at_most_the_triangles_asked_for(name, order):
    mesh = progressive(available(name), order)
    for n_faces in levels(mesh):
        count = len(mesh.level(n_faces).triangles)
        assert n_faces - 1 <= count <= n_faces
    assert len(mesh.level(0).triangles) == len(mesh.base.triangles)


def test_splits_say_how_a_level_is_made_of_the_one_before():
    for name in ("torus of triangles", "cylinder", "torus of quads"):
        mesh = progressive(name, "quadric")
        splits, first = mesh.splits, len(mesh.base.vertices)
        assert (splits["v_t"] == first + np.arange(len(splits))).all()
        for k in (0, len(splits) // 2, len(splits) - 1):
            before, after = mesh._level(k), mesh._level(k + 1)
            split = splits[k]
            left, right = int(split["v_l"] >= 0), int(split["v_r"] >= 0)
            new = after.triangles[len(before.triangles) :]
            assert len(new) == left + right
            if left:
                slot = split["slots"][0]
                assert np.roll(new[0], -int(slot)).tolist() == [split["v_s"], split["v_t"], split["v_l"]]
                assert (surface(name).corner_vertices[split["corners"][0]] >= 0).all()
            if right:
                slot = split["slots"][1]
                assert np.roll(new[-1], -int(slot)).tolist() == [split["v_t"], split["v_s"], split["v_r"]]
            old = after.triangles[: len(before.triangles)]
            assert np.where(old == split["v_t"], split["v_s"], old).tolist() == before.triangles.tolist()
            assert after.vertices[-1].tolist() == split["position"].tolist()
            assert after.vertex_index[-1] == split["vertex"]
        assert (splits["v_l"] < 0).any() == (name == "cylinder")


# ---- minimal bases ---------------------------------------------------------------------------------------------------


@in_both_orders
@pytest.mark.parametrize("name", ["cube", "tetrahedron", "spot_quads.obj"])
def test_a_sphere_ends_as_a_tetrahedron(name, order):
    assert len(progressive(available(name), order).base.triangles) == 4


@in_both_orders
@pytest.mark.parametrize("name", [*TORI, "kitten_19k.obj", "rockerArm_ngon.obj"])
def test_a_torus_ends_with_at_most_twenty_triangles(name, order):
    assert 14 <= len(progressive(available(name), order).base.triangles) <= 20


@in_both_orders
def test_a_disk_ends_as_one_triangle(order):
    assert len(progressive(available("hand_lowres_b1.obj"), order).base.triangles) == 1


def neighbours_of(sides, boundary):
    """The vertices next to each vertex, -1 among those of the boundary."""
    neighbours = {v: {-1} for v in boundary}
    for a, b in sides:
        neighbours.setdefault(a, set()).add(b)
        neighbours.setdefault(b, set()).add(a)
    return neighbours


@everything
@in_both_orders
def test_no_edge_of_the_base_can_be_collapsed(name, order):
    """The link condition, counted on lists: an edge can be collapsed if its ends have no common neighbours but those
    opposite to it, it does not cross the surface from boundary to boundary, and it is not in a tetrahedron or triangle
    of its own. Boundary vertices move along the boundary only."""
    base = progressive(available(name), order).base
    triangles = [tuple(t) for t in base.triangles.tolist()]
    sides = {(t[i], t[(i + 1) % 3]): t[(i + 2) % 3] for t in triangles for i in range(3)}
    open_sides = {side for side in sides if side[::-1] not in sides}
    boundary = {v for side in open_sides for v in side}
    neighbours = neighbours_of(sides, boundary)
    for a, b in sides:
        opposite = {sides[side] for side in ((a, b), (b, a)) if side in sides}
        opposite |= {-1} if (a, b) in open_sides else set()
        if neighbours[a] & neighbours[b] != opposite or len(neighbours[a]) == len(neighbours[b]) == 3:
            continue
        assert a in boundary and b in boundary and (a, b) not in open_sides


@in_both_orders
@pytest.mark.parametrize("offset", [1e-3, 0.3])
def test_a_base_has_area(order, offset):
    """All vertices on a line but the first, which is the first to go where vertices go by index."""
    i = np.arange(12)
    around = np.where(i <= 6, i, 12 - i) + 0.1 * (i > 6)
    points = np.zeros((14, 3))
    points[:, 0] = [3.02, *around, -5]
    points[0, 1] = offset
    ring, after = i + 1, (i + 1) % 12 + 1
    faces = [np.stack([ring, after, 0 * i], axis=1), np.stack([after, ring, 0 * i + 13], axis=1)]
    original = Surface(points, np.concatenate(faces))
    mesh = ProgressiveMesh(original, order=order)
    assert_same_bits(mesh.restore(), original)
    assert len(mesh.base.repairs.zero_area_faces) < len(mesh.base.triangles) <= 12


def test_boundary_vertices_stay_on_the_boundary():
    mesh = progressive("cylinder", "quadric")

    def boundary(level):
        edges, edge_of_corner = counting.undirected_edges(as_mesh(level))
        return set(level.vertex_index[edges[np.bincount(edge_of_corner) == 1].ravel()].tolist())

    on_boundary = boundary(mesh.level(2**31))
    for n_faces in levels(mesh):
        level = mesh.level(n_faces)
        assert boundary(level) == on_boundary & set(level.vertex_index.tolist())


# ---- the same input, the same bits -----------------------------------------------------------------------------------


@in_both_orders
@pytest.mark.parametrize("name", ["torus of triangles", "cylinder", "cage"])
def test_deterministic(name, order):
    again = ProgressiveMesh(surface(name), corner_data=corner_data(surface(name)), order=order)
    assert_same_arrays(again, progressive(name, order))


def test_flat_parts_go_first():
    """Quadric order keeps the corners of a cube to the end."""
    mesh = ProgressiveMesh(surface_of(families.voxel_surface(np.ones((4, 4, 4)))))
    level = mesh.level(12)
    assert sorted(level.vertices.tolist()) == [
        [4.0 * x, 4.0 * y, 4.0 * z] for x in (0, 1) for y in (0, 1) for z in (0, 1)
    ]


# ---- files -----------------------------------------------------------------------------------------------------------


@everything
@in_both_orders
def test_saved_and_loaded(name, order, tmp_path):
    mesh = progressive(available(name), order)
    mesh.save(tmp_path / "mesh")
    loaded = ProgressiveMesh.load(tmp_path / "mesh")
    assert_same_bits(loaded.restore(), surface(name))
    assert_same_bits(loaded.base, mesh.base)
    assert (loaded.splits == mesh.splits).all()
    assert loaded.corner_data.dtype == np.float32 and (loaded.corner_data == mesh.corner_data).all()
    loaded.save(tmp_path / "again")
    assert (tmp_path / "again").read_bytes() == (tmp_path / "mesh").read_bytes()


@pytest.mark.parametrize("dtype", ["<f8", ">f4", "<i2", "|b1", "<c16", "|u1"])
def test_corner_data_keep_type_and_shape(dtype, tmp_path):
    original = surface("cube")
    for shape in ((), (1,), (2, 3)):
        data = (np.arange(24 * int(np.prod(shape))) % 2).reshape(24, *shape).astype(dtype)
        mesh = ProgressiveMesh(original, corner_data=data)
        mesh.save(tmp_path / "mesh")
        loaded = ProgressiveMesh.load(tmp_path / "mesh").corner_data
        assert (loaded.dtype, loaded.shape, loaded.tobytes()) == (data.dtype, data.shape, data.tobytes())
    assert ProgressiveMesh(original).corner_data is None


def test_files_that_are_none_are_refused(tmp_path):
    path = tmp_path / "mesh.npz"
    with pytest.raises(InvalidMesh, match="No such file"):
        ProgressiveMesh.load(path)
    progressive("cylinder", "quadric").save(path)
    whole = path.read_bytes()
    for damaged in (b"", b"solid teapot" + bytes(100), whole[:-30], whole[: len(whole) // 2], bytes([0]) + whole[1:]):
        path.write_bytes(damaged)
        with pytest.raises(InvalidMesh, match=r"no undamaged \.npz file"):
            ProgressiveMesh.load(path)
    np.savez(path, positions=np.zeros((3, 3)))
    with pytest.raises(InvalidMesh, match="no array base_triangles"):
        ProgressiveMesh.load(path)
    np.savez_compressed(path, **arrays_of("cylinder"))
    with pytest.raises(InvalidMesh, match="it is compressed"):
        ProgressiveMesh.load(path)
    np.savez(path, **{**arrays_of("cylinder"), "positions": np.array([{}])})
    with pytest.raises(InvalidMesh, match="pickle"):
        ProgressiveMesh.load(path)


def arrays_of(name):
    return {key: np.array(array) for key, array in progressive(name, "quadric").__getstate__().items()}


def refused(arrays, words):
    with pytest.raises(InvalidMesh, match=words):
        ProgressiveMesh.__new__(ProgressiveMesh).__setstate__(arrays)


def test_arrays_that_do_not_fit_are_refused():
    given = arrays_of("washer of C-shaped n-gons")
    corner_data = given["corner_data"]
    for name, array in given.items():
        if name != "corner_data":
            refused({**given, name: array.astype(np.float32)}, f"{name} has the wrong type")
            refused({**given, name: array[:, None]}, f"{name} has the wrong type or shape")
        for other in (array[:-1], np.concatenate([array, array[-1:]]), array[:0]):
            if name != "face_offsets" or len(other):  # without them it is one of triangles
                refused({**given, name: other}, "damaged|rows for")
    refused({**given, "corner_data": np.array([{}] * len(corner_data))}, "type object")


def test_damaged_splits_are_refused():
    """Each number in the columns v_s, v_l, v_r of some splits is replaced by wrong ones."""
    given = arrays_of("cylinder")
    count = len(given["split_vertices"])
    for column in range(3):
        for k in (0, 5, count - 1):
            for wrong in (-2, 2**31 - 1, -(2**31), len(given["positions"])):
                vertices = given["split_vertices"].copy()
                vertices[k, column] = wrong
                refused({**given, "split_vertices": vertices}, f"vertex split {k} |as many triangles as there")


@pytest.mark.parametrize("name", ["cylinder", "torus of quads", "partly reversed"])
def test_damaged_arrays_are_refused_or_valid(name):
    """Any bytes of the arrays replaced by any others: a valid mesh or an error of the library, no crash."""
    random = np.random.default_rng(11)
    for _ in range(400):
        damaged = arrays_of(name)
        for _ in range(random.integers(1, 4)):
            array = damaged[random.choice(sorted(damaged))]
            array.view(np.uint8).reshape(-1)[random.integers(array.nbytes)] = random.integers(256)
        mesh = ProgressiveMesh.__new__(ProgressiveMesh)
        try:
            mesh.__setstate__(damaged)
            mesh.restore()
            mesh.level(100)
            assert len(mesh.splits) >= 0
        except Error as error:
            assert str(error)


@pytest.mark.parametrize("name", ["cylinder", "torus of quads"])
def test_damaged_files_are_refused_or_the_same(name, tmp_path):
    """Checksums of zip files find what is replaced in an array; other bytes may mean nothing."""
    path, mesh = tmp_path / "mesh.npz", progressive(name, "quadric")
    mesh.save(path)
    whole, random = path.read_bytes(), np.random.default_rng(12)
    for _ in range(400):
        damaged = bytearray(whole)
        damaged[random.integers(len(whole) if random.random() < 0.3 else 400)] = random.integers(256)
        damaged[-random.integers(1, 1200)] = random.integers(256)
        path.write_bytes(damaged)
        try:
            assert_same_arrays(ProgressiveMesh.load(path), mesh)
        except InvalidMesh as error:
            assert str(error)


# ---- classes and loops -----------------------------------------------------------------------------------------------


CLOSED = (
    "torus of triangles",
    "torus of quads",
    "torus knot",
    "genus 2 block",
    "cage",
    "washer of C-shaped n-gons",
    "partly reversed",
)


def integer_classes(structure):
    """2g closed integer forms dual to the loops: rounded periods of the harmonic forms, made exact by a walk."""
    base = structure.surface
    edges = EdgeForms(structure.edges, len(base.vertices))
    forms = np.zeros((len(structure.harmonic_forms), len(structure.edges)))
    potential = np.full((len(forms), len(base.vertices)), np.nan)
    potential[:, 0] = 0
    tree = [0]
    for v in tree:
        ends = np.concatenate(
            [structure.edges[structure.edges[:, 0] == v, 1], structure.edges[structure.edges[:, 1] == v, 0]]
        )
        for u in ends[np.isnan(potential[0, ends])].tolist():
            potential[:, u] = (
                potential[:, v] + edges.along(structure.harmonic_forms, np.array([v]), np.array([u]))[:, 0]
            )
            tree.append(u)
    forms = structure.harmonic_forms - (potential[:, structure.edges[:, 1]] - potential[:, structure.edges[:, 0]])
    rounded = np.rint(forms).astype(np.int64)
    assert np.abs(forms - rounded).max() < 1e-6
    return rounded


def closedness(surface, edges, forms):
    """Sums around the triangles."""
    t = surface.triangles
    return sum(edges.along(forms, t[:, i], t[:, (i + 1) % 3]) for i in range(3))


@in_both_orders
@pytest.mark.parametrize("name", CLOSED)
def test_integer_classes_and_loops_keep_their_periods(name, order):
    mesh = progressive(name, order)
    base = conformal_structure(mesh.base)
    classes, loops = integer_classes(base), base.homology_basis
    for n_faces in (*levels(mesh, 5), None):
        level = mesh.restore() if n_faces is None else mesh.level(n_faces)
        edges = EdgeForms(level._native.edges, len(level.vertices))
        forms = mesh.pull_back_forms(classes, n_faces)
        lifted = mesh.lift_loops(loops, n_faces)
        assert forms.dtype == np.int64
        assert not closedness(level, edges, forms).any()
        assert (edges.integrals(forms, lifted) == np.eye(len(loops), dtype=int)).all()


def test_rule_5b_split_by_split():
    """Pulled back through one split: 0 on v_s v_t, and on v_t v_l and v_t v_r the values of v_s v_l and v_s v_r."""
    mesh = progressive("torus of triangles", "quadric")
    classes = integer_classes(conformal_structure(mesh.base))
    counts = np.cumsum((mesh.splits["v_l"] >= 0).astype(int) + (mesh.splits["v_r"] >= 0)) + len(mesh.base.triangles)
    for k in range(0, len(mesh.splits), 37):
        split, level = mesh.splits[k], mesh.level(counts[k])
        forms = mesh.pull_back_forms(classes, counts[k])
        edges = EdgeForms(level._native.edges, len(level.vertices))
        s, t, left, right = (np.array([split[name]]) for name in ("v_s", "v_t", "v_l", "v_r"))
        assert not edges.along(forms, s, t).any()
        assert (edges.along(forms, t, left) == edges.along(forms, s, left)).all()
        assert (edges.along(forms, t, right) == edges.along(forms, s, right)).all()


def test_loops_must_run_along_edges():
    mesh = progressive("torus of triangles", "quadric")
    with pytest.raises(InvalidMesh, match="has no such edge"):
        mesh.lift_loops([[0, 0, 1]])
    with pytest.raises(InvalidMesh, match="empty or names a vertex"):
        mesh.lift_loops([[0, 10**6]])
    with pytest.raises(InvalidMesh, match="is needed"):
        mesh.pull_back_forms(np.zeros((2, 3)))


# ---- conformal structures of levels ----------------------------------------------------------------------------------


def structures(name):
    """From coarse to fine, each with four times as many faces as the one before."""
    mesh = progressive(available(name), "quadric")
    count = len(mesh.level(2**31).triangles)
    return [mesh.conformal_structure(count // 4**k) for k in (3, 2, 1, 0)]


@pytest.mark.parametrize("name", ["torus knot", "genus 2 block", "kitten_19k.obj", "double-torus.obj", FERTILITY])
def test_levels_have_the_same_classes(name):
    found = structures(name)
    for structure in found:
        assert (structure.intersection_matrix == found[-1].intersection_matrix).all()
        assert (structure.canonical_basis == found[-1].canonical_basis).all()
        edges = EdgeForms(structure.edges, len(structure.surface.vertices))
        periods = edges.integrals(structure.harmonic_forms, structure.homology_basis)
        assert np.abs(periods - np.eye(len(periods))).max() < 1e-12
        assert max(structure.residuals.closedness, structure.residuals.harmonicity) < 1e-8


@pytest.mark.parametrize("name", ["torus knot", "kitten_19k.obj", "double-torus.obj", FERTILITY])
def test_period_matrices_of_levels_approach_that_of_the_original(name):
    """Entry by entry, which makes sense only because the classes are the same."""
    *coarse, fine = (structure.period_matrix for structure in structures(name))
    errors = [np.abs(matrix - fine).max() for matrix in coarse]
    assert errors[0] > errors[1] > errors[2]
    assert errors[2] < 0.02 * np.abs(fine).max()


@pytest.mark.parametrize("name", ["torus of triangles", "kitten_19k.obj"])
def test_the_finest_level_has_the_structure_of_the_original(name):
    """The modulus of a torus, reduced to the fundamental domain, knows nothing of the basis."""

    def reduced(tau):
        while True:
            tau = tau - np.rint(tau.real)
            if abs(tau) > 1 - 1e-9:
                return tau
            tau = -1 / tau

    mesh, original = progressive(available(name), "quadric"), conformal_structure(surface(name))
    (tau,) = mesh.conformal_structure(2**31).period_matrix.ravel()
    (expected,) = original.period_matrix.ravel()
    assert abs(reduced(tau) - reduced(expected)) < 1e-8


def test_levels_without_holomorphic_forms_are_refused():
    with pytest.raises(TopologyError, match="genus 0 and 0 boundaries"):
        progressive("cube", "quadric").conformal_structure(100)
    with pytest.raises(TopologyError, match="2 connected components"):
        progressive("two components", "quadric").conformal_structure(100)
    with pytest.raises(ValueError, match="solver is 'none'"):
        progressive("torus knot", "quadric").conformal_structure(100, solver="none")
    with pytest.raises(ValueError, match="threads is 0"):
        progressive("torus knot", "quadric").conformal_structure(100, threads=0)


# ---- what is refused -------------------------------------------------------------------------------------------------


def test_intrinsic_surfaces_are_refused():
    with pytest.raises(InvalidMesh, match="needs positions"):
        ProgressiveMesh(surface_of(families.flat_torus(1j, 4)))


def test_diagonals_beside_an_edge_are_flipped():
    """A quad whose shorter diagonal is an edge of triangles on the other side of the surface."""
    points = [[0, 0, 0], [1.5, -0.5, 0.1], [1, 1, 0], [-0.5, 1.5, 0.1], [0.5, 0.5, -1]]
    mesh = families.polygons(points, [[0, 1, 2, 3], [1, 0, 4], [2, 1, 4], [0, 2, 4], [3, 2, 0]], ((0, 0),))
    original = surface_of(mesh)
    assert len(np.unique(original._native.edges, axis=0)) < len(original._native.edges)
    progressive_mesh = ProgressiveMesh(original)
    assert_same_bits(progressive_mesh.restore(), original)
    assert len(progressive_mesh.base.triangles) == 4


def test_corner_data_must_fit():
    with pytest.raises(InvalidMesh, match="5 rows for 24 polygon corners"):
        ProgressiveMesh(surface("cube"), corner_data=np.zeros((5, 2)))
    with pytest.raises(InvalidMesh, match="numbers or booleans"):
        ProgressiveMesh(surface("cube"), corner_data=np.array(["a"] * 24))
    with pytest.raises(ValueError, match="order is 'random'"):
        ProgressiveMesh(surface("cube"), order="random")


@in_both_orders
def test_progress_rises_and_can_cancel(order):
    seen = []
    ProgressiveMesh(surface("torus knot"), order=order, progress=lambda fraction, stage: seen.append((stage, fraction)))
    assert {stage for stage, _ in seen} == {"edge collapses"}
    fractions = [fraction for _, fraction in seen]
    assert fractions == sorted(fractions) and fractions[-1] == 1
    with pytest.raises(Cancelled, match="edge collapses"):
        ProgressiveMesh(surface("torus knot"), order=order, progress=lambda fraction, stage: False)
