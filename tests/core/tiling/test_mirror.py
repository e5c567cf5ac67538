"""Tilings of surfaces that are their own mirror image: so are their poles (exact) and the map (solver)."""

import families
import numpy as np
import pytest
from holomorph import Tiler
from solved import surface_of

ON_GRID = 1e-6  # of the size: vertices that are one
SAME = 1e-5  # in tiles
SAME_EVENED = 1e-3  # likewise: evening ends where little is gained


def body(stretch=0.0):
    """A body with a head, a tail, two arms and two legs, bent and rounded by waves that are even in x: its own mirror
    image in x = 0. `stretch` : by how much the arm at x > 0 is longer than the other."""
    cells = np.zeros((14, 6, 14), bool)
    cells[4:10, 1:5, 4:10] = True
    cells[5:9, 1:4, 10:13] = True  # head
    cells[6:8, 5:, 5:7] = True  # tail
    cells[:4, 2:4, 7:9] = cells[10:, 2:4, 7:9] = True
    cells[4:6, 2:4, :4] = cells[8:10, 2:4, :4] = True
    mesh = families.voxel_surface(cells)
    x, y, z = mesh.vertices.T
    x = x - len(cells) / 2
    # Each quad is cut at the corner that comes first, x -> -x or not.
    rank = np.empty(len(x), int)
    rank[np.lexsort([z, y, np.abs(x)])] = np.arange(len(x))
    quads = mesh.corners.reshape(-1, 4)
    first = np.argmin(rank[quads], axis=1)
    quads = np.take_along_axis(quads, (first[:, None] + np.arange(4)) % 4, axis=1)
    x = x + stretch * np.maximum(x - 3, 0)
    waves = 0.25 * np.array([np.sin(x), np.cos(x) * np.sin(0.7 * y), np.sin(0.5 * z + 1) * np.cos(0.4 * x)])
    return families.uniform(np.stack([x, y, z], axis=1) + waves.T, quads[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3))


BODY = body()


def images(vertices, axis=0):
    """(#V,) the vertex at the mirror image of each."""
    grid = np.rint(vertices / np.ptp(vertices) / ON_GRID).astype(int)
    order = np.lexsort(grid.T)
    seen = grid * np.where(np.arange(3) == axis, -1, 1)
    found = order[np.argsort(np.lexsort(seen.T))]
    assert np.array_equal(grid[found], seen)
    return found


def image_corners(mesh, image):
    """(#C,) the corner at the mirror image of each."""
    count = len(mesh.vertices)
    faces = mesh.corners.reshape(-1, 3)
    order = np.lexsort(np.sort(faces, axis=1).T)
    seen = np.argsort(np.lexsort(np.sort(image[faces], axis=1).T))
    face = order[seen]
    keys = face[:, None] * count + image[faces]
    own = np.arange(len(faces))[:, None] * count + faces
    return np.argsort(own.ravel())[np.searchsorted(np.sort(own.ravel()), keys.ravel())]


def away_from_mirror(mesh, uv):
    """The largest distance of the UVs from their mirror image, u -> -u or v -> -v, up to whole tiles: the better of
    both."""
    corners = image_corners(mesh, images(mesh.vertices))
    away = []
    for signs in ([-1, 1], [1, -1]):
        change = uv[corners] - signs * uv
        change -= change[0]
        away.append(np.abs(change - np.rint(change)).max())
    return min(away)


def are_mirrored(vertices, poles, residues, axis=0):
    """Whether the image of each pole is a pole, its residue conjugate, or minus that: for all the same."""
    image = images(vertices, axis)
    place = {int(p): r for p, r in zip(poles, residues, strict=True)}
    if any(int(image[p]) not in place for p in place):
        return False
    return any(
        all(abs(place[int(image[p])] - sign * r.conjugate()) < 1e-9 for p, r in place.items()) for sign in (1, -1)
    )


@pytest.mark.parametrize("lattice", ["square", "brick", "hex"])
@pytest.mark.parametrize("direction", [None, "upright", (0, 1, 0)])
def test_a_mirrored_body_has_a_mirrored_map(lattice, direction):
    made = Tiler(surface_of(BODY)).tile(100, lattice=lattice, direction=direction)
    assert are_mirrored(BODY.vertices, made.poles, made.residues)
    if lattice == "square":
        assert away_from_mirror(BODY, made.uv) < SAME


@pytest.mark.parametrize("poles", [7, 8, 10, 12])
def test_any_number_of_poles_is_mirrored(poles):
    """Where they are as many as the body has limbs: fewer of them are much more even without the mirror."""
    placed = Tiler(surface_of(BODY), poles).poles
    assert len(placed.vertices) == poles
    assert are_mirrored(BODY.vertices, placed.vertices, placed.residues)


def test_evening_keeps_the_mirror():
    made = Tiler(surface_of(BODY), evened=True).tile(100, evenness=0.5)
    assert away_from_mirror(BODY, made.uv) < SAME_EVENED


def test_axes_of_inertia_find_the_plane():
    moved = families.moved(BODY)
    made = Tiler(surface_of(moved), 6).tile(100)
    assert are_mirrored(BODY.vertices, made.poles, made.residues)


def test_a_turned_texture_counts_more_than_the_mirror():
    tiler = Tiler(surface_of(BODY), 6)
    level, turned = tiler.tile(100, direction="upright"), tiler.tile(100, direction="upright", turn=0.5, max_turn=0.1)
    assert are_mirrored(BODY.vertices, level.poles, level.residues)
    assert not are_mirrored(BODY.vertices, turned.poles, turned.residues)


def test_a_longer_arm_is_not_mirrored():
    other = body(stretch=0.5)
    made = Tiler(surface_of(other), 8).tile(100)
    assert not are_mirrored(BODY.vertices, made.poles, made.residues)


def test_where_poles_may_be_counts_more_than_the_mirror():
    allowed = BODY.vertices[:, 0] > 0.5
    made = Tiler(surface_of(BODY), 4, allowed=allowed).tile(100)
    assert allowed[made.poles].all()


def test_same_bits_at_any_number_of_threads():
    made = [Tiler(surface_of(BODY), 8, threads=threads).tile(100) for threads in (1, 2, 4)]
    for other in made[1:]:
        assert np.array_equal(made[0].uv, other.uv)
