"""The tests' own measure of equivalence, on matrices that are known."""

import numpy as np
import pytest
from equivalence import (
    automorphism_count,
    distance,
    distance_or_mirrored,
    gram_of,
    omega_of,
    random_symplectic,
    symplectic_unit,
)
from known_matrices import BOLZA, BOLZA_AGAIN, LAWSON, SQUARES

ROUNDING = 1e-9  # entries below 10, after integer matrices with entries below 10^3 on both sides

MATRICES = {
    "square torus": np.array([[1j]]),
    "skew torus": np.array([[0.3 + 1.2j]]),
    "Bolza": BOLZA,
    "Lawson": LAWSON,
    "three squares": SQUARES,
}


@pytest.mark.parametrize("name", MATRICES)
def test_gram_matrix_and_back(name):
    omega = MATRICES[name]
    gram, J = gram_of(omega), symplectic_unit(len(omega))
    assert np.abs(omega_of(gram) - omega).max() < ROUNDING
    assert np.abs(gram @ J @ gram - J).max() < ROUNDING


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.parametrize("name", MATRICES)
def test_another_canonical_basis_is_recognised(name, seed):
    omega = MATRICES[name]
    g = len(omega)
    R = random_symplectic(g, seed)
    assert (R @ symplectic_unit(g) @ R.T == symplectic_unit(g)).all()
    changed = omega_of(R @ gram_of(omega) @ R.T)
    assert distance(changed, omega) < ROUNDING


def test_two_forms_of_one_matrix():
    assert distance_or_mirrored(BOLZA, BOLZA_AGAIN) < ROUNDING


def test_different_surfaces_are_apart():
    assert distance_or_mirrored(BOLZA, LAWSON) > 0.05
    assert distance_or_mirrored(LAWSON, SQUARES) > 0.05


def test_mirror_image():
    skew = MATRICES["skew torus"]
    assert distance(-skew.conj(), skew) > 0.05
    assert distance_or_mirrored(-skew.conj(), skew) < ROUNDING


@pytest.mark.parametrize(("name", "count"), [("square torus", 4), ("skew torus", 2), ("Bolza", 48), ("Lawson", 24)])
def test_number_of_automorphisms(name, count):
    assert automorphism_count(MATRICES[name]) == count
