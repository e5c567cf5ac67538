# SPDX-License-Identifier: GPL-3.0-or-later
"""The shape of a report, as far as stored ones are read: someone may have edited one, or another version made it.

A shape is a type; a value; a tuple of shapes, one of which fits; a list of the shape of its items; a dict of those of
its values; or a function that tells whether something fits.
"""

import functools
import math

from ..materials.material import CHECKER
from ..materials.patterns import TEXTURES
from ..materials.user_texture import AUTOMATIC, IMAGE, MATERIAL
from ..native import holomorph

ABSENT = object()  # the value of a key that is not there
LATTICES = "square", "brick", "hex", AUTOMATIC
MOST = 2**31  # elements of a mesh


def fits(value, shape):
    """Whether a value of JSON has a shape. Keys that a shape does not name may have any value."""
    if isinstance(shape, tuple):
        return any(fits(value, one) for one in shape)
    if isinstance(shape, list):
        return isinstance(value, list) and all(fits(item, shape[0]) for item in value)
    if isinstance(shape, dict):
        return isinstance(value, dict) and all(fits(value.get(name, ABSENT), one) for name, one in shape.items())
    if isinstance(shape, type):
        return type(value) is shape
    return shape(value) if callable(shape) else type(value) is type(shape) and value == shape


def as_tuple(value):
    """A list of JSON, and those in it, as tuples; anything else as it is."""
    return tuple(map(as_tuple, value)) if isinstance(value, list) else value


def number(value):
    return type(value) in (int, float) and math.isfinite(value)


def count(value):
    return type(value) is int and 0 <= value < MOST


def words(value):
    return isinstance(value, str) and bool(value)


def some(shape):
    """Lists of one item or more."""
    return lambda value: fits(value, [shape]) and bool(value)


def row(*shapes):
    """Lists of as many items, each with its own shape."""
    return lambda value: isinstance(value, list) and len(value) == len(shapes) and all(map(fits, value, shapes))


@functools.lru_cache(maxsize=1)
def report():
    """The shape of a report on an object that has maps."""
    kinds, pair = holomorph.quality.verdicts, row(number, number)
    turns, lattice = (1, *kinds.TURNED), (*LATTICES, row(pair, pair))
    verdict = {"level": kinds.LEVELS, "sentence": words}
    tiling = {
        **dict.fromkeys(("poles", "zeros", "cones"), [count]),
        **dict.fromkeys(("size_range", "added_distortion", "tiles"), number),
        "turns": turns,
        "lines": str,
        "periods": [row(int, int)],
    }
    main_map = {
        "verdict": verdict,
        "mean_angle": number,
        **dict.fromkeys(("size_range", "overlapping_part"), (None, number)),
        **dict.fromkeys(("flipped_triangles", "collapsed_triangles"), count),
    }
    surface = {"genus": count, "boundary_count": count}
    done = {
        **surface,
        "done": True,
        "area": number,
        "parts": (ABSENT, count),
        "forms": (ABSENT, count),
        "description": str,
        "main_map": main_map,
        "tiling": (ABSENT, tiling),
        "tilings": (ABSENT, [tiling]),
        "period_matrix": (ABSENT, [some(pair)]),
        "modulus": (ABSENT, None, number),
        "modulus_bounds": (ABSENT, None, pair),
    }
    own = {
        "kind": (IMAGE, MATERIAL),
        "name": str,
        "lattice": lattice,
        **dict.fromkeys(("height", "shift", "alike"), number),
        "text": str,
        "turns": turns,
        "centre": pair,
        "averaged": turns,
    }
    dials = {
        "shown": count,
        **dict.fromkeys(("checker", "seams", "shape", "empties"), bool),
        "texture": (CHECKER, *TEXTURES, IMAGE, MATERIAL),
        **dict.fromkeys(("checker_scale", "size"), number),
        "own": (None, own),
        "stored": (ABSENT, None, dict),
        "together": (ABSENT, count),
    }
    size = row(number, count, (None, number), (None, pair), number)
    return {
        "verdict": verdict,
        "bake": verdict,
        "whole": {
            "text": str,
            "mean_angle": number,
            **dict.fromkeys(("size_range", "seams"), (None, number)),
            "cost": (ABSENT, None, number),
        },
        "maps": some({"name": str, "stored_as": str}),
        "repairs": {"joined_vertices": {"count": count}, "cuts": [{"text": words}]},
        "components": [(done, {"done": False, **surface}, {"done": False, "genus": ABSENT})],
        "dials": dials,
        "asked": (ABSENT, {"size": size, "lattice": lattice}),
        "coarse_places": (ABSENT, [{"name": str, "vertex": count, "times": number}]),
        "scale_of": (ABSENT, str),
    }
