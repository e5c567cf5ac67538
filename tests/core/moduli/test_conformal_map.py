"""The conformal map between equivalent surfaces: where it is known, and its angles."""

import sys
from functools import cache

import families
import numpy as np
import pytest
from holomorph import (
    Cancelled,
    SolverError,
    Surface,
    TopologyError,
    _native,
    conformal_map,
    conformal_structure,
    log_map,
)
from moebius_images import moebius_image, twisted_block
from shared_data import shared_folder
from solved import BOUNDED, surface_of


def edge_length(mesh):
    corners = mesh.vertices[mesh.corners.reshape(-1, 3)]
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2).mean()


def structures(*meshes):
    return [conformal_structure(surface_of(mesh)) for mesh in meshes]


@cache
def mapped(genus, image=moebius_image):
    """A mesh without symmetry, so that the map is the only one: both structures and the map."""
    mesh = twisted_block(genus)
    both = structures(mesh, image(mesh))
    return *both, conformal_map(*both)


@pytest.mark.parametrize("image", [moebius_image, families.moved, families.mirrored, families.subdivided])
def test_vertices_are_found_again(image):
    a, b, found = mapped(3, image)
    mesh, others = twisted_block(3), b.surface.vertices
    distance = np.linalg.norm(found.of(others) - others[: len(mesh.vertices)], axis=1)
    assert np.median(distance) < 0.25 * edge_length(mesh) * np.ptp(others) / np.ptp(mesh.vertices)
    assert found.residual < 0.03


def test_thin_arms_do_not_mislead():
    """On them wrong starts fit as well as right ones, and a vertex may be caught on the wrong side of one."""
    surface = Surface.read(shared_folder("meshes") / "fertility_ngon_g4.obj")
    mesh = families.uniform(surface.vertices, surface.triangles)
    other = moebius_image(mesh)
    found = conformal_map(*structures(mesh, other), tolerance=0.02)
    distance = np.linalg.norm(found.of(other.vertices) - other.vertices, axis=1)
    assert distance.max() < 3e-3 * np.ptp(other.vertices)
    assert found.residual < 1e-3


def test_tori_are_mapped_with_their_angles():
    """Many maps are conformal; whichever is found has little distortion."""
    mesh = families.torus(48, 32, R=1.5, shape="triangles", jitter=0.2)
    other = families.moved(families.torus(64, 24, R=1.5, shape="triangles", jitter=0.2, seed=5))
    found = conformal_map(*structures(mesh, other), tolerance=0.02)
    faces = mesh.corners.reshape(-1, 3)
    images = found.of(other.vertices)
    first, second = (frames(points[faces]) for points in (mesh.vertices, images))
    values = np.linalg.svd(second @ np.linalg.inv(first), compute_uv=False)
    assert np.median(values[:, 0] / values[:, 1]) < 1.2  # both meshes interpolate


# ---- with boundary ---------------------------------------------------------------------------------------------

RIGID = [
    "punctured torus",
    "torus of triangles with 3 holes",
    "ball with 5 holes",
    "genus 2 with 1 hole",
    "genus 2 with 5 holes",
]


def twisted(mesh):
    """Without symmetry: only one map is conformal."""
    mesh = mesh if np.ptp(np.diff(mesh.offsets)) == 0 and mesh.offsets[1] == 3 else families.triangles_of(mesh)
    x, y, z = mesh.vertices.T / np.ptp(mesh.vertices)
    return families.replace(mesh, vertices=np.stack([x, y + 0.3 * x * z, z + 0.15 * x * y + 0.05 * x**2], axis=1))


@pytest.mark.parametrize("image", [moebius_image, families.moved, families.mirrored])
@pytest.mark.parametrize("name", RIGID)
def test_bounded_surfaces(name, image):
    mesh = twisted(BOUNDED[name])
    other = image(mesh)
    found = conformal_map(*structures(mesh, other))
    distance = np.linalg.norm(found.of(other.vertices) - other.vertices, axis=1)
    assert distance.max() < 0.01 * np.ptp(other.vertices)
    expected = {families.mirrored: "mirror_image", moebius_image: "indistinguishable"}
    assert found.equivalence.verdict == expected.get(image, "equivalent")


