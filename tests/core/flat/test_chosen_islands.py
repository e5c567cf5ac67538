"""Islands between chosen cuts: seams, hard edges, cone points."""

from dataclasses import replace

import families
import numpy as np
import pytest
from holomorph import Cancelled, InvalidMesh, Surface, TopologyError, automatic_map, automatic_maps
from holomorph.mesh.edges import polygon_sides
from island_checks import ISOMETRIC, stretches
from plane_meshes import flat
from shared_data import shared_folder
from solids import bracket, can, cone
from solved import surface_of

ANGLE = 40  # degrees
FINGERS = ((-0.4, -0.3), (0.4, -0.2), (0.0, 0.4))


def islands(surface, seams=None, **options):
    return automatic_map(surface, main="islands", seams=seams, **options)


def edges(surface):
    return np.unique(np.sort(polygon_sides(surface), axis=1), axis=0)


def between(surface, inside):
    ends = edges(surface)
    return ends[inside[ends].all(axis=1)]


def is_rigid(made):
    """Whether all islands are as they are on the surface, but for one scale."""
    lengths = stretches(made.surface, made.uv)
    return np.ptp(lengths) <= 100 * ISOMETRIC * lengths.mean() and not made.quality.flipped.any()


def glove(n=30):
    """The unit disk with a finger at each place."""
    points, faces = families.hexagonal_disk(n, jitter=0.2)
    height = sum(np.exp(-((points - finger) ** 2).sum(axis=1) / 0.02) for finger in FINGERS)
    return families.uniform(np.column_stack([points, height]), faces, ((0, 1),))


def ramp():
    """A flat strip that winds one and a half times around an axis, rising."""
    n = 120
    angle = np.linspace(0, 3 * np.pi, n)
    rails = [np.stack([r * np.cos(angle), r * np.sin(angle), 0.05 * angle], axis=1) for r in (1, 1.5, 2)]
    i = np.arange(n - 1)
    quads = [np.stack([i + k * n, i + (k + 1) * n, i + 1 + (k + 1) * n, i + 1 + k * n], axis=1) for k in range(2)]
    return Surface(np.concatenate(rails), np.concatenate(quads))


def test_a_cube_falls_into_its_sides():
    surface = surface_of(families.cube())
    made = islands(surface, edges(surface))
    assert (made.kind, made.islands, len(made.seams)) == ("islands", 6, 12)
    assert is_rigid(made) and made.quality.overlapping_part == pytest.approx(0, abs=1e-6)


def test_islands_are_not_joined_where_they_fit():
    """A paper net would have one piece: but a seam is a seam, and a hard edge as well."""
    surface = surface_of(families.cube())
    assert automatic_map(surface).islands == 1
    assert islands(surface, hard_edges=ANGLE).islands == 6


def test_a_torus_is_cut_to_a_disk():
    n, m = 12, 9
    surface = surface_of(families.torus(n, m))
    row, column = np.divmod(np.arange(n * m), m)
    seams = np.concatenate([between(surface, row == 0), between(surface, column == 0)])
    made = islands(surface, seams)
    assert (made.kind, made.islands) == ("islands", 1)
    assert {*map(tuple, made.seams.tolist())} == {*map(tuple, seams.tolist())}


@pytest.mark.parametrize("genus", [0, 1])
def test_what_seams_leave_is_cut_on_to_disks(genus):
    """The side of a can without a seam along it, which is developable; a torus with a seam around one face."""
    surface = can() if genus == 0 else surface_of(families.torus(12, 9))
    rims = [
        side
        for face in np.split(surface.corner_vertices, surface.face_offsets[1:-1])
        if len(face) > 4
        for side in np.stack([face, np.roll(face, -1)], axis=1)
    ]
    face = surface.corner_vertices[:4]
    made = islands(surface, rims if genus == 0 else np.stack([face, np.roll(face, -1)], axis=1))
    assert made.islands == (3 if genus == 0 else 2)
    assert genus == 1 or is_rigid(made)


def test_a_slit_is_cut_open():
    surface = surface_of(flat(4, jitter=0))
    on_axis = between(surface, (np.abs(surface.vertices[:, 1]) < 1e-9) & (surface.vertices[:, 0] < 0.6))
    made = islands(surface, on_axis)
    assert made.islands == 1 and is_rigid(made)


def test_a_cone_and_a_can_and_a_bracket_are_flattened_without_shearing():
    for surface, count in ((cone(), 2), (can(), 3)):
        made = islands(surface, hard_edges=ANGLE)
        assert made.islands == count and is_rigid(made)
    assert islands(bracket(), hard_edges=ANGLE).quality.mean_angle == pytest.approx(1, abs=1e-6)


