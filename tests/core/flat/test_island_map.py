"""Maps in islands: paper nets of what unfolds, and which parts get them."""

import families
import holomorph
import numpy as np
import pytest
from holomorph import Surface, TopologyError, automatic_structure, island_map
from holomorph.mesh.edges import polygon_sides
from solids import around, bracket, can, cone
from solved import surface_of

EXACT = 1e-9


def box():
    return Surface(*hull_of_box())


def hull_of_box(size=(1.0, 2.0, 3.0)):
    corners = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)]) * size
    return corners, [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]


def octahedron():
    points = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]]
    upper = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4]]
    return Surface(points, upper + [[b, a, 5] for a, b, _ in upper])


def plate_with_holes():
    """A flat square of cells, four of them missing, tilted in space."""
    mask = np.ones((9, 9), bool)
    mask[2, 2] = mask[2, 6] = mask[6, 2] = mask[6, 6] = False
    flat = families.flat_cells(mask, 1.0, topology=((0, 5),))
    turn = np.linalg.qr(np.arange(9.0).reshape(3, 3) + np.eye(3))[0]
    return surface_of(families.Mesh(flat.vertices @ turn.T, flat.corners, flat.offsets, flat.topology))


def step():
    """Two plates that meet at a right angle: one piece of paper, folded."""
    points = [[x, y, 0] for x in (0, 1, 2) for y in (0, 1)] + [[2, 0, 1], [2, 1, 1]]
    return Surface(points, [[0, 2, 3, 1], [2, 4, 5, 3], [4, 6, 7, 5]])


UNFOLDED = {  # and how many edges stay seams: as many as a paper net needs whose sides stand upright
    "box": (box, 7),
    "octahedron": (octahedron, 8),
    "step": (step, 0),
    "cone": (cone, None),
    "can": (can, None),
    "bracket": (bracket, None),
    "plate with holes": (plate_with_holes, 0),
}


@pytest.fixture(params=UNFOLDED)
def unfolded(request):
    make, seams = UNFOLDED[request.param]
    return make(), seams


def lengths_in(uv, surface):
    """(#C,) of the sides of polygons, in the plane and in space."""
    following = np.arange(1, len(uv) + 1)
    following[surface.face_offsets[1:] - 1] = surface.face_offsets[:-1]
    ends = surface.vertices[polygon_sides(surface)]
    return np.linalg.norm(uv[following] - uv, axis=1), np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1)


def test_what_unfolds_keeps_all_lengths(unfolded):
    surface, seams = unfolded
    made = island_map(surface, evenness=0.5)
    flat, real = lengths_in(made.uv, surface)
    assert flat == pytest.approx(real, rel=EXACT)
    assert made.quality.mean_angle == pytest.approx(1, abs=EXACT)
    assert not made.quality.flipped.any() and made.quality.overlapping_part < EXACT
    assert seams is None or len(made.seams) == seams


def test_uvs_are_the_same_on_both_sides_of_every_edge_that_is_no_seam(unfolded):
    surface, _ = unfolded
    made = island_map(surface)
    sides = polygon_sides(surface)
    following = np.arange(1, len(sides) + 1)
    following[surface.face_offsets[1:] - 1] = surface.face_offsets[:-1]
    named = {}
    for corner, (a, b) in enumerate(sides.tolist()):
        named.setdefault((min(a, b), max(a, b)), []).append((corner, following[corner]))
    seams = {tuple(sorted(edge)) for edge in made.seams.tolist()}
    for edge, found in named.items():
        if len(found) == 2:
            (a, b), (c, d) = found
            gap = max(np.abs(made.uv[a] - made.uv[d]).max(), np.abs(made.uv[b] - made.uv[c]).max())
            assert (gap > 1e-6) == (edge in seams)


@pytest.mark.parametrize("turn", [0.0, 0.7])
def test_rows_run_along_a_lying_tube(turn):
    """Around it up and down cancel: across, a texture would lie on its side everywhere."""
    around, along = (each.ravel() for each in np.meshgrid(np.arange(24), np.arange(7), indexing="ij"))
    angle = 2 * np.pi * around / 24 + turn
    points = np.stack([along, np.cos(angle), np.sin(angle)], axis=1)
    first = np.flatnonzero(along < 6)
    quads = np.stack([first, first + 7, first + 8, first + 1], axis=1) % len(points)
    made = island_map(Surface(points, quads))
    assert made.quality.direction.sideways_part < 0.1