def test_pants_are_mapped_loop_onto_loop():
    """They have twelve conformal maps to themselves, and the last bits decide which is found first: whichever it is, it
    keeps angles and harmonic measures."""
    mesh = twisted(families.punched(families.block_with_holes(0, refine=6, jitter=0.2), 3, seed=2))
    a, b = structures(mesh, moebius_image(mesh))
    found = conformal_map(a, b)
    expected = potentials(a) @ found.equivalence.matrix.T
    images = found.of(potentials(b))
    errors = min((images - sign * expected for sign in (1, -1)), key=lambda each: np.ptp(each, axis=0).max())
    assert np.ptp(errors, axis=0).max() < 0.01
    assert np.std(errors, axis=0).max() < 0.002
    assert np.median(angles(found, a, b)) < 1.2


def angles(found, a, b):
    """(#T,) s1/s2 of the map in each triangle."""
    faces = a.surface.triangles
    first, second = (frames(points[faces]) for points in (a.surface.vertices, found.of(b.surface.vertices)))
    values = np.linalg.svd(second @ np.linalg.inv(first), compute_uv=False)
    return values[:, 0] / values[:, 1]


def potentials(structure):
    """(#V, b - 1) harmonic functions whose differentials are the Dirichlet forms of a planar surface, 0 on loop 0."""
    edges, count = structure.edges, len(structure.surface.vertices)
    incidence = np.zeros((len(edges), count))
    incidence[np.arange(len(edges)), edges[:, 0]] = -1
    incidence[np.arange(len(edges)), edges[:, 1]] = 1
    values = np.linalg.lstsq(incidence, structure.dirichlet_forms.T, rcond=None)[0]
    return values - values[structure.boundary_loops[0]].mean(axis=0)


@pytest.mark.parametrize("name", ["tube", "ball with 2 holes"])
def test_annuli_are_mapped_at_their_heights(name):
    """Turned by any angle."""
    mesh = twisted(BOUNDED[name])
    a, b = structures(mesh, moebius_image(mesh))
    found = conformal_map(a, b)
    heights = [potentials(structure)[:, 0] for structure in (a, b)]
    images = found.of(heights[1])
    assert min(np.abs(images - heights[0]).max(), np.abs(images - (1 - heights[0])).max()) < 0.01


# ---- textures --------------------------------------------------------------------------------------------------


def integer_map(structure):
    """UVs whose seams jump by integers."""
    n, m = np.zeros((2, len(structure.harmonic_forms)))
    n[0] = m[1] = 1
    return structure.uv_of(n, m)


@pytest.mark.parametrize("image", [moebius_image, families.mirrored])
def test_a_texture_goes_on_across_the_cuts(image):
    """Modulo integers every corner has the UV of its vertex, and faces are whole, whichever are cut."""
    a, b, found = mapped(3, image)
    uv = integer_map(b)
    carried = found.uv(uv)
    at_vertices = np.empty((len(b.surface.vertices), 2))
    at_vertices[b.surface.corner_vertices] = uv
    expected = at_vertices[a.surface.corner_vertices]
    assert np.abs(carried - expected - np.round(carried - expected)).max() < 0.01
    sides = np.abs(np.diff(carried.reshape(-1, 3, 2), axis=1)).max()
    assert sides < 1.1 * np.abs(np.diff(uv.reshape(-1, 3, 2), axis=1)).max()


def test_islands_are_carried_to_islands():
    """A chart breaks off where it does on the other surface: each triangle has the chart of its own image."""
    a, b, found = mapped(3)
    random = np.random.default_rng(3)
    rows = b.surface.vertices[b.surface.triangles]
    flat = np.stack([frames(rows)[:, :, i] for i in range(2)], axis=1)
    turns = np.exp(2j * np.pi * random.random(len(flat)))[:, None]
    corner = np.concatenate([np.zeros((len(flat), 1)), flat[..., 0] + 1j * flat[..., 1]], axis=1) * turns
    islands = (corner + 100 * np.arange(len(flat))[:, None]).reshape(-1, 1)
    uv = np.concatenate([islands.real, islands.imag], axis=1)
    carried = found.uv(uv)
    size = np.abs(corner).max()
    is_own = np.abs(carried - uv).max(axis=1) < size
    assert is_own.mean() > 0.9
    assert (is_own.reshape(-1, 3).all(axis=1) == is_own.reshape(-1, 3).any(axis=1)).all()


