"""Many uneven bodies at once: some are cut open where few see it, some cannot be, some are left to islands."""

import numpy as np
import pytest
from holomorph import Surface, automatic_maps
from limbed import uneven

BODIES = 20


@pytest.mark.parametrize("seed", [1, 2])
def test_each_has_its_map(seed):
    parts = []
    for n in range(BODIES):
        body = uneven(seed * BODIES + n)
        parts += Surface.from_polygons(body.vertices, body.corners, body.offsets, strict=False).components
    made = automatic_maps(parts, turns=4)
    assert [found.surface for found in made] == parts
    assert all(np.isfinite(found.uv).all() for found in made)
    assert len({found.kind for found in made}) > 1
