"""Rectangles: straight sides (exact), a modulus between bounds (exact values), refusals."""

import families
import numpy as np
import pytest
from holomorph import RectangleMap, Surface, TopologyError, rectangle_map
from plane_meshes import corners_of, grid, wavy
from solved import surface_of

EXACT = 1e-12
SOLVER = 1e-8
TRAPEZOID = 1.2792616  # in eight digits, as published


def trapezoid(n):
    """A right trapezoid with parallel sides 1 and 2 and height 1, as a jittered grid."""
    mesh = grid(n, n, lambda x, y: np.stack([(2 - y) * x, y, 0 * x], axis=1), "alternating")
    inside = ~np.isin(np.arange(len(mesh.vertices)) // (n + 1), [0, n])
    inside &= ~np.isin(np.arange(len(mesh.vertices)) % (n + 1), [0, n])
    noise = np.random.default_rng(2).uniform(-0.2, 0.2, mesh.vertices.shape) / n * [1, 1, 0]
    return families.uniform(mesh.vertices + noise * inside[:, None], mesh.corners.reshape(-1, 3), ((0, 1),))


@pytest.mark.parametrize("shape", ["quads", "triangles"])
def test_sides_are_straight_exactly(shape):
    surface = surface_of(grid(12, 8, wavy, shape))
    structure = rectangle_map(surface, corners_of(12, 8))
    assert isinstance(structure, RectangleMap)
    uv = np.empty((len(surface.vertices), 2))
    uv[surface.corner_vertices] = structure.uv([])
    assert (uv[surface.corner_vertices] == structure.uv([])).all()  # no seam
    i, j = np.divmod(np.arange(len(uv)), 9)
    assert (uv[i == 0, 0] == 0).all()
    assert (uv[i == 12, 0] == 1).all()
    assert (uv[j == 0, 1] == 0).all()
    assert (uv[j == 8, 1] == structure.modulus).all()
    lower, upper = structure.modulus_bounds
    assert lower <= structure.modulus <= upper
    assert max(vars(structure.residuals).values()) < SOLVER
    assert not structure.quality(structure.uv([])).flipped.any()
    for corner in structure.corners:
        assert str(corner) in structure.description
    assert len(structure.seams) == len(structure.balanced_coefficients()) == len(structure.collapsed_triangles) == 0


@pytest.mark.parametrize("height", [0.25, 1.0, 3.0])
def test_a_flat_rectangle_is_its_own_image(height):
    surface = surface_of(grid(7, 5, lambda x, y: np.stack([x, height * y, 0 * x], axis=1)))
    structure = rectangle_map(surface, corners_of(7, 5))
    assert abs(structure.modulus - height) < 1e-9 * height
    assert abs(structure.quality(structure.uv([])).mean_angle - 1) < 1e-7
    uv = structure.uv([])
    assert np.abs(uv - surface.vertices[surface.corner_vertices, :2]).max() < 1e-8


def test_turning_the_corners_turns_the_rectangle():
    surface = surface_of(grid(12, 8, wavy))
    corners = corners_of(12, 8)
    upright = rectangle_map(surface, corners)
    rotated = rectangle_map(surface, corners[1:] + corners[:1])
    assert abs(upright.modulus * rotated.modulus - 1) < SOLVER
    assert np.abs(np.array(upright.modulus_bounds)[::-1] * rotated.modulus_bounds - 1).max() < SOLVER
    w, z = (structure.uv([]) @ [1, 1j] for structure in (upright, rotated))
    assert np.abs(1 + 1j * upright.modulus * z - w).max() < 1e-6


def elliptic_modulus(k):
    """K(k'), K(k) by arithmetic-geometric means: their quotient."""
    means = []
    for b in (k, np.sqrt(1 - k * k)):
        a = 1.0
        for _ in range(40):
            a, b = (a + b) / 2, np.sqrt(a * b)
        means.append(a)
    return means[1] / means[0]


def exact_trapezoid():
    """Bowman's formula for the trapezoid of height 1 with parallel sides 1 and 2 and two right angles: K(r) / K(r'),
    r = ((s - t) / (s + t))^2, K(s') / K(s) = 1 / c, K(t') / K(t) = c, c = 3."""

    def inverse(quotient):
        low, high = 1e-15, 1 - 1e-15
        for _ in range(100):
            middle = (low + high) / 2
            low, high = (middle, high) if elliptic_modulus(middle) > quotient else (low, middle)
        return low

    s, t = inverse(1 / 3), inverse(3)
    return 1 / elliptic_modulus(((s - t) / (s + t)) ** 2)


def test_trapezoid():
    """Exact value inside the bounds; width and error fall at the order 4/3 of the obtuse corner, or faster."""
    widths, errors = [], []
    for n in (10, 20, 40, 80):
        structure = rectangle_map(surface_of(trapezoid(n)), corners_of(n, n), solver="direct")
        lower, upper = structure.modulus_bounds
        value = structure.modulus
        widths.append(upper - lower)
        errors.append((lower, value, upper))
    exact = 1 / exact_trapezoid()  # the parallel sides are the lower and the upper one
    assert abs(1 / exact - TRAPEZOID) < 1e-7
    for lower, value, upper in errors:
        assert lower <= exact <= upper, (errors, exact)
        assert abs(value - exact) < upper - lower
    assert (np.log2(np.array(widths[:-1]) / widths[1:]) > 1.25).all(), widths


def test_bounds_are_nested_under_refinement():
    mesh = grid(5, 4, wavy, "triangles")
    corners, bounds = corners_of(5, 4), []
    for _ in range(4):
        bounds.append(rectangle_map(surface_of(mesh), corners).modulus_bounds)
        mesh = families.subdivided(mesh)
    bounds = np.array(bounds)
    assert (np.diff(bounds[:, 0]) > 0).all()
    assert (np.diff(bounds[:, 1]) < 0).all()


def test_collapsed_triangles_are_counted():
    """The triangle that cuts a corner lies on two sides, that next to a corner moved along on one."""
    surface = surface_of(grid(6, 6, shape="triangles"))
    ears = [
        t
        for t, triangle in enumerate(surface.triangles)
        if sum(v // 7 in (0, 6) or v % 7 in (0, 6) for v in triangle) == 3
    ]
    assert ears
    corners = corners_of(6, 6)
    shifted = [corners[0] + 7, corners[1], corners[2], corners[3] - 0]
    structure = rectangle_map(surface, shifted)
    collapsed = structure.collapsed_triangles
    side = set(range(7)) | {7}  # from the last corner down to the shifted first one
    expected = [t for t, triangle in enumerate(surface.triangles) if set(triangle.tolist()) <= side]
    assert collapsed.tolist() == expected
    assert ("collapsed" in structure.description) == bool(expected)


def test_solvers_agree_and_threads_do_not_matter():
    surface = surface_of(grid(20, 14, wavy, "triangles"))
    one, two, three = (
        rectangle_map(surface, corners_of(20, 14), solver=solver, threads=threads)
        for solver, threads in (("direct", 1), ("multigrid", 1), ("multigrid", 3))
    )
    assert np.abs(one.uv([]) - two.uv([])).max() < 1e-7
    assert two.uv([]).tobytes() == three.uv([]).tobytes()


def test_isolated_vertices_keep_their_numbers():
    mesh = grid(6, 5, wavy)
    surface = Surface(np.concatenate([[[5.0, 5, 5]], mesh.vertices]), mesh.corners.reshape(-1, 4) + 1)
    chosen = [v + 1 for v in corners_of(6, 5)]
    structure = rectangle_map(surface, chosen)
    assert structure.corners.tolist() == chosen
    with pytest.raises(TopologyError, match="rectangle corner 0 belongs to no face"):
        rectangle_map(surface, [0, *chosen[1:]])


GRID = grid(6, 5, wavy)
A, B, C, D = corners_of(6, 5)
REFUSED = {
    "three": (GRID, [A, B, C], "3 rectangle corners; four are needed"),
    "repeated": (GRID, [A, B, C, A], f"rectangle corner {A} is given twice"),
    "inside": (GRID, [A, B, C, 8], "rectangle corner 8 does not lie on the boundary"),
    "out of range": (GRID, [A, B, C, 42], "rectangle corner 42 is not a vertex: there are 42"),
    "out of order": (GRID, [A, C, B, D], f"not in the order of the boundary.*: that is {A}, {B}, {C}, {D}"),
    "clockwise": (GRID, [A, D, C, B], f"not in the order of the boundary.*: that is {A}, {B}, {C}, {D}"),
    "no integers": (GRID, [0.5, 1, 2, 3], "list of vertex indices"),
    "a tube": (families.cylinder(9, 5), [0, 1, 2, 3], "genus 0 and 2 boundaries; a rectangle needs a disk"),
    "closed": (families.cube(), [0, 1, 2, 3], "genus 0 and 0 boundaries; a rectangle needs a disk"),
}


@pytest.mark.parametrize("case", REFUSED)
def test_refusals(case):
    mesh, corners, message = REFUSED[case]
    with pytest.raises(TopologyError, match=message) as caught:
        rectangle_map(surface_of(mesh), corners)
    assert "\n" not in str(caught.value)


# ---- bounds as narrow as asked for -----------------------------------------------------------------------------------

EIGHT = 1e-8


def mean(a, b):
    """Gauss's arithmetic-geometric mean."""
    while abs(a - b) > 1e-15 * a:
        a, b = (a + b) / 2, np.sqrt(a * b)
    return a


def groetzsch_inverse(y):
    """r with K(r') / K(r) = 2 y / pi."""
    q, n = np.exp(-2 * y), np.arange(-60, 61)
    return (np.sum(q ** ((n + 0.5) ** 2)) / np.sum(q ** (n**2.0))) ** 2


def trapezoid_modulus(height):
    """That of the corners 1 + i height, i (height - 1), 0 and 1 (Burnside 1893; Hakula, Rasila & Vuorinen 2011)."""
    c = 2 * height - 1
    first, second = groetzsch_inverse(np.pi / (2 * c)), groetzsch_inverse(np.pi * c / 2)
    r = ((first - second) / (first + second)) ** 2
    return mean(1, r) / mean(1, np.sqrt((1 - r) * (1 + r)))


@pytest.mark.parametrize("height", [1.05, 1.1, 1.2, 1.35, 1.5, 1.75, 2, 2.5, 3, 4, 5, 6.5])
def test_trapezoids_to_eight_digits(height):
    """They are given as two triangles."""
    surface = Surface([(1, height, 0), (0, height - 1, 0), (0, 0, 0), (1, 0, 0)], [(0, 1, 2, 3)])
    found = rectangle_map(surface, [0, 1, 2, 3], bounds=EIGHT)
    low, high = found.modulus_bounds
    assert found.refinement.reached and high - low <= EIGHT * high
    assert low < trapezoid_modulus(height) < high and low < found.modulus < high
    turned = rectangle_map(surface, [1, 2, 3, 0], bounds=EIGHT).modulus_bounds
    assert turned[0] * low < 1 < turned[1] * high


def test_narrow_bounds_of_an_l_shape():
    """It is its own mirror image, which exchanges the sides."""
    corners = [(0, 0, 0), (2, 0, 0), (2, 1, 0), (1, 1, 0), (1, 2, 0), (0, 2, 0)]
    surface = Surface(corners, [(0, 1, 2, 3), (0, 3, 4, 5)])
    found = rectangle_map(surface, [0, 1, 3, 5], bounds=EIGHT)
    low, high = found.modulus_bounds
    assert low < 1 < high and high - low <= EIGHT
    uv = found.uv()
    assert uv.min() == 0 and uv[:, 0].max() == 1 and uv[:, 1].max() == pytest.approx(found.modulus, rel=1e-15)


def test_a_challenge_of_a_hundred_digits():
    """Brownian motion from the middle of a 10 x 1 rectangle leaves it at its ends with the probability 3.8376e-7
    (Bornemann, Laurie, Wagon & Waldvogel 2004, problem 10), by the modulus of the rectangle, here of many triangles."""
    x, y = np.meshgrid(np.linspace(0, 10, 21), np.linspace(0, 1, 4), indexing="ij")
    inside = (x > 0) & (x < 10) & (y > 0) & (y < 1)
    x, y = (z + inside * np.random.default_rng(k).uniform(-0.1, 0.1, z.shape) for k, z in enumerate((x, y)))
    corner = np.arange(84).reshape(21, 4)[:-1, :-1].ravel()
    faces = np.stack([corner, corner + 4, corner + 5, corner + 1], axis=1)
    surface = Surface(np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3), faces)
    found = rectangle_map(surface, [3, 0, 80, 83], bounds=EIGHT)
    low, high = (2 / np.pi * np.arcsin(groetzsch_inverse(np.pi / 2 * m)) for m in found.modulus_bounds)
    assert high < 3.837587979251226e-7 < low
    assert low - high < 1e-5 * low


@pytest.mark.parametrize(("height", "has_bounds"), [(1e-6, True), (1e-7, True), (1e-9, False)])
def test_a_square_with_a_flat_cap_has_bounds_that_are_told_or_none(height, has_bounds):
    vertices = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (0.5, height, 0)]
    surface = Surface(vertices, [(0, 1, 4), (1, 2, 4), (2, 3, 4), (3, 0, 4)])
    found = rectangle_map(surface, [0, 1, 2, 3], bounds=EIGHT)
    assert found.refinement.reached == has_bounds == (found.modulus_bounds is not None)
    if has_bounds:
        low, high = found.modulus_bounds
        assert low <= 1 <= high <= low + EIGHT
