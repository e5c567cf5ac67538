"""How maps look: thirteen models, the kind of map that each gets, and figures that it keeps.

The figures are those of maps that were looked at under a checker, with a tenth to spare: beyond, a map looks worse, or
is another one. `pytest -s` prints them, and seconds of the processor.
"""

import time
from typing import NamedTuple

import families
import numpy as np
import pytest
from holomorph import Surface, automatic_map
from limbed import limbs, spikes
from measured import quantiles
from repository import ROOT
from shared_data import shared_folder
from solved import surface_of


class Looks(NamedTuple):
    """kind of map; poles: least and most; even, extreme: at most the 95 : 5 % and 99 : 1 % ratios of the density;
    sheared: at most the mean s1 / s2; seams: least and most length, over the square root of the area; words: those of
    the verdict about size and shear"""

    kind: str
    poles: tuple[int, int]
    even: float
    extreme: float
    sheared: float
    seams: tuple[float, float]
    words: str


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
    "pretzel": Looks("tiling", (0, 0), 2.4, 4.4, 1.25, (5.0, 5.9), "Fairly even, a fifth is upside down"),
    "knot": Looks("tiling", (0, 0), 1.6, 1.7, 1.12, (3.5, 4.3), "Even, a tenth is upside down"),
    "torus": Looks("tiling", (3, 3), 2.8, 5.0, 1.3, (2.8, 3.6), "Fairly even, a fifth is upside down"),
    "thick torus": Looks(
        "tiling", (6, 6), 2.7, 8.4, 1.3, (3.3, 4.1), "Fairly even, slightly sheared, a tenth is upside down"
    ),
    "torus with a hole": Looks(
        "tiling", (3, 3), 3.0, 4.4, 1.31, (2.9, 3.6), "Fairly even, slightly sheared, a quarter is upside down"
    ),
    "limbs": Looks("tiling", (6, 6), 2.9, 8.5, 1.4, (4.1, 4.8), "Fairly even, slightly sheared, a fifth is sideways"),
    "spikes": Looks("tiling", (4, 4), 2.6, 5.0, 1.18, (2.8, 3.6), "Fairly even, a third is slanted"),
    "ball of n-gons": Looks(
        "tiling", (8, 8), 2.4, 6.6, 1.26, (2.4, 3.1), "Fairly even, slightly sheared, half is slanted"
    ),
    "washer": Looks("mixed", (0, 0), 1 + 1e-6, 1 + 1e-6, 1 + 1e-6, (5.8, 7.2), "Even"),
    "block": Looks("islands", (0, 0), 1.04, 1.08, 1.02, (8.9, 10.9), "Even"),
    "bowl": Looks("tiling", (4, 4), 2.8, 6.1, 1.17, (2.8, 3.5), "Fairly even"),
    "bob": Looks("tiling", (3, 3), 3.2, 8.0, 1.36, (2.5, 3.2), "Fairly even, slightly sheared, a fifth is sideways"),
    "hand": Looks("tiling", (6, 6), 2.2, 5.7, 1.24, (3.8, 4.8), "Even"),
}


def seam_length(made):
    start, end = np.moveaxis(made.surface.vertices[made.seams], 1, 0)
    return np.linalg.norm(end - start, axis=1).sum() / made.surface.area**0.5


@pytest.mark.parametrize("name", MODELS)
def test_looks(name):
    surface, expected = MODELS[name](), LOOKS[name]
    begin = time.process_time()
    made = automatic_map(surface)
    seconds = time.process_time() - begin
    quality = made.quality
    low, high = quantiles(quality.area, quality.weights, (0.01, 0.99))
    words = ", ".join(word for word in made.verdict.sentence.split(", ") if "seam" not in word and "pole" not in word)
    figures = quality.density_ratio, high / low, quality.mean_angle, seam_length(made)
    found = Looks(made.kind, len(made.poles), *figures, words)
    print(f"\n{name}: {found}, {seconds:.2f} s of the processor")
    assert (found.kind, found.words) == (expected.kind, expected.words)
    for field in ("poles", "seams"):
        least, most = getattr(expected, field)
        assert least <= getattr(found, field) <= most, field
    for field in ("even", "extreme", "sheared"):
        assert getattr(found, field) <= getattr(expected, field), field
