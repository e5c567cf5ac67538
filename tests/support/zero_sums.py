"""Sums of the orders of the zeros of random combinations of forms."""

import gzip
import shutil
import tempfile
from pathlib import Path

import holomorph
import numpy as np

COMBINATIONS = 10


def read(path):
    if path.suffix != ".gz":
        return holomorph.Surface.read(path)
    with gzip.open(path) as packed, tempfile.NamedTemporaryFile(suffix=Path(path.stem).suffix) as plain:
        shutil.copyfileobj(packed, plain)
        plain.flush()
        return holomorph.Surface.read(plain.name)


def sums(structure, seed=0):
    """The orders' sums on the double of ten combinations, on a closed surface those on itself."""
    random = np.random.default_rng(seed)
    surface, found = structure.surface, []
    is_bounded = surface.boundary_count > 0
    loops = np.concatenate(structure._native.boundary_loops()) if is_bounded else np.zeros(0, int)
    for _ in range(COMBINATIONS):
        c = random.normal(size=len(structure.balanced_coefficients())).astype(complex)
        if not is_bounded:
            c = c + 1j * random.normal(size=len(c))
        zeros = structure.zeros(c if structure.coefficient_type is np.complex128 else c.real)
        weights = np.where(np.isin(zeros.vertices, loops), 1, 2) if is_bounded else 1
        found.append(int((weights * zeros.orders).sum()))
    return found


def poles(surface):
    """Two vertices, inside of all the meshes there are."""
    return [len(surface.vertices) // 3, 2 * len(surface.vertices) // 3]


def rows(path, most_faces=10**7):
    """(genus, loops, poles, sum that is right, sums) of each component of genus >= 2."""
    for part in read(path).components:
        if part.genus < 2 or len(part.triangles) > most_faces:
            continue
        double = 2 * (2 * part.genus + part.boundary_count - 1) - 2 if part.boundary_count else 2 * part.genus - 2
        yield part.genus, part.boundary_count, 0, double, sums(holomorph.conformal_structure(part))
        structure = holomorph.log_map(part, poles(part))
        added = 4 if part.boundary_count else 2
        yield part.genus, part.boundary_count, 2, double + added, sums(structure)
