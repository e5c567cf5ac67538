"""Equivalence of surfaces by their periods: verdicts on known lattices, on meshes, and on random pairs."""

import json

import families
import flat_cones
import numpy as np
import pytest
from curve_periods import curve_period_matrix
from equivalence import gram_of, omega_of, random_symplectic, symplectic_unit
from holomorph import (
    Cancelled,
    ProgressiveMesh,
    Surface,
    TopologyError,
    _native,
    conformal_structure,
    conformally_equivalent,
)
from holomorph.__main__ import main
from holomorph.forms.certificate import PeriodMatrix
from holomorph.moduli.equivalence import AGREEMENT, NEAR, VERDICTS
from known_matrices import BOLZA, BOLZA_AGAIN, LAWSON, SQUARES
from mesh_files import obj
from moebius_images import BLOCKS, moebius_image, twisted_block
from shared_data import complex_matrix, reference_values
from solved import surface_of

ROUNDING = 1e-9


def lattice(gram):
    return _native.PeriodLattice.closed(gram, symplectic_unit(len(gram) // 2))


def verdict(a, b):
    lattices = lattice(a), lattice(b)
    needed = AGREEMENT * np.sqrt(np.prod([each.radius() for each in lattices]))
    made = _native.compare(*lattices, allowed=0.0, needed=needed, progress=None)
    return made.verdict, made.isometry and made.isometry.matrix, made.sign, made.tolerance, made.margin


def assert_certificate(R, sign):
    J = symplectic_unit(len(R) // 2)
    assert (sign * J == R @ J @ R.T).all()


# ---- lattices that are known exactly ---------------------------------------------------------------------------


def decagon():
    return complex_matrix(reference_values()["genus2"]["decagon"])


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("omega", [BOLZA, LAWSON, SQUARES], ids=["Bolza", "Lawson", "squares"])
def test_another_basis_is_equivalent(omega, seed):
    S = random_symplectic(len(omega), seed)
    gram = gram_of(omega)
    name, R, sign, tolerance, _ = verdict(gram, S @ gram @ S.T)
    assert name == "indistinguishable" and tolerance < ROUNDING * np.abs(S @ gram @ S.T).max()
    assert_certificate(R, sign)
    assert np.abs(R @ gram @ R.T - S @ gram @ S.T).max() < ROUNDING * np.abs(S @ gram @ S.T).max()


def test_two_forms_of_bolza():
    assert verdict(gram_of(BOLZA), gram_of(BOLZA_AGAIN))[0] == "indistinguishable"


def test_known_curves_are_pairwise_different():
    curves = [BOLZA, LAWSON, SQUARES, decagon()]
    for i, a in enumerate(curves):
        for b in curves[:i]:
            name, R, _, tolerance, margin = verdict(gram_of(a), gram_of(b))
            assert name == "not_equivalent" and R is None and np.isinf(tolerance) and margin > 0.05


def test_mirror_image():
    skew = np.array([[0.3 + 1.2j]])
    name, R, sign, _, _ = verdict(gram_of(skew), gram_of(-skew.conj()))
    assert name == "mirror_image" and sign == -1
    assert_certificate(R, sign)


@pytest.mark.parametrize("bounds", [1e-6, 1e-3, 0.05])
def test_tori_beside_each_other(bounds):
    """Error bars of this half-width around tau and tau + small: what is said depends on their distance alone."""
    tau = 0.21 + 1.3j

    def said(distance):
        other = tau + 1j * tau.imag * np.expm1(distance)  # on a geodesic of the half-plane
        grams = [np.exp(bounds) * gram_of(np.array([[t]])) for t in (tau, other)]
        return verdict(*grams)

    assert said(0.2 * bounds)[0] == "indistinguishable"
    assert said(0.2 * bounds)[3] == pytest.approx(2.2 * bounds, rel=1e-3)
    assert said(0.3 * bounds)[0] == said(1.9 * bounds)[0] == "undecided"
    assert said(2.1 * bounds)[0] == "not_equivalent"
    assert said(4 * bounds)[4] == pytest.approx(2 * bounds, rel=1e-3)


def random_gram(g, random):
    root = random.normal(size=(g, g))
    real = random.uniform(-1, 1, (g, g))
    return gram_of((real + real.T) / 2 + 1j * (root @ root.T + 0.3 * np.eye(g)))


def moved(gram, distance, random):
    """A symplectic Gram matrix at this distance: by the flow of a random symmetric element of the Lie algebra."""
    g = len(gram) // 2
    a, b = (m + m.T for m in random.normal(size=(2, g, g)))
    flow = np.block([[a, b], [b, -a]])
    values, vectors = np.linalg.eigh(flow)
    half = vectors @ np.diag(np.exp(distance / 2 * values / np.abs(values).max())) @ vectors.T
    real, imaginary = omega_of(gram).real, omega_of(gram).imag
    root = np.linalg.cholesky(imaginary)
    frame = np.block([[np.eye(g), -real], [np.zeros((g, g)), np.eye(g)]]) @ np.block(
        [[root, np.zeros((g, g))], [np.zeros((g, g)), np.linalg.inv(root).T]]
    )
    assert np.abs(frame @ frame.T - gram).max() < 1e-6 * np.abs(gram).max()
    return frame @ half @ half.T @ frame.T


def distance_of(a, b):
    return np.abs(np.log(np.linalg.eigvals(np.linalg.solve(b, a)).real)).max()


def test_a_thousand_random_pairs():
    """Exact periods are near each other, or the same, in another basis; what is compared are estimates of them with
    error bars that hold. Never is a verdict wrong."""
    random = np.random.default_rng(7)
    said = dict.fromkeys(VERDICTS[1:], 0)
    for trial in range(1000):
        g = 1 + trial % 3
        apart = 0.0 if trial % 2 == 0 else 10 ** random.uniform(-3, 0)
        exact = random_gram(g, random)
        other = moved(exact, apart, random) if apart else exact
        S = random_symplectic(g, trial, steps=2)
        bars = 10 ** random.uniform(-4, -2) * random.uniform(0.5, 1, 2)
        estimates = [moved(m, random.uniform(0, 0.2) * bar, random) for m, bar in zip((exact, other), bars)]
        upper = [np.exp(bar) * estimate for bar, estimate in zip(bars, estimates)]
        name, R, sign, tolerance, margin = verdict(upper[0], S @ upper[1] @ S.T)
        said[name] += 1
        if name == "not_equivalent":
            assert apart > 0 and margin <= apart * (1 + 1e-6)
        elif name != "undecided":
            assert_certificate(R, sign)
            assert distance_of(R @ exact @ R.T, S @ other @ S.T) <= tolerance + 1e-6
    assert min(said["indistinguishable"], said["not_equivalent"]) > 200 and said["undecided"] < 500, said


# ---- meshes ----------------------------------------------------------------------------------------------------


def equivalent(a, b):
    made = conformally_equivalent(a, b)
    assert made.sentence.endswith(".") and made.sentence.lower().startswith(made.verdict.split("_")[0])
    return made


@pytest.mark.parametrize("g", sorted(BLOCKS))
def test_the_same_surface_is_equivalent(g):
    """Rotated, scaled and renumbered, which is proven; and cut finer, which is not."""
    mesh = twisted_block(g)
    structure = conformal_structure(surface_of(mesh))
    renumbered, _ = families.relabelled(families.moved(mesh, scale=1e3))
    made = equivalent(structure, surface_of(renumbered))
    assert made.verdict == "equivalent" and made.is_proven and made.residual < 1e-6 and made.tolerance < 1e-8
    made = equivalent(structure, surface_of(families.subdivided(mesh)))
    assert made.verdict == "indistinguishable" and not made.is_proven


@pytest.mark.parametrize("g", sorted(BLOCKS))
def test_mirror_image_of_a_mesh(g):
    mesh = twisted_block(g)
    made = equivalent(surface_of(mesh), surface_of(families.mirrored(mesh)))
    assert made.verdict == "mirror_image" and made.is_proven and made.residual < 1e-6


@pytest.mark.parametrize("g", sorted(BLOCKS))
def test_one_moved_vertex_leaves_no_proof(g):
    """Within the bounds, which a mesh of another surface may be, too."""
    mesh = twisted_block(g)
    vertices = mesh.vertices.copy()
    vertices[0] *= 1 + 1e-4
    made = equivalent(surface_of(mesh), surface_of(families.replace(mesh, vertices=vertices)))
    assert made.verdict in ("indistinguishable", "undecided") and not made.is_proven


@pytest.mark.parametrize(("change", "verdict"), [(0.02, "not_equivalent"), (1e-4, "indistinguishable")])
def test_tori_that_differ_by_little_are_not_called_equivalent(change, verdict):
    """Bounds are narrowed until they tell; triangles tell how near. Im tau is about 1 / sqrt(R^2 - 1)."""
    made = equivalent(*(surface_of(families.torus(32, 24, R=R)) for R in (1.5, 1.5 + change)))
    distance = 1.5 / (1.5**2 - 1) * change
    assert made.verdict == verdict and made.is_proven == (verdict == "not_equivalent")
    if made.is_proven:
        assert 0.1 * distance < made.margin < 2 * distance
        assert made.sentence.startswith("Not equivalent: every map stretches some direction at least 1.")
    else:
        assert made.residual == pytest.approx(distance, rel=0.5)
        assert made.residual < made.tolerance <= NEAR


def test_tori_that_their_lengths_tell_apart_are_not_called_equivalent():
    """Two triangles, whose lattice is tau to the last digit; lengths are exact to 2.5 units of it."""
    tau = 0.31 + 1.2j
    for distance in 10.0 ** -np.arange(6, 15):
        tori = [two_triangles(t) for t in (tau, tau + distance)]
        made = equivalent(*tori)
        assert made.verdict == ("not_equivalent" if distance > 2e-9 else "indistinguishable")
        assert made.is_proven or distance / 3 < made.tolerance < 2 * distance + 2e-14
        matrices = equivalent([[tau]], [[tau + distance]])
        assert matrices.verdict == ("not_equivalent" if distance > 2e-9 else "indistinguishable")
    assert equivalent(two_triangles(tau), two_triangles(tau)).verdict == "equivalent"
    assert equivalent([[tau]], [[tau]]).verdict == "equivalent"


def two_triangles(tau, scale=1.0):
    sides = np.array([[abs(1 - tau), abs(tau), 1]] * 2) * scale
    return Surface.from_edge_lengths(np.zeros((2, 3), int), sides, np.array([[0, 1, 2]] * 2))


@pytest.mark.parametrize("seed", range(10))
def test_no_verdict_of_near_pairs_is_wrong(seed):
    """A corner of a frame moved, lengths changed at random, a torus stretched; and each scaled, which is proven."""
    random = np.random.default_rng(seed)
    change = 10 ** random.uniform(-13.5, -6)
    frame = families.triangles_of(families.square_minus_square(2))
    moved = frame.vertices.copy()
    moved[random.integers(len(moved))] += change * np.append(random.choice([-1, 1], 2), 0)
    flat = flat_cones.regular_polygon(8 + 2 * (seed % 2))
    factors = 1 + change * random.uniform(-1, 1, flat.face_edges.max() + 1)
    other = flat.edge_lengths * factors[flat.face_edges]
    tau = complex(random.uniform(-0.5, 0.5), random.uniform(0.7, 2))
    pairs = [
        (surface_of(frame), surface_of(families.replace(frame, vertices=moved))),
        (surface_of(flat), Surface.from_edge_lengths(flat.faces, other, flat.face_edges)),
        (two_triangles(tau), two_triangles(tau + change)),
    ]
    assert all(equivalent(*pair).verdict in ("indistinguishable", "not_equivalent", "undecided") for pair in pairs)
    scale = random.uniform(0.1, 10)
    scaled = Surface.from_edge_lengths(flat.faces, flat.edge_lengths * scale, flat.face_edges)
    assert equivalent(surface_of(flat), scaled).verdict == "equivalent"
    assert equivalent(two_triangles(tau), two_triangles(tau, scale)).verdict == "equivalent"


@pytest.mark.parametrize("g", sorted(BLOCKS))
def test_different_meshes(g):
    mesh = twisted_block(g)
    made = equivalent(surface_of(mesh), surface_of(families.replace(mesh, vertices=mesh.vertices * [1, 1, 3])))
    assert made.verdict == "not_equivalent" and made.margin > 0


@pytest.mark.parametrize("g", [1, 2])
def test_moebius_image(g):
    """Other polyhedra than the block, near one smooth surface."""
    mesh = twisted_block(g)
    made = conformally_equivalent(surface_of(mesh), surface_of(moebius_image(mesh)), tolerance=0.01)
    assert made.verdict == "indistinguishable" and made.tolerance <= NEAR


@pytest.mark.parametrize(
    "name", ["kitten_19k.obj", "rockerArm_ngon.obj", "elephant_g3_50k.obj", "fertility_ngon_g4.obj"]
)
def test_real_meshes(meshes, name):
    """Against the Moebius image, half of the triangles, and the mirror image."""
    surface = Surface.read(meshes / name).components[0]
    structure = conformal_structure(surface)
    mesh = families.uniform(surface.vertices, surface.triangles, ((surface.genus, 0),))
    half = ProgressiveMesh(surface).level(len(surface.triangles) // 2)
    for other in (surface_of(moebius_image(mesh)), half):
        assert conformally_equivalent(structure, other, tolerance=0.01).verdict == "indistinguishable"
    made = equivalent(structure, surface_of(families.mirrored(mesh)))
    assert made.verdict == "mirror_image" and made.is_proven


def test_a_tolerance_takes_meshes_of_one_surface_for_one():
    coarse, fine = (surface_of(families.torus(n, n, R=1.5)) for n in (12, 48))
    assert conformally_equivalent(coarse, fine).verdict != "indistinguishable"
    assert conformally_equivalent(coarse, fine, tolerance=0.1).verdict == "indistinguishable"
    with pytest.raises(ValueError, match="tolerance is -1"):
        conformally_equivalent(coarse, fine, tolerance=-1)


# ---- with boundary ---------------------------------------------------------------------------------------------


def holed(loops, genus=0):
    mesh = families.triangles_of(families.block_with_holes(genus, refine=6, jitter=0.1))
    return families.punched(mesh, loops, seed=3)


@pytest.mark.parametrize(("genus", "loops"), [(0, 2), (0, 3), (0, 4), (1, 1), (1, 2), (2, 3)])
def test_surfaces_with_boundary(genus, loops):
    mesh = holed(loops, genus)
    structure = conformal_structure(surface_of(mesh))
    renumbered, _ = families.relabelled(families.moved(mesh))
    made = equivalent(structure, surface_of(renumbered))
    assert made.verdict == "equivalent" and made.residual < 1e-6
    stretched = families.replace(mesh, vertices=mesh.vertices * [1, 1, 4])
    assert equivalent(structure, surface_of(stretched)).verdict == "not_equivalent"


@pytest.mark.parametrize(("genus", "loops"), [(0, 4), (0, 5), (1, 2), (2, 1)])
def test_mirror_images_with_boundary(genus, loops):
    mesh = holed(loops, genus)
    assert equivalent(surface_of(mesh), surface_of(families.mirrored(mesh))).verdict == "mirror_image"


@pytest.mark.parametrize("loops", [2, 3])
def test_annuli_and_pairs_of_pants_are_their_mirror_images(loops):
    mesh = holed(loops)
    assert equivalent(surface_of(mesh), surface_of(families.mirrored(mesh))).verdict == "equivalent"


def test_annuli_by_their_modulus():
    tubes = [surface_of(families.cylinder(48, m)) for m in (12, 13)]
    made = equivalent(*tubes)
    moduli = [conformal_structure(tube).modulus for tube in tubes]
    assert made.verdict == "not_equivalent"
    assert 0 < made.margin <= np.log(moduli[1] / moduli[0]) + ROUNDING


# ---- what needs no search, and what is refused -----------------------------------------------------------------


def test_spheres_and_disks_are_equivalent():
    assert equivalent(surface_of(families.cube()), surface_of(families.tetrahedron())).residual == 0
    disks = [surface_of(families.flat_cells(np.ones(shape, bool), 1.0)) for shape in ((2, 3), (4, 4))]
    assert equivalent(*disks).verdict == "equivalent"


def test_different_topology_is_said():
    made = equivalent(surface_of(families.torus(8, 6)), surface_of(families.cylinder(8, 4)))
    assert made.verdict == "not_equivalent" and made.matrix is None
    assert made.sentence == "Not equivalent: genus 1 and 0 boundaries, and genus 0 and 2 boundaries."


def test_refusals():
    torus = surface_of(families.torus(8, 6))
    with pytest.raises(TopologyError, match="2 connected components"):
        conformally_equivalent(torus, surface_of(families.united(families.torus(8, 6), families.torus(8, 6))))
    with pytest.raises(TypeError, match="surfaces, structures or period matrices are compared, not str"):
        conformally_equivalent(torus, "kitten.obj")
    with pytest.raises(Cancelled):
        conformally_equivalent(torus, torus, progress=lambda fraction, stage: False)


def test_surfaces_without_positions_are_compared():
    tori = [surface_of(families.flat_torus(tau, 5, jitter=0.2)) for tau in (0.2 + 1.1j, 0.2 + 1.1001j)]
    assert equivalent(tori[0], tori[0]).verdict == "equivalent"
    made = equivalent(*tori)
    assert made.verdict == "not_equivalent"
    assert made.margin == pytest.approx(np.log(1.1001 / 1.1), rel=1e-3)


# ---- known curves ----------------------------------------------------------------------------------------------


def test_a_mesh_is_compared_with_a_known_curve():
    """The octagon with opposite sides glued is Bolza's, y^2 = x^5 - x; the decagon y^2 = x^5 - 1."""
    bolza, decagon = curve_period_matrix([1, 0, 0, 0, -1, 0]), curve_period_matrix([1, 0, 0, 0, 0, -1])
    octagon = surface_of(flat_cones.regular_polygon(8))
    assert equivalent(octagon, bolza).verdict == equivalent(bolza, octagon).verdict == "indistinguishable"
    assert equivalent(octagon, decagon).verdict == "not_equivalent"
    assert equivalent(surface_of(flat_cones.regular_polygon(10)), decagon).verdict == "indistinguishable"


@pytest.mark.parametrize("tau", [0.21 + 1.3j, -0.37 + 0.9j])
def test_a_torus_is_compared_with_its_lattice(tau):
    torus = surface_of(families.flat_torus(tau, 5, jitter=0.2))
    assert equivalent(torus, [[tau]]).verdict == "indistinguishable"
    assert equivalent(torus, [[tau / (1 - tau)]]).verdict == "indistinguishable"
    assert equivalent(torus, [[-tau.conjugate()]]).verdict == "mirror_image"
    assert equivalent(torus, [[tau + 1e-4j]]).verdict == "not_equivalent"


def test_a_curved_mesh_is_compared_with_its_smooth_surface():
    """Within 2 %, as a finer mesh of it; another torus is not. Each mesh is a surface of its own, too."""
    exact = [[1j / np.sqrt(1.5**2 - 1)]]
    for n in (32, 64):
        alone = equivalent(surface_of(families.torus(n, n, R=1.5)), exact)
        assert alone.verdict == "not_equivalent" and alone.margin < 0.02
        assert conformally_equivalent(surface_of(families.torus(n, n, R=1.5)), exact, tolerance=0.02).verdict == (
            "indistinguishable"
        )
    assert equivalent(surface_of(families.torus(32, 32, R=1.7)), exact).verdict == "not_equivalent"


def test_a_structure_has_its_own_period_matrix():
    structure = conformal_structure(surface_of(twisted_block(2)))
    made = equivalent(structure, PeriodMatrix.of(structure.period_matrix, structure.certificate.relative_width))
    assert made.verdict == "indistinguishable" and made.residual < structure.certificate.relative_width
    assert equivalent(structure.period_matrix, -structure.period_matrix.conj()).verdict == "mirror_image"


def test_a_period_matrix_of_another_genus():
    made = equivalent([[1j]], curve_period_matrix([1, 0, 0, 0, -1, 0]))
    assert made.sentence == "Not equivalent: genus 1 and 0 boundaries, and genus 2 and 0 boundaries."
    assert equivalent(surface_of(families.cylinder(8, 4)), [[1j]]).verdict == "not_equivalent"


@pytest.mark.parametrize(
    ("matrix", "reason"),
    [
        ([[1j, 0]], "square, symmetric and finite"),
        ([[1j, 0.5], [0.2, 1j]], "square, symmetric and finite"),
        ([[np.nan]], "square, symmetric and finite"),
        (np.zeros((0, 0)), "square, symmetric and finite"),
        (1j, "square, symmetric and finite"),
        ([[-1j]], "positive definite"),
        ([[0.3]], "positive definite"),
    ],
)
def test_wrong_matrices_are_refused(matrix, reason):
    with pytest.raises(ValueError, match=reason):
        conformally_equivalent(matrix, [[1j]])


@pytest.mark.parametrize("given", ["kitten.obj", [["a"]], [[1j], [1j, 2]], None, [[None]]])
def test_what_is_no_matrix_is_refused(given):
    with pytest.raises(TypeError, match="surfaces, structures or period matrices are compared, not"):
        conformally_equivalent([[1j]], given)


@pytest.mark.parametrize("distance", [2e-9, 5e-9, 1e-7])
def test_tori_that_are_not_the_same_are_not_proven_to_be(distance):
    """Within a quarter of errors as large as that of many a curve, but elsewhere in the half-plane."""
    tori = [PeriodMatrix.of([[1j * height]], 5 * distance) for height in (1.3, 1.3 * np.exp(distance))]
    made = equivalent(*tori)
    assert made.verdict == "indistinguishable" and not made.is_proven
    assert made.residual == pytest.approx(distance, rel=1e-3)
    assert made.tolerance == pytest.approx(11 * distance, rel=1e-3)


# ---- the command -----------------------------------------------------------------------------------------------


def write(folder, name, mesh):
    path = folder / name
    path.write_bytes(obj(mesh))
    return str(path)


def test_command_line(tmp_path, capsys):
    torus = write(tmp_path, "a.obj", twisted_block(1))
    mirrored = write(tmp_path, "b.obj", families.mirrored(twisted_block(1)))
    ball = write(tmp_path, "ball.obj", families.cube())
    assert main(["compare", torus, torus, "--report", str(tmp_path / "r.json")]) == 0
    assert capsys.readouterr().out.startswith("Equivalent: ")
    report = json.loads((tmp_path / "r.json").read_text())
    assert report["verdict"] == "equivalent" and len(report["matrix"]) == 2
    assert main(["compare", torus, mirrored]) == 3
    assert main(["compare", torus, ball]) == 4
    assert capsys.readouterr().out.splitlines()[1].startswith("Not equivalent: genus 1")


def test_command_line_refuses_in_one_sentence(tmp_path, capsys):
    torus = write(tmp_path, "a.obj", families.torus(8, 6))
    both = write(tmp_path, "two.obj", families.united(families.torus(8, 6), families.cube()))
    for wrong, code, reason in ((both, 1, "2 connected components"), (str(tmp_path / "none.obj"), 2, "none.obj")):
        assert main(["compare", torus, wrong]) == code
        said = capsys.readouterr()
        assert not said.out and said.err.startswith("holomorph: ") and reason in said.err and said.err.count("\n") == 1
