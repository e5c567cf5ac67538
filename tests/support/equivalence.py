"""How far two period matrices are apart up to the choice of canonical basis: for the tests' small genera."""

import numpy as np

# Gram products may differ by this much of the Gram matrix's largest entry: tried from the first on, so that the nearest
# equivalent matrix is found among few. Beyond the last, two matrices are not called equivalent at all.
TOLERANCES = (1e-9, 1e-6, 1e-3, 1e-2, 5e-2, 0.15)

# A vector is replaced if its length falls at least by this factor: far above rounding, so that the reduction ends.
WORTH_A_STEP = 1 - 1e-6


def symplectic_unit(g):
    """J = [[0, I], [-I, 0]]."""
    one, none = np.eye(g, dtype=int), np.zeros((g, g), dtype=int)
    return np.block([[none, one], [-one, none]])


def gram_of(omega):
    """The Gram matrix of the classes dual to the canonical basis: Im = (G_bb)^-1, Re = -G_ab (G_bb)^-1."""
    real, inverse = omega.real, np.linalg.inv(omega.imag)
    return np.block([[omega.imag + real @ inverse @ real, -real @ inverse], [-inverse @ real, inverse]])


def omega_of(gram):
    g = len(gram) // 2
    imaginary = np.linalg.inv(gram[g:, g:])
    return -gram[:g, g:] @ imaginary + 1j * imaginary


def reduced_basis(gram):
    """Integer rows, short in the quadratic form `gram`: each is shortened by the others until nothing changes."""
    basis = np.eye(len(gram), dtype=int)
    changed = True
    while changed:
        changed = False
        for i in range(len(basis)):
            products = basis @ gram @ basis.T
            steps = np.rint(products[i] / np.diag(products)).astype(int)
            steps[i] = 0
            j = np.argmax(np.abs(steps))
            shorter = basis[i] - steps[j] * basis[j]
            if shorter @ gram @ shorter < products[i, i] * WORTH_A_STEP:
                basis[i], changed = shorter, True
    return basis


def short_vectors(gram, bound):
    """All integer rows x != 0 with x gram x <= bound."""
    basis = reduced_basis(gram)
    reduced = basis @ gram @ basis.T
    most = np.floor(np.sqrt(bound * np.diag(np.linalg.inv(reduced)))).astype(int)
    box = np.indices(2 * most + 1).reshape(len(gram), -1).T - most
    length = np.einsum("ij,jk,ik->i", box, reduced, box, optimize=True)
    return box[(length <= bound) & box.any(axis=1)] @ basis


def isometries(gram, target, tolerance):
    """All integer R with R J R^T = J and |R gram R^T - target| <= tolerance: row by row among the short vectors."""
    n = len(gram)
    pairing = symplectic_unit(n // 2)
    vectors = short_vectors(gram, target.diagonal().max() + tolerance)
    length = np.einsum("ij,jk,ik->i", vectors, gram, vectors, optimize=True)

    def extended(rows):
        i = len(rows)
        if i == n:
            yield np.array(rows)
            return
        fits = np.abs(length - target[i, i]) <= tolerance
        for j, row in enumerate(rows):
            fits &= vectors @ pairing @ row == pairing[i, j]
            fits &= np.abs(vectors @ gram @ row - target[i, j]) <= tolerance
        for vector in vectors[fits]:
            yield from extended([*rows, vector])

    return extended([])


def max_norm(matrix):
    return np.abs(matrix).max()


def distance(omega, target, norm=max_norm):
    """Least norm of R.omega - target over Sp(2g, Z), infinite where nothing comes within the tolerances."""
    gram, goal = gram_of(omega), gram_of(target)
    for tolerance in TOLERANCES:
        found = [norm(omega_of(R @ gram @ R.T) - target) for R in isometries(gram, goal, tolerance * goal.max())]
        if found:
            return min(found)
    return np.inf


def distance_or_mirrored(omega, target, norm=max_norm):
    """The same over the matrix and its mirror image."""
    return min(distance(omega, target, norm), distance(-omega.conj(), target, norm))


def automorphism_count(omega):
    """Symplectic isometries of the Gram matrix onto itself; a hyperelliptic surface has as many automorphisms."""
    gram = gram_of(omega)
    return sum(1 for _ in isometries(gram, gram, TOLERANCES[0] * gram.max()))


def random_symplectic(g, seed, steps=6):
    """A product of elementary symplectic matrices, in integers."""
    random = np.random.default_rng(seed)
    result, one, none = np.eye(2 * g, dtype=int), np.eye(g, dtype=int), np.zeros((g, g), dtype=int)
    for _ in range(steps):
        shear = random.integers(-1, 2, (g, g))
        shear = np.triu(shear) + np.triu(shear, 1).T
        change = np.triu(random.integers(-1, 2, (g, g)), 1) + one
        inverse = np.rint(np.linalg.inv(change)).astype(int)
        for factor in (
            np.block([[one, shear], [none, one]]),
            np.block([[change, none], [none, inverse.T]]),
            symplectic_unit(g),
        ):
            result = result @ factor
    return result
