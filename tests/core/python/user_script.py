"""What a user may write, for type checkers: test_types.py beside it. `assert_type` fails where a type is not that."""

from typing import Any, assert_type

import holomorph
import numpy as np
from numpy.typing import NDArray

Reals = NDArray[np.float64]
Complexes = NDArray[np.complex128]
Integers = NDArray[np.signedinteger[Any]]


def stopped(fraction: float, stage: str) -> bool:
    return fraction < 0.5 or stage == "solver"


def mapped(path: str) -> Reals:
    surface = holomorph.Surface.read(path, weld=True)
    assert_type(surface, holomorph.Surface)
    assert_type(surface.genus, int)
    assert_type(surface.vertices, Reals | None)
    for part in surface.components:
        structure = holomorph.conformal_structure(part, solver="direct", progress=stopped)
        uv = structure.uv(structure.balanced_coefficients())
        assert_type(uv, Reals)
        assert_type(structure.quality(uv), holomorph.Quality)
        assert_type(structure.quality(uv).mean_angle, float)
        assert_type(structure.quality(uv).verdict.sentence, str)
        assert_type(structure.tile(tiles=64), holomorph.Tiling)
        assert_type(structure.tile(poles=[3, 5]).uv, Reals)
        assert_type(structure.solver.residual, float)
        assert_type(structure.timings, dict[str, float])
        part.write("out.obj", uv)
        if isinstance(structure, holomorph.ConformalStructure):
            assert_type(structure.period_matrix, Complexes)
            assert_type(structure.period_bounds, tuple[Reals, Reals] | None)
            assert_type(structure.homology_basis, tuple[Integers, ...])
            assert_type(structure.certificate.holds, bool)
            assert_type(structure.zeros([1, 0]).orders, Integers)
            return structure.uv_of([1, 0], [0, 1])
        if isinstance(structure, holomorph.BoundedStructure):
            assert_type(structure.modulus, float)
    return np.zeros((0, 2))


def compared(a: holomorph.Surface, b: holomorph.Surface) -> str:
    found = holomorph.conformally_equivalent(a, b)
    assert_type(found.matrix, Integers | None)
    mesh = holomorph.ProgressiveMesh(a)
    assert_type(mesh.level(500), holomorph.Surface)
    assert_type(mesh.conformal_structure(500), holomorph.ConformalStructure | holomorph.BoundedStructure)
    tiler = holomorph.Tiler(a, 4, boundary="free")
    assert_type(tiler.tile(16, lattice=[[1, 0], [0, 1]]).quality.density_ratio, float)
    assert_type(holomorph.place_poles(a, 3).vertices, Integers)
    try:
        holomorph.double_cover(b)
    except holomorph.TopologyError as error:
        return str(error)
    return found.sentence
