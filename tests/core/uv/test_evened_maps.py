"""Evening of any map: jumps and kept rows stay (exact), squares become more equal."""

import families
import numpy as np
import pytest
from evened_disks import bumpy_disk, jumps, rim
from holomorph import Cancelled, Surface, _native, conformal_structure, free_boundary_map, rectangle_map
from holomorph.quality.quality import Quality
from measured import quantiles
from solved import CLOSED, surface_of

EXACT = 1e-12


def flat_disk():
    points, faces = families.hexagonal_disk(9, jitter=0.25)
    return Surface(np.column_stack([points, 0 * points[:, 0]]), faces)


def of_disk(surface):
    return surface._native, free_boundary_map(surface).uv()


def of_structure(mesh):
    structure = conformal_structure(surface_of(mesh))
    return structure._triangulation, structure.uv(structure.balanced_coefficients())


MAPS = {
    "bumpy disk": lambda: of_disk(bumpy_disk()),
    "hemisphere": lambda: of_disk(surface_of(families.hemisphere(10, jitter=0.2))),
    "cut torus": lambda: of_structure(CLOSED["torus of triangles"]),
    "cut torus of quads": lambda: of_structure(CLOSED["torus of quads"]),
    "cut genus 2": lambda: of_structure(families.block_with_holes(2, refine=3, jitter=0.2)),
    "cut punctured torus": lambda: of_structure(families.punctured_torus(24, 18)),
}
made = {}
everywhere = pytest.mark.parametrize("name", MAPS)


def case(name):
    if name not in made:
        made[name] = MAPS[name]()
    return made[name]


def evened(native, uv, evenness, poles=(), u=(), v=(), **options):
    """(#C, 2) UVs of these, to which a function on the vertices is added; options are the core's."""
    kept = {name: np.unique(np.asarray(at, int)).tolist() for name, at in (("poles", poles), ("u", u), ("v", v))}
    options = {"solver": "auto", "threads": 2, "progress": None} | options
    return uv + _native.evened(native, uv, evenness=evenness, **kept, **options)[native.corner_vertices]


def ratio(native, uv):
    return Quality.of(native, uv, 1).density_ratio


@everywhere
def test_squares_become_more_equal(name):
    native, uv = case(name)
    ratios = [ratio(native, evened(native, uv, evenness)) for evenness in (0, 0.5, 1)]
    assert ratios[1] < 0.9 * ratios[0]
    assert ratios[2] < 0.95 * ratios[1]


@everywhere
def test_jumps_stay(name):
    native, uv = case(name)
    even = evened(native, uv, 0.8)
    assert np.abs(jumps(native, even) - jumps(native, uv)).max() < EXACT * np.abs(uv).max()
    assert np.array_equal(evened(native, uv, 0), uv)


@everywhere
def test_no_more_area_is_flipped(name):
    native, uv = case(name)
    parts = [Quality.of(native, evened(native, uv, evenness), 1).flipped_part for evenness in (0, 0.5, 1)]
    assert max(parts) <= parts[0]


@pytest.mark.parametrize(
    ("power", "jitter", "seed", "evenness"),
    [(2, jitter, seed, evenness) for jitter in (0.2, 0.4) for seed in range(3) for evenness in (0.25, 0.5, 1)]
    + [(3, 0.2, 2, 1), (4, 0.4, 1, 0.5)]  # these need triangles that keep their shape
    + [(3, 0.2, 1, 1), (4, 0.2, 0, 0.5), (4, 0.4, 18, 1)],  # and these that size counts less
)
def test_no_more_area_is_flipped_where_a_map_branches(power, jitter, seed, evenness):
    """Powers of z from a point that is not a vertex: where it is 0, they flip triangles."""
    points, faces = families.hexagonal_disk(30, jitter=jitter, seed=seed)
    native = Surface(np.pad(points, ((0, 0), (0, 1))), faces)._native
    middle = np.random.default_rng(seed).normal(size=2) * 0.2
    w = ((points - middle) @ [1, 1j]) ** power
    uv = np.stack([w.real, w.imag], axis=1)[native.corner_vertices]
    even = evened(native, uv, evenness)
    assert Quality.of(native, even, 1).flipped_part <= Quality.of(native, uv, 1).flipped_part
    assert ratio(native, even) < ratio(native, uv)
    assert np.array_equal(even, evened(native, uv, evenness, threads=3))


@pytest.mark.parametrize("seed", range(3))
def test_squares_around_a_branch_point_are_evened_most(seed):
    """z^2: by the square of their size alone, 99:1 stays more than 1.4 times 95:5 in logarithms."""
    points, faces = families.hexagonal_disk(30, jitter=0.1, seed=seed)
    native = Surface(np.pad(points, ((0, 0), (0, 1))), faces)._native
    w = ((points - [0.013, 0.017]) @ [1, 1j]) ** 2
    uv = np.stack([w.real, w.imag], axis=1)[native.corner_vertices]
    quality = Quality.of(native, evened(native, uv, 0.5), 1)
    low, few, most, high = np.log(quantiles(quality.area, quality.weights, (0.01, 0.05, 0.95, 0.99)))
    assert high - low < 1.385 * (most - few)


