"""Decides whether planar surfaces whose periods agree are the same or mirror images, which periods do not tell."""

import numpy as np

from .. import _native

LOOPS_OF_ACHIRAL_SURFACES = 3
"""Disks, annuli and pairs of pants are their own mirror images."""

SAMPLES = 200  # triangles of the first surface that are looked for on the second
CLEARLY = 4.0  # by this factor the one has to fit better
ALIKE = 1e-2  # both do where neither misses by more


def planar_verdict(a, b, matrix):
    """ "indistinguishable", "mirror_image" or "undecided", of structures whose Dirichlet forms correspond by `matrix`.

    At corresponding points the holomorphic forms have proportional values, at those of a mirror image conjugate ones
    (the canonical map): measured, not bounded."""
    whitened = np.linalg.inv(np.linalg.cholesky(b.projected_gram_matrices[1]))
    first, second = _values(a, whitened @ matrix), _values(b, whitened)
    first = first[np.linspace(0, len(first) - 1, SAMPLES).astype(int)]
    same, mirrored = (_miss(values, second) for values in (first, first.conj()))
    if max(same, mirrored) < ALIKE or CLEARLY * same < mirrored:
        return "indistinguishable"
    return "mirror_image" if CLEARLY * mirrored < same else "undecided"


def _values(structure, matrix):
    """(k, n) unit vectors: the holomorphic forms whose real parts are the Dirichlet forms, in each triangle but those
    where all are 0, for all corners lie on one boundary loop."""
    slopes = _native.form_slopes(structure._triangulation, np.ascontiguousarray(structure.dirichlet_forms))
    values = (slopes @ np.array([1, -1j])) @ matrix.T
    norms = np.linalg.norm(values, axis=1, keepdims=True)
    has_value = norms[:, 0] > 0
    return values[has_value] / norms[has_value]


def _miss(values, others):
    """The mean, over `values`, of the sine of the angle to the nearest of `others`, as complex lines."""
    likeness = np.abs(others.conj() @ values.T).max(axis=0)
    return float(np.sqrt(np.maximum(0, 1 - likeness**2)).mean())
