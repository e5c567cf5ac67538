"""How maps look: thirteen models, the kind of map that each gets, and figures that it keeps.

The figures are those of maps that were looked at under a checker, with a tenth to spare: beyond, a map looks worse.
Where some maps are about as good, as on what is symmetric, the last bits of a processor's kernels choose, and the
figures are the largest of them. `pytest -s` prints them, and seconds of the processor.
"""

import time
from typing import NamedTuple

import families
import pytest
from holomorph import Surface, automatic_map
from limbed import limbs, spikes
from measured import quantiles
from repository import ROOT
from shared_data import shared_folder
from solved import surface_of


class Looks(NamedTuple):
    """At most: cost to an eye, with that of seams, poles and what does not stand upright; even, extreme: the 95 : 5 %
    and 99 : 1 % ratios of the density; sheared: the mean s1 / s2"""

    kind: str
    cost: float
    even: float
    extreme: float
    sheared: float


def of_shared(name):
    """The largest part of a mesh of the shared data."""
    return max(Surface.read(shared_folder("meshes") / name).components, key=lambda part: part.area)


MODELS = {
    "pretzel": lambda: Surface.read(ROOT / "examples" / "pretzel.obj"),
    "knot": lambda: surface_of(families.torus_knot(150, 8)),
    "torus": lambda: surface_of(families.torus(24, 18, jitter=0.2)),
    "thick torus": lambda: surface_of(families.torus(30, 20, R=1.5)),
    "torus with a hole": lambda: surface_of(families.punctured_torus(24, 18)),
    "limbs": lambda: surface_of(limbs()),
    "spikes": lambda: surface_of(spikes()),
    "ball of n-gons": lambda: surface_of(families.spun(24, 12)),
    "washer": lambda: surface_of(families.washer(20)),
    "block": lambda: surface_of(families.block_with_holes(3, refine=3, jitter=0.2)),
    "bowl": lambda: surface_of(families.hemisphere(8)),
    "bob": lambda: of_shared("bob_small.ply"),
    "hand": lambda: of_shared("hand_lowres_b1.obj"),
}

LOOKS = {
    "pretzel": Looks("tiling", 2.1, 2.4, 4.4, 1.25),
    "knot": Looks("tiling", 1.25, 1.6, 1.7, 1.12),
    "torus": Looks("tiling", 2.05, 2.8, 5.0, 1.3),
    "thick torus": Looks("tiling", 2.3, 3.2, 8.4, 1.3),
    "torus with a hole": Looks("tiling", 2.1, 3.0, 4.4, 1.31),
    "limbs": Looks("tiling", 2.9, 3.1, 8.5, 1.4),
    "spikes": Looks("tiling", 1.85, 2.6, 5.0, 1.18),
    "ball of n-gons": Looks("tiling", 2.1, 2.4, 6.6, 1.26),
    "washer": Looks("mixed", 0.2, 1 + 1e-6, 1 + 1e-6, 1 + 1e-6),
    "block": Looks("islands", 0.44, 1.04, 1.08, 1.02),
    "bowl": Looks("tiling", 1.55, 2.8, 6.1, 1.17),
    "bob": Looks("tiling", 2.7, 3.2, 11.5, 1.36),
    "hand": Looks("tiling", 1.65, 2.2, 5.7, 1.24),
}


@pytest.mark.parametrize("name", MODELS)
def test_looks(name):
    surface, expected = MODELS[name](), LOOKS[name]
    begin = time.process_time()
    made = automatic_map(surface)
    seconds = time.process_time() - begin
    quality = made.quality
    low, high = quantiles(quality.area, quality.weights, (0.01, 0.99))
    found = Looks(made.kind, made.cost, quality.density_ratio, high / low, quality.mean_angle)
    print(f"\n{name}: {found}, {seconds:.2f} s of the processor")
    assert found.kind == expected.kind
    for field in Looks._fields[1:]:
        assert getattr(found, field) <= getattr(expected, field), field