@pytest.mark.parametrize("seed", range(2))
@pytest.mark.parametrize("jitter", [0.5, 0.6])
def test_no_more_area_is_flipped_where_triangles_are_thin(jitter, seed):
    native, uv = of_structure(families.torus(140, 72, shape="triangles", jitter=jitter, seed=seed))
    parts = [Quality.of(native, evened(native, uv, evenness), 1).flipped_part for evenness in (0, 0.25, 0.5, 0.75, 1)]
    assert parts[0] > 0
    assert max(parts) == parts[0]


def test_few_thin_triangles_do_not_shorten_the_steps_of_all():
    """As many operations as on a mesh without."""

    def operations(jitter):
        native, uv = of_structure(families.torus(140, 72, shape="triangles", jitter=jitter))
        before = _native.work()
        evened(native, uv, 0.5)
        return _native.work() - before

    assert operations(0.6) < 1.3 * operations(0.3)


@pytest.mark.parametrize("evenness", [0.1, 0.5, 1])
def test_an_even_map_stays(evenness):
    native = flat_disk()._native
    uv = native.vertices[native.corner_vertices][:, :2] @ [[0.6, 0.8], [-0.8, 0.6]] * 3
    assert np.abs(evened(native, uv, evenness) - uv).max() < EXACT


@pytest.mark.parametrize("solver", ["direct", "multigrid"])
@pytest.mark.parametrize("kept", [("u",), ("v",), ("u", "v")])
def test_what_is_kept_stays_bit_for_bit(kept, solver):
    """Also where the two sets differ, as on a rectangle."""
    native, uv = of_disk(bumpy_disk())
    at = {name: rim(native)[i::3] for i, name in enumerate(kept)}
    even = evened(native, uv, 0.5, **at, solver=solver)
    for column, name in enumerate("uv"):
        same = np.isin(native.corner_vertices, at.get(name, []))
        assert np.array_equal(even[same, column], uv[same, column])
        assert np.abs(even - uv)[~same, column].max() > 1e-3
    assert ratio(native, even) < ratio(native, uv)


def test_the_sides_of_a_rectangle_stay():
    made = rectangle_map(bumpy_disk())
    native, uv = made._triangulation, made.uv()
    points = np.full((native.vertex_count, 2), np.nan)
    points[native.corner_vertices] = uv
    low, high = points.min(axis=0), points.max(axis=0)
    u, v = (np.flatnonzero((points[:, k] == low[k]) | (points[:, k] == high[k])) for k in range(2))
    even = evened(native, uv, 0.6, u=u, v=v)
    assert even[np.isin(native.corner_vertices, u), 0].tolist() == uv[np.isin(native.corner_vertices, u), 0].tolist()
    assert even[np.isin(native.corner_vertices, v), 1].tolist() == uv[np.isin(native.corner_vertices, v), 1].tolist()
    assert ratio(native, even) < ratio(native, uv)


def test_all_vertices_kept():
    native, uv = case("bumpy disk")
    everything = np.arange(native.vertex_count)
    assert np.array_equal(evened(native, uv, 1, u=everything, v=everything), uv)
    even = evened(native, uv, 1, u=everything)
    assert np.array_equal(even[:, 0], uv[:, 0])


@everywhere
def test_same_bits_at_any_number_of_threads(name):
    native, uv = case(name)
    first, *others = (evened(native, uv, 0.7, threads=threads) for threads in (1, 2, 3))
    assert all(np.array_equal(first, other) for other in others)


@pytest.mark.parametrize("scale", [1e-200, 1e-150, 1e-30, 1e30, 1e150, 1e200])
def test_any_scale_is_taken(scale):
    """Where squares of lengths leave the range of numbers the map may stay what it is."""
    native, uv = case("hemisphere")
    even = evened(native, uv * scale, 0.5)
    assert np.isfinite(even).all()
    if 1e-100 < scale < 1e100:
        assert np.allclose(even, evened(native, uv, 0.5) * scale, rtol=1e-6, atol=1e-6 * scale)


@pytest.mark.parametrize("uv", ["zero", "line", "noise"])
def test_a_map_that_is_none_is_finite(uv):
    native, given = case("bumpy disk")
    noise = np.random.default_rng(1).normal(size=given.shape)
    values = {"zero": 0 * given, "line": given[:, :1] * [1.0, 0.0], "noise": noise}[uv]
    even = evened(native, values, 0.5)
    assert np.isfinite(even).all()
    assert np.array_equal(even, values) or uv != "zero"


def test_cancelled():
    native, uv = case("cut torus")
    stages = []

    def stop(fraction, stage):
        stages.append((fraction, stage))
        return False

    with pytest.raises(Cancelled):
        evened(native, uv, 0.5, progress=stop)
    assert stages[0][1] == "evening"