def test_islands_stand_upright_and_apart():
    """The four sides of a box stand in one row: v runs up on them, as z does."""
    surface = box()
    made = island_map(surface)
    upright = surface.vertices[surface.corner_vertices]
    for face, (start, end) in enumerate(zip(surface.face_offsets[:-1], surface.face_offsets[1:])):
        points, uv = upright[start:end], made.uv[start:end]
        if np.ptp(points[:, 2]) > 0:
            assert np.ptp(uv[:, 1] - points[:, 2]) < EXACT, face


def test_a_tube_is_cut_from_loop_to_loop():
    surface = surface_of(families.cylinder(12, 8))
    made = island_map(surface)
    assert made.islands == 1 and made.soft_length > made.hard_length  # the mesh bends by 30 degrees, which hides half
    assert made.soft_length + made.hard_length == pytest.approx(np.ptp(surface.vertices[:, 2]) / np.sqrt(surface.area))


@pytest.mark.parametrize(
    "make", [lambda: surface_of(families.geodesic_sphere(6)), lambda: surface_of(families.torus(24, 12))]
)
def test_a_closed_smooth_part_has_none(make):
    assert island_map(make()) is None


def test_what_cannot_be_cut_is_refused():
    intrinsic = Surface.from_edge_lengths([[0, 1, 2], [0, 2, 1]], [[1.0, 1.0, 1.0]] * 2)
    two = surface_of(families.united(families.cube(), families.cube()))
    for wrong, message in ((intrinsic, "positions"), (two, "2 connected components")):
        with pytest.raises(TopologyError, match=message):
            island_map(wrong)
    torus = Surface.from_edge_lengths([[0, 0, 0], [0, 0, 0]], np.ones((2, 3)), [[0, 1, 2], [0, 1, 2]])
    with pytest.raises(TopologyError, match="positions"):
        automatic_structure(torus).tile(turns=4, lines="whole")


def dome(height, n=24, m=24):
    """A cap of a sphere, deeper than half where height is above 1."""
    rows = np.linspace(0, np.arccos(1 - height), m + 1)[1:]
    points = [[0, 0, 1], *(p for r in rows for p in around(n, np.sin(r), np.cos(r)))]
    faces = [[0, 1 + i, 1 + (i + 1) % n] for i in range(n)]
    for k in range(m - 1):
        a, b = 1 + k * n, 1 + (k + 1) * n
        faces += [[a + i, b + i, b + (i + 1) % n, a + (i + 1) % n] for i in range(n)]
    return Surface(points, faces)


def test_a_deep_dome_is_cut_to_its_tip_and_a_shallow_one_is_not():
    """The cut pays where lengths change by more than a factor of 2.5."""
    shallow, deep = island_map(dome(0.5), evenness=0.5), island_map(dome(1.9), evenness=0.5)
    assert len(shallow.seams) == 0 and shallow.quality.density_ratio < 2
    assert len(deep.seams) > 0 and deep.quality.density_ratio < 4


def ramp(turns, n=32):
    """A flat strip that winds around an axis and hardly rises: unrolled, it lies over itself after one turn."""
    angle = np.linspace(0, 2 * np.pi * turns, int(n * turns) + 1)
    rims = [np.stack([r * np.cos(angle), r * np.sin(angle), 0.02 * angle], axis=1) for r in (1.0, 2.0)]
    count = len(angle)
    return Surface(np.concatenate(rims), [[i, count + i, count + i + 1, i + 1] for i in range(count - 1)])


@pytest.mark.parametrize(("turns", "pieces"), [(0.8, 1), (1.5, 2), (2.5, 3)])
def test_a_piece_that_would_lie_over_itself_is_parted(turns, pieces):
    made = island_map(ramp(turns), evenness=0.5)
    assert made.islands == pieces and made.quality.overlapping_part <= 1e-6


def bevelled_box(bevel=0.1):
    """A box whose edges and corners are cut off: no edge is sharper than 60 degrees, and no piece of it is flat."""
    signs = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    points = np.concatenate([signs * (1 - bevel * (np.arange(3) != axis)) for axis in range(3)])
    name = {(axis, *sign): 8 * axis + k for axis in range(3) for k, sign in enumerate(signs.tolist())}
    faces = [[name[(axis, *s)] for axis in range(3)] for s in signs.tolist()]
    for axis in range(3):
        one, other = (axis + 1) % 3, (axis + 2) % 3
        for a, b in ((-1, 1), (1, 1), (1, -1), (-1, -1)):
            low, high = [0, 0, 0], [0, 0, 0]
            low[axis], high[axis] = -1, 1
            low[one] = high[one] = a
            low[other] = high[other] = b
            faces.append([name[(one, *low)], name[(one, *high)], name[(other, *high)], name[(other, *low)]])
        for side in (-1, 1):
            ring = [[0, 0, 0] for _ in range(4)]
            for corner, (a, b) in zip(ring, ((-1, -1), (1, -1), (1, 1), (-1, 1)), strict=True):
                corner[axis], corner[one], corner[other] = side, a, b
            faces.append([name[(axis, *corner)] for corner in ring])
    return Surface(points, faces)


