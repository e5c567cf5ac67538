"""Tilings whose sides of a cut may also turn, by the symmetry of the texture: cones take the place of poles."""

from __future__ import annotations

import numbers
from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from .._native import TopologyError
from ..core import arrays
from ..core.array_types import Integers
from ..core.value import quoted
from ..mesh.checks import own_vertices, real_number
from ..mesh.edges import boundary_edges
from ..mesh.surface import Surface
from .image_turns import image_turns

TURNS = (1, 2, 4, 6)
AUTO = "auto"  # those of the texture
LATTICE = {2: "square", 4: "square", 6: "hex"}  # of which a turn by this part of a full one is a symmetry
LINED_TURNS = (2, 4)  # lines cross at right angles
WHOLE = 1e-6  # part of a turn: less is rounding
MOST_PARTS = 1200  # of a turn around one cone: all that any use has, and no sum of them overflows
EDGED, MIRROR = ("whole", "free"), "mirror"  # lines along edges, and the one between two halves that are alike
LINES = ("none", *EDGED, MIRROR)
AUTOMATIC = "automatic"  # the lines that cost little


def missing_turns(surface: Surface, component: Surface, cones: Mapping[int, float], turns: int) -> Integers:
    """(#V,) k-th turns that are missing around the vertices of the component."""
    vertices, _ = own_vertices(surface, component, list(cones), "cone")
    angles = [real_number(angle, "the angle around a cone", positive=True) for angle in cones.values()]
    parts = np.rint(np.multiply(angles, turns))
    off = np.abs(np.multiply(angles, turns) - parts)
    wrong = np.flatnonzero((off > WHOLE) | (parts < 1) | (parts > MOST_PARTS))
    if len(wrong):
        wanted = f"{turns}, whole parts of a turn, up to {MOST_PARTS // turns}"
        raise ValueError(
            f"the angle around a cone is {angles[wrong[0]]:.6g} turns; multiples of 1/{wanted}, are needed"
        )
    missing = np.zeros(len(component.vertices), np.int64)
    missing[vertices] = turns - parts.astype(np.int64)
    edge = np.flatnonzero(np.isin(vertices, boundary_edges(component)))
    if len(edge):
        raise TopologyError(f"vertex {list(cones)[edge[0]]} is on the boundary, where no cone can be")
    return missing


def checked_lines(lines: Any, turns: int, *others: str) -> str:
    """Raises ValueError for anything but `LINES` and these others, and for lines of a tiling that turns by other than
    quarters or halves."""
    names = (*others, *LINES)
    if not isinstance(lines, str) or lines not in names:
        raise ValueError(f"lines is {quoted(lines)}; one of {', '.join(names)} is needed")
    if lines not in (*others, "none") and turns not in LINED_TURNS:
        raise ValueError(f"lines is {quoted(lines)}, for which turns must be 2 or 4")
    return lines


def check_chosen(marked: Any, cones: Any) -> None:
    """Raises InvalidMesh for marked edges that are no pairs of vertices, ValueError for cones that are no mapping."""
    if marked is not None:
        arrays.integer(marked, "marked", 2, (2,))
    if cones is None:
        return
    if not isinstance(cones, Mapping):
        raise ValueError(f"cones is {quoted(cones)}; a dictionary from vertices to angles in full turns is needed")
    arrays.integer(list(cones), "cones")


def asked_turns(turns: Any, texture: ArrayLike | None) -> int:
    """`checked_turns`, or for `AUTO` those of a texture, of pixels as in `image_turns`; 1 without one."""
    if isinstance(turns, str) and turns == AUTO:
        return 1 if texture is None else image_turns(texture).turns
    return checked_turns(turns)


def checked_turns(turns: Any) -> int:
    """Raises ValueError for anything but 1, 2, 4 or 6."""
    if isinstance(turns, bool) or not isinstance(turns, numbers.Integral) or turns not in TURNS:
        raise ValueError(f"turns is {quoted(turns)}; one of {', '.join(map(str, TURNS))} is needed")
    return int(turns)
