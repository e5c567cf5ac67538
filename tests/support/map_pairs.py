"""PYTHONPATH=build/lib/cp311 python tests/support/map_pairs.py [COUNT]: maps that many symmetric and that many random
pairs with boundary, and prints what fails and how the errors told compare with the true ones.

Pairs of meshes between which a conformal map is known to exist: annuli, square rings, pants, disks with holes, tori and
surfaces of genus 2 with holes; symmetric ones, which are their own mirror images, and random ones without symmetry."""

import sys
from dataclasses import dataclass

import families
import numpy as np
from holomorph import Error, _native, conformal_map, conformal_structure
from holomorph.forms.refined_triangles import areas
from solved import surface_of

TOLERANCE = 0.05  # of periods: the meshes of a pair are two discretisations of one surface


@dataclass(frozen=True)
class Pair:
    """order : index in `first` of each vertex of `second`, its true image; expected : the verdict with which it is the
    true one, "" where there are others too"""

    name: str
    first: families.Mesh
    second: families.Mesh
    order: np.ndarray
    expected: str = ""

    def structures(self):
        return tuple(conformal_structure(surface_of(mesh)) for mesh in (self.first, self.second))


# ---- shapes ----------------------------------------------------------------------------------------------------


def cells(*holes, size, per_cell=4, seed=0):
    """A flat rectangle of cells with square holes of one cell."""
    mask = np.ones((size[0] * per_cell, size[1] * per_cell), dtype=bool)
    for row, column in holes:
        mask[row * per_cell : (row + 1) * per_cell, column * per_cell : (column + 1) * per_cell] = False
    return families.triangles_of(families.flat_cells(mask, 1 / per_cell, jitter=0.2, seed=seed))


def round_ring(inner, seed=0):
    count = 24 + 2 * (seed % 5)
    radius = np.geomspace(inner, 1, 2 + int(count * -np.log(inner) / 2 / np.pi))
    return families.triangles_of(families.ring_of_revolution(radius, 0 * radius, count))


def holed_disk(fold, seed=0, rings=12, at=7):
    """A round disk with as many round-ish holes, `fold` = 2, 3 or 6, at equal angles."""
    points, faces = families.hexagonal_disk(rings, jitter=0.15, seed=seed)
    middle = points[faces].mean(axis=1) @ [1, 1j]
    centres = at / rings * np.exp(2j * np.pi * (np.arange(fold) / fold + 0.02))
    gone = np.flatnonzero((np.abs(middle[:, None] - centres) < 1.6 / rings).any(axis=1))
    mesh = families.uniform(np.column_stack([points, 0 * points[:, 0]]), faces)
    return families.without_faces(mesh, gone, ((0, fold + 1),))