def test_polygons_are_carried_whole():
    """A coarse cut of the same surface into quads, from the triangles of a finer one."""
    quads = families.torus(48, 32, R=1.5)
    a, b = structures(quads, families.subdivided(families.torus(48, 32, R=1.5, shape="triangles")))
    carried = conformal_map(a, b, tolerance=0.05).uv(integer_map(b)).reshape(-1, 4, 2)
    around = np.roll(carried, -1, axis=1) - carried
    assert np.abs(around).max() < 0.1
    areas = (carried[:, 2] - carried[:, 0])[:, [1, 0]] * (carried[:, 3] - carried[:, 1])
    signed = areas[:, 1] - areas[:, 0]
    assert (np.sign(signed) == np.sign(signed[0])).all()
    assert np.abs(signed).sum() / 2 == pytest.approx(1, rel=0.01)


def test_uvs_that_do_not_fit():
    _, b, found = mapped(3)
    with pytest.raises(ValueError, match=r"uv has the shape \(3, 2\)"):
        found.uv(np.zeros((3, 2)))
    with pytest.raises(ValueError, match="finite numbers"):
        found.uv(np.full((len(b.surface.corner_vertices), 2), np.nan))


# ---- progress --------------------------------------------------------------------------------------------------


def test_progress_does_not_stop():
    """Also where many vertices have to be freed: on the wrong side of thin arms."""
    surface = Surface.read(shared_folder("meshes") / "fertility_ngon_g4.obj")
    mesh = families.uniform(surface.vertices, surface.triangles)
    a, b = structures(mesh, moebius_image(mesh))
    integer = integer_map(b)  # solves for what UVs are made of
    calls = []

    def progress(fraction, stage):
        calls.append((fraction, stage))
        return True

    found = conformal_map(a, b, tolerance=0.02, progress=progress)
    fractions = np.array([fraction for fraction, _ in calls])
    assert (np.diff(fractions) >= 0).all() and fractions[-1] > 0.9
    assert {"following the forms", "freeing stuck points"} <= {stage for _, stage in calls}
    found.uv(integer, progress=progress)


@pytest.mark.parametrize("stage", ["following the forms", "freeing stuck points"])
def test_it_is_cancelled_in_each_stage(stage):
    (structure,) = structures(families.torus(30, 25, shape="triangles"))
    surface, forms = structure._triangulation, np.ascontiguousarray(structure.harmonic_forms)
    continuation = _native.Continuation(surface, forms, surface, forms)
    with pytest.raises(Cancelled, match=f"during {stage}"):
        continuation.run(0, 0, np.zeros(2), 750, lambda fraction, name: name != stage)


@pytest.mark.parametrize("share", [0.1, 0.21, 0.32, 0.5])
def test_it_is_cancelled(share):
    a, b, _ = mapped(3)
    calls = []
    with pytest.raises(Cancelled):
        conformal_map(a, b, progress=lambda fraction, stage: calls.append(fraction) or fraction < share)
    assert calls[-1] >= share and sum(fraction >= share for fraction in calls) == 1


def frames(corners):
    """(#T, 2, 2) sides 1 and 2 of triangles in their own planes."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    x = a / np.linalg.norm(a, axis=1, keepdims=True)
    along = (b * x).sum(axis=1)
    height = np.linalg.norm(b - along[:, None] * x, axis=1)
    zero = np.zeros(len(a))
    return np.moveaxis(np.array([[np.linalg.norm(a, axis=1), along], [zero, height]]), 2, 0)


def test_a_map_that_does_not_fit_is_refused(monkeypatch):
    monkeypatch.setattr(sys.modules["holomorph.moduli.conformal_map"], "MOST_RESIDUAL", 0.0)
    with pytest.raises(SolverError, match="no map was found"):
        conformal_map(*mapped(3)[:2])


def test_refusals():
    torus, other = structures(families.torus(12, 8), families.torus(12, 8, R=3.0))
    with pytest.raises(TopologyError, match="no map can be made; Not equivalent"):
        conformal_map(torus, other)
    with pytest.raises(TypeError, match="not a PoleStructure"):
        conformal_map(torus, log_map(surface_of(families.geodesic_sphere(2))))
    with pytest.raises(TopologyError, match="genus 1 and 0 boundaries, and genus 0 and 2"):
        conformal_map(torus, *structures(families.cylinder(8, 4)))