def test_the_angle_decides():
    surface = surface_of(families.cube())
    assert islands(surface, hard_edges=89.9).islands == 6
    with pytest.raises(TopologyError, match="no edge is that sharp"):
        islands(surface, hard_edges=90.1)
    with pytest.raises(TopologyError, match="no seams cut it open"):
        islands(surface)


def test_seams_count_besides():
    surface = can()
    made = islands(surface, [[0, 32]], hard_edges=ANGLE)
    assert made.islands == 3 and [0, 32] in made.seams.tolist() and is_rigid(made)


@pytest.mark.parametrize("change", [lambda m: families.moved(m, scale=1e-5), families.partly_reversed])
def test_size_place_and_the_order_of_corners_do_not_matter(change):
    assert islands(surface_of(change(families.cube())), hard_edges=ANGLE).islands == 6


def test_vertices_are_those_of_the_mesh_as_given():
    square = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 1, 0], [2, 2, 0], [1, 2, 0]]
    surface = Surface(square, [[0, 1, 2, 3], [2, 4, 5, 6]], strict=False)  # two fans touch at vertex 2
    made = automatic_maps(surface, main="islands", seams=[[2, 3]])
    assert [one.islands for one in made] == [1, 1]


def test_pairs_that_are_no_edges_do_not_count():
    surface = surface_of(flat(3))
    far = int(np.argmax(np.linalg.norm(surface.vertices - surface.vertices[0], axis=1)))
    assert len(islands(surface, [[0, far], [0, 0]]).seams) == 0


@pytest.mark.parametrize("most", [2.0, 4.0])
def test_islands_are_cut_to_cone_points_until_they_are_even(most):
    surface = surface_of(glove())
    before, after = islands(surface, evenness=0.0), islands(surface, most_stretch=most, evenness=0.0)
    assert before.islands == 1 and not len(before.seams) and len(after.seams) > 3
    assert after.quality.density_ratio < min(most**4, before.quality.density_ratio)
    assert not after.quality.flipped.any()
    on_seams = np.unique(after.seams)
    for finger in FINGERS:
        at_tip = (np.linalg.norm(surface.vertices[:, :2] - finger, axis=1) < 0.1) & (surface.vertices[:, 2] > 0.8)
        assert np.isin(np.flatnonzero(at_tip), on_seams).any()


def test_sizes_do_not_matter():
    mesh = glove(20)
    tall = replace(mesh, vertices=mesh.vertices * 1e6)
    counts = [len(islands(surface_of(each), most_stretch=2.0).seams) for each in (mesh, tall, families.moved(mesh))]
    assert len(set(counts)) == 1


def test_a_hand_becomes_even():
    surface = Surface.read(shared_folder("meshes") / "hand_lowres_b1.obj")
    assert islands(surface, most_stretch=2.0, evenness=0.0).quality.density_ratio < 5


def test_none_lies_over_itself():
    made = islands(ramp())
    assert made.islands >= 2 and made.quality.overlapping_part == pytest.approx(0, abs=1e-6)


def test_the_map_is_the_same_at_any_number_of_threads():
    one, two = (islands(surface_of(glove(20)), most_stretch=2.0, threads=threads) for threads in (1, 2))
    assert np.array_equal(one.uv, two.uv)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"hard_edges": -1}, "hard_edges is"),
        ({"hard_edges": np.nan}, "hard_edges is"),
        ({"hard_edges": "40"}, "hard_edges is"),
        ({"most_stretch": 0.5}, "most_stretch is 0.5; a number above 1 is needed"),
        ({"most_stretch": -2}, "most_stretch is"),
    ],
)
def test_numbers_that_are_none(options, words):
    with pytest.raises(ValueError, match=words):
        islands(can(), **options)


def test_seams_that_are_no_pairs():
    for wrong in ([0, 1], [[0.0, 1.0]]):
        with pytest.raises((InvalidMesh, ValueError)):
            islands(can(), wrong)


def test_intrinsic_surfaces_have_no_islands():
    with pytest.raises(TopologyError, match="positions"):
        islands(Surface.from_edge_lengths([[0, 1, 2]], [[1.0, 1.0, 1.0]]))


def test_it_is_cancelled():
    with pytest.raises(Cancelled):
        islands(surface_of(glove()), most_stretch=2.0, progress=lambda *_: False)