def holed_torus(fold, n=24, m=16):
    """A torus of revolution with `fold` holes of one quad at equal angles."""
    mesh = families.torus(n, m, R=1.8)
    holes = [(n // fold) * k * m + m // 4 for k in range(fold)]
    return families.triangles_of(families.without_faces(mesh, holes, ((1, fold),)))


SYMMETRIC = {
    "tube": lambda seed: families.triangles_of(families.cylinder(20 + seed % 7, 5 + seed % 4)),
    "round ring": lambda seed: round_ring([0.2, 0.4, 0.6][seed % 3], seed),
    "square ring": lambda seed: cells((1, 1), size=(3, 3), seed=seed),
    "wide square ring": lambda seed: cells((2, 2), size=(5, 5), per_cell=3, seed=seed),
    "pants": lambda seed: cells((1, 1), (1, 3), size=(3, 5), seed=seed),
    "round pants": lambda seed: holed_disk(2, seed),
    "three round holes": lambda seed: holed_disk(3, seed),
    "six round holes": lambda seed: holed_disk(6, seed),
    "three holes": lambda seed: cells((1, 1), (1, 3), (3, 2), size=(5, 5), seed=seed),
    "four holes": lambda seed: cells((1, 1), (1, 3), (3, 1), (3, 3), size=(5, 5), seed=seed),
    "torus with 1 hole": lambda seed: holed_torus(1),
    "torus with 2 holes": lambda seed: holed_torus(2),
    "torus with 3 holes": lambda seed: holed_torus(3),
}
JITTERED = set(SYMMETRIC) - {"tube", "round ring", "torus with 1 hole", "torus with 2 holes", "torus with 3 holes"}
RANDOM = {
    "tube": lambda seed: families.triangles_of(families.cylinder(24, 9)),
    "ball with 2 holes": lambda seed: punched_block(0, 2, seed),
    "pants": lambda seed: punched_block(0, 3, seed),
    "ball with 5 holes": lambda seed: punched_block(0, 5, seed),
    "flat disk with 3 holes": lambda seed: random_disk(3, seed),
    "flat disk with 5 holes": lambda seed: random_disk(5, seed),
    "torus with 1 hole": lambda seed: punched_torus(1, seed),
    "torus with 3 holes": lambda seed: punched_torus(3, seed),
    "genus 2 with 1 hole": lambda seed: punched_block(2, 1, seed),
    "genus 2 with 4 holes": lambda seed: punched_block(2, 4, seed),
}
RIGID = set(RANDOM) - {"tube", "ball with 2 holes", "pants"}  # one map; the others have many, or twelve


def punched_block(genus, holes, seed):
    mesh = families.block_with_holes(genus, refine=6 if genus == 0 else 4, jitter=0.2, seed=seed)
    return families.triangles_of(families.punched(mesh, holes, seed=seed))


def punched_torus(holes, seed):
    return families.punched(families.torus(24, 18, shape="triangles", jitter=0.3, seed=seed), holes, seed=seed)


def random_disk(holes, seed):
    """Holes of one cell at random places inside."""
    places = np.random.default_rng(seed).permutation(9)[:holes]
    return cells(*(((1 + 2 * (k // 3)), 1 + 2 * (k % 3)) for k in places), size=(7, 7), per_cell=3, seed=seed)


# ---- images ----------------------------------------------------------------------------------------------------


def inverted(mesh, centre, side):
    """In a sphere around `centre`, in units of the mesh's size from its middle, and a reflection: keeps orientation."""
    low, high = mesh.vertices.min(axis=0), mesh.vertices.max(axis=0)
    away = mesh.vertices - (low + high) / 2 - centre * np.linalg.norm(high - low)
    turned = away / (away**2).sum(axis=1, keepdims=True)
    return families.replace(mesh, vertices=turned * np.where(np.arange(3) == side, -1, 1))


def bent(mesh, random):
    """A flat mesh under a one-to-one polynomial of the plane."""
    z = mesh.vertices @ [1, 1j, 0]
    z = z / np.abs(z).max()
    square, cube = 0.15 * np.exp(2j * np.pi * random.random(2))
    z = z + square * z**2 + cube * z**3
    return families.replace(mesh, vertices=np.column_stack([z.real, z.imag, 0 * z.real]))


def random_image(mesh, random):
    """(image, order): inversions, where flat a polynomial, and another numbering."""
    if np.ptp(mesh.vertices[:, 2]) == 0 and random.random() < 0.5:
        mesh = bent(mesh, random)
    for _ in range(random.integers(1, 3)):
        direction = random.normal(size=3)
        mesh = inverted(mesh, random.uniform(0.9, 2) * direction / np.linalg.norm(direction), random.integers(3))
    mesh = families.moved(mesh, scale=10 ** random.uniform(-3, 3), seed=int(random.integers(1000)))
    return families.relabelled(mesh, seed=int(random.integers(1000)))


def without_symmetry(mesh, random):
    """Twisted at random."""
    x, y, z = mesh.vertices.T / np.ptp(mesh.vertices)
    a, b, c, d = random.uniform(0.1, 0.35, 4) * random.choice([-1, 1], 4)
    flat = np.ptp(mesh.vertices[:, 2]) == 0
    moved = [x + d * y * y, y + a * x * (y if flat else z), z + b * x * y + c * x**2]
    return families.replace(mesh, vertices=np.stack(moved, axis=1))


# ---- pairs -----------------------------------------------------------------------------------------------------


def symmetric_pair(number):
    """Mirrored, seen from elsewhere, under a conformal map, or another mesh of the same surface."""
    name = list(SYMMETRIC)[number % len(SYMMETRIC)]
    kind, random = number // len(SYMMETRIC) % 4, np.random.default_rng(number)
    mesh = SYMMETRIC[name](number)
    if kind == 0:
        return Pair(f"{name}, mirrored", mesh, *families.relabelled(families.mirrored(mesh), seed=number))
    if kind == 1:
        return Pair(f"{name}, moved", mesh, *families.relabelled(families.moved(mesh), seed=number))
    if kind == 3 and name in JITTERED:
        return Pair(f"{name}, another mesh", mesh, SYMMETRIC[name](number + 60), np.arange(len(mesh.vertices)))
    return Pair(f"{name}, image", mesh, *random_image(mesh, random))


def random_pair(number):
    """A surface without symmetry and its image, every fourth mirrored."""
    name = list(RANDOM)[number % len(RANDOM)]
    random = np.random.default_rng(1000 + number)
    mesh = without_symmetry(RANDOM[name](number), random)
    image, order = random_image(mesh, random)
    is_mirrored = number % 4 == 3
    expected = ("mirror_image" if is_mirrored else "indistinguishable") if name in RIGID else ""
    if is_mirrored:
        return Pair(f"{name}, mirrored image", mesh, families.mirrored(image), order, expected)
    return Pair(f"{name}, image", mesh, image, order, expected)


# ---- what is measured ------------------------------------------------------------------------------------------


@dataclass(frozen=True)
class Measured:
    """verdict, residual : of the map; kept : part of the first surface's area whose image in space keeps the
    orientation; folded : part that the map tells to be folded; error : true one in the units of the residual, NaN where
    it is not known"""

    verdict: str
    kept: float
    folded: float
    residual: float
    error: float


def measured(pair):
    a, b = pair.structures()
    found = conformal_map(a, b, tolerance=TOLERANCE)
    sign = -1 if found.equivalence.verdict == "mirror_image" else 1
    share = areas(a._triangulation.edge_lengths[a._triangulation.triangle_edges])
    share /= share.sum()
    is_kept = sign * signed_areas(found, a, b) >= 0
    error = true_error(found, a, b, pair.order) if pair.expected == found.equivalence.verdict else np.nan
    return Measured(found.equivalence.verdict, share[is_kept].sum(), share[found.folded].sum(), found.residual, error)


def signed_areas(found, a, b):
    """(#T,) of the images in space of the first surface's triangles, seen from the side that the second faces to."""
    images = found.of(b.surface.vertices)[a.surface.triangles]
    normals = np.cross(images[:, 1] - images[:, 0], images[:, 2] - images[:, 0]) / 2
    there = b._of_surface(b._triangulation.triangles)[found.triangles[a.surface.triangles[:, 0]]]
    sides = b.surface.vertices[there]
    facing = np.cross(sides[:, 1] - sides[:, 0], sides[:, 2] - sides[:, 0])
    return (normals * facing).sum(axis=1) / np.linalg.norm(facing, axis=1)


def true_error(found, a, b, order):
    """Root mean square distance of the images from the true ones, by how much integrals of the forms change on it."""
    density = np.sqrt((form_slopes(b) ** 2).sum(axis=(1, 2)) / 2)[found.triangles]
    true = np.empty_like(b.surface.vertices)
    true[order] = b.surface.vertices
    distance = np.linalg.norm(found.of(b.surface.vertices) - true, axis=1)
    return float(np.sqrt(np.mean((distance * density) ** 2)))


def form_slopes(structure):
    """(#T, 2n, 2) of the Dirichlet forms and their conjugates, in a basis of orthonormal ones."""
    whiten = np.linalg.inv(np.linalg.cholesky(structure.projected_gram_matrices[1]))
    conjugates = -np.linalg.solve(structure.star, structure.natural_forms)
    forms = np.concatenate([whiten @ structure.dirichlet_forms, whiten @ conjugates])
    return _native.form_slopes(structure._triangulation, np.ascontiguousarray(forms))


def main(count):
    for make in (symmetric_pair, random_pair):
        kept, folded, ratios = [], [], []
        for number in range(count):
            pair = make(number)
            try:
                found = measured(pair)
            except Error as error:
                print(f"{number} {pair.name}: {error}", flush=True)
                continue
            kept.append(found.kept)
            folded.append(found.folded)
            ratios.append(found.error / found.residual)
            print(f"{number} {pair.name}: {found}", flush=True)
        text = f"{len(kept)} of {count} mapped, {np.count_nonzero(np.array(kept) < 0.5)} mirrored"
        print(f"{make.__name__}: {text}, at most {max(folded):.2%} of the area folded")
        known = np.sort(np.array(ratios)[np.isfinite(ratios)])
        if len(known):
            print(f"true errors over residuals: {known[0]:.2g} to {known[-1]:.2g}, median {np.median(known):.2g}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 200)
