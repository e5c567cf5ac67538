"""Bodies of all kinds get their maps, many at once. The suite fills fresh memory with junk."""

import runpy

import families
import numpy as np
import pytest
from holomorph import Surface, automatic_maps
from limbed import uneven
from shared_data import SHARED

BODIES, HARD_CASES = 20, SHARED / "tools" / "hard_cases.py"


def parts_of(mesh):
    return Surface.from_polygons(mesh.vertices, mesh.corners, mesh.offsets, strict=False).components


def kinds_of_maps(parts):
    made = automatic_maps(parts, turns=4)
    assert [len(found.uv) for found in made] == [len(part.corner_vertices) for part in parts]
    assert all(np.isfinite(found.uv).all() for found in made)
    return {found.kind for found in made}


@pytest.mark.parametrize("seed", [1, 2])
def test_uneven_bodies(seed):
    """Some are cut open where few see it, some would fall apart, some are left to islands."""
    parts = [part for n in range(BODIES) for part in parts_of(uneven(seed * BODIES + n))]
    assert len(kinds_of_maps(parts)) > 1


@pytest.mark.skipif(not HARD_CASES.exists(), reason="no folder ../shared")
def test_meshes_as_people_bring_them():
    hard_cases = runpy.run_path(str(HARD_CASES))
    for name in hard_cases["NAMES"]:
        assert kinds_of_maps(parts_of(families.polygons(*hard_cases["make"](name, 17)))), name
