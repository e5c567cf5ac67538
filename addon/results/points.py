# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of a map, its poles and cones, that were dragged or selected: an object stores them with its dials."""

import json
import math
from dataclasses import asdict, dataclass, replace

import numpy as np

from ..scene.stored_dials import MOVED

BY_SELECTION = {"SELECTED", "COARSE"}  # values of the dial of the points that are for one run: their points are moved
ROUNDING = 1e-6  # of angles, in turns


@dataclass(frozen=True)
class Points:
    """Those of one object. On another mesh, or with another number of points asked for, they do not count.

    vertices : how many its mesh has
    count : of points on each part, as it was asked for; -1 for automatic
    poles : vertices of those on the parts of which one was moved, where they are now
    base : the vertices where these were before, if they were chosen; none if they were placed
    moves : (index of a pole in the tiling of its part, vertex to which it was moved)
    cones : (vertex, angle in full turns)
    """

    vertices: int
    count: int
    poles: tuple = ()
    base: tuple = ()
    moves: tuple = ()
    cones: tuple = ()

    @property
    def text(self):
        """As a dial of the object."""
        return json.dumps(asdict(self))

    def on(self, wanted, turns, is_open):
        """The `mapped.MappedObject` that is wanted with these, on a map whose sides turn by this part of a full turn.

        is_open : whether parts on which poles were moved need not turn
        """
        fields, angles = {}, turns * np.array([angle for _, angle in self.cones])
        if self.cones and turns != 1 and np.all(np.abs(angles - np.round(angles)) < ROUNDING):
            fields["cones"] = dict(self.cones)
        if self.poles and (turns == 1 or is_open):
            fields |= {"moves": self.moves, "poles": self.base or wanted.request.poles}
            wanted = replace(wanted, points=self.poles)
        return replace(wanted, request=replace(wanted.request, **fields))


def of(text, dials, mesh):
    """The `Points` in the dial of an object; None where they do not count, or what is there is none."""
    try:
        values = json.loads(text)
        rows = {name: tuple(map(tuple, values[name])) for name in ("moves", "cones")}
        found = Points(**{**values, "poles": tuple(values["poles"]), "base": tuple(values["base"]), **rows})
        moves = [number for index, vertex in found.moves for number in (index, vertex)]
        used = [*found.poles, *found.base, *moves, *(vertex for vertex, _ in found.cones)]
        is_one = all(range(found.vertices)[number] == number for number in used)
        is_one &= all(math.isfinite(angle) for _, angle in found.cones)
    except (ValueError, TypeError, LookupError, OverflowError, RecursionError):
        return None
    counts = found.vertices, found.count
    return found if is_one and counts == (len(mesh.vertices), asked_count(dials)) else None


def asked_count(dials):
    """See `Points.count`."""
    return dials.pole_count if dials.poles == "COUNT" else -1


def kept(stored, made, mesh):
    """The dials that an object stores of a `mapped.MappedObject`: points of one run are moved ones from then on."""
    if stored.get("poles") not in BY_SELECTION:
        return stored
    chosen = made.request.poles
    chosen = chosen if isinstance(chosen, tuple) else ()
    text = Points(len(mesh.vertices), -1, poles=chosen, base=chosen).text if chosen else ""
    return stored | {"poles": "AUTOMATIC", MOVED: text}