def test_softer_edges_are_cut_where_the_hard_ones_leave_what_stretches():
    surface = bevelled_box()
    assert (surface.genus, surface.boundary_count) == (0, 0)
    made = holomorph.automatic_map(surface)
    assert made.kind == "islands" and made.quality.density_ratio < 1.05 and made.quality.overlapping_part <= 1e-6


def test_evenness_makes_squares_more_alike():
    ratios = [island_map(dome(0.9), evenness=e).quality.density_ratio for e in (0.0, 0.5, 1.0)]
    assert ratios[0] > ratios[1] > ratios[2]


def test_the_area_in_the_plane_is_that_of_the_surface():
    for surface in (dome(0.9), dome(1.9), cone()):
        made = island_map(surface, evenness=0.5)
        corners = surface.triangle_corners
        a, b, c = (made.uv[corners[:, k]] for k in range(3))
        area = 0.5 * np.abs(np.linalg.det(np.stack([b - a, c - a], axis=1))).sum()
        assert area == pytest.approx(surface.area, rel=1e-9)


def test_small_holes_leave_no_seam():
    """As many in a curved sheet, too: they are filled for the map."""
    n = 16
    x, y = np.meshgrid(np.linspace(-1, 1, n + 1), np.linspace(-1, 1, n + 1), indexing="ij")
    points = np.stack([x, y, 0.3 * np.cos(2 * x) * np.cos(2 * y)], axis=-1).reshape(-1, 3)
    cells = [
        [i * (n + 1) + j, (i + 1) * (n + 1) + j, (i + 1) * (n + 1) + j + 1, i * (n + 1) + j + 1]
        for i in range(n)
        for j in range(n)
        if not (i % 4 == 2 and j % 4 == 2)
    ]
    surface = Surface(points, cells)
    assert surface.boundary_count == 17
    made = island_map(surface, evenness=0.5)
    assert len(made.seams) == 0 and made.quality.density_ratio < 2 and not made.quality.flipped.any()


def test_the_map_is_the_same_at_any_number_of_threads(unfolded):
    surface, _ = unfolded
    one, two = (island_map(surface, evenness=0.5, threads=threads) for threads in (1, 2))
    assert np.array_equal(one.uv, two.uv) and np.array_equal(one.seams, two.seams)


def test_faces_that_are_read_in_reverse_are_not_mirrored():
    """Whole pieces may consist of such faces: each side of the box is one."""
    corners, faces = hull_of_box()
    for which in range(6):
        made = island_map(Surface(corners, [face[::-1] if k == which else face for k, face in enumerate(faces)]))
        assert made.islands == 1 and not made.quality.flipped.any() and len(made.seams) == 7


def test_the_numbering_of_the_mesh_does_not_matter():
    surface = bracket()
    mesh = families.Mesh(surface.vertices, surface.corner_vertices, surface.face_offsets)
    relabelled, _ = families.relabelled(mesh)
    first, second = island_map(surface), island_map(surface_of(relabelled))
    assert first.islands == second.islands  # which joints come first is free


def test_progress_is_reported_and_cancels():
    calls = []
    island_map(dome(0.9), evenness=0.5, progress=lambda *at: calls.append(at))
    assert calls
    with pytest.raises(holomorph.Cancelled):
        island_map(dome(0.9), evenness=0.5, progress=lambda *_: False)


@pytest.mark.parametrize("name", [name for name in UNFOLDED if name != "can"])  # which whole tiles lie around
def test_such_parts_get_their_islands_from_the_one_function(name):
    surface = UNFOLDED[name][0]()
    made = holomorph.automatic_map(surface)
    assert made.kind in ("islands", "flat") and made.quality.density_ratio == pytest.approx(1, abs=EXACT)
    assert made.islands == island_map(surface).islands and not len(made.poles) and "flattens" in made.why


@pytest.mark.parametrize("name", ["torus", "cylinder", "geodesic_sphere"])
def test_smooth_parts_keep_their_seamless_maps(name):
    sizes = {"torus": (24, 12), "cylinder": (16, 24), "geodesic_sphere": (6,)}
    made = holomorph.automatic_map(surface_of(getattr(families, name)(*sizes[name])))
    assert made.kind == "tiling" and made.islands == 0
