# SPDX-License-Identifier: GPL-3.0-or-later
"""The dials that objects store: a property group of each, from which buttons start and to which runs write back. In it
lies another one, of what was made of them. One of the dials is the text of the points that were dragged or selected."""

import json
import math
from contextlib import ExitStack, contextmanager
from dataclasses import asdict, dataclass, replace

import bpy

NAME = "holomorph_map"  # of the group, a property of objects
OF_BLENDER = {"rna_type", "name"}  # properties of every group
RULED_OUT = {"tiles": "size", "size": "tiles"}  # the one that is given counts alone
MADE = "made"  # of what is known of the map, a property of the group
MOVED = "moved"  # the name of the dial that is each object's own: the text of its `Points`
BY_SELECTION = {"SELECTED", "COARSE"}  # values of the dial of the points that are for one run: their points are moved
ROUNDING = 1e-6  # of angles, in turns

_quiet = []  # not empty while dials are written and nothing is to follow


def names():
    """What the dials are called. What the group has beside them is hidden."""
    group = bpy.types.Object.bl_rna.properties[NAME].fixed_type
    return [one.identifier for one in group.properties if one.identifier not in OF_BLENDER and not one.is_hidden]


def read(owner):
    """{name: value} of the dials that an owner has: an operator, or the group of an object."""
    return {name: _plain(getattr(owner, name)) for name in names() if hasattr(owner, name)}


def of(obj):
    """{name: value} of the dials of an object; those that are not yet there stay so."""
    if obj.is_property_set(NAME):
        return read(getattr(obj, NAME))
    properties = bpy.types.Object.bl_rna.properties[NAME].fixed_type.properties
    return {name: _default(properties[name]) for name in names()}


def write(obj, values):
    """Writes dials of an object; nothing follows them."""
    now = of(obj)
    with quietly():
        for name, value in values.items():
            if name in now and now[name] != value:
                setattr(getattr(obj, NAME), name, value)


def made(obj):
    """The group of what is known of the map of an object, None without one. It is gone when it is written."""
    if obj is None or not obj.is_property_set(NAME):
        return None
    found = getattr(getattr(obj, NAME), MADE)
    return found if found.map else None


def is_behind(obj):
    """Whether the map of an object was made of other dials than it has now."""
    found = made(obj)
    return found is not None and read(found.dials) != of(obj)


def known(obj):
    """What `know` takes: what is known of the map of an object, and the dials that it was made of; () without one."""
    found = made(obj)
    if found is None:
        return ()
    names = {*found.bl_rna.properties.keys()} - {*OF_BLENDER, "dials"}
    return {name: getattr(found, name) for name in names}, read(found.dials)


def know(obj, values=None, dials=None):
    """Stores what is known of the map of an object, {name: value}; without values that there is none."""
    if values:
        found = getattr(getattr(obj, NAME), MADE)
        for owner, of_owner in ((found.dials, dials), (found, values)):
            for name, value in of_owner.items():
                setattr(owner, name, value)
    elif obj.is_property_set(NAME):
        getattr(obj, NAME).property_unset(MADE)


def chosen(obj):
    """{name: value} of the dials of an object that were ever set."""
    if not obj.is_property_set(NAME):
        return {}
    group = getattr(obj, NAME)
    return {name: value for name, value in read(group).items() if group.is_property_set(name)}


def beside(given, values):
    """Those of these dials that are neither given nor ruled out by one that is."""
    ruled_out = {*given, *(RULED_OUT[name] for name in given if name in RULED_OUT)}
    return {name: value for name, value in values.items() if name not in ruled_out}


def alike(objects, given):
    """The objects in lists of those that store the same dials beside given ones; a mesh has those of its first."""
    dials, groups = {}, {}
    for obj in objects:
        own = dials.setdefault(obj.data, beside(given, chosen(obj)))
        groups.setdefault(repr(own), []).append(obj)
    return list(groups.values())


def choose(obj, values):
    """Sets these dials of an object, and none but these."""
    if not values:
        forget(obj)
        return
    group, now = getattr(obj, NAME), chosen(obj)
    for name in now.keys() - values.keys():
        group.property_unset(name)
    with quietly():
        for name, value in values.items():
            if name not in now or now[name] != value:
                setattr(group, name, value)


def forget(obj):
    """All dials are automatic again."""
    obj.property_unset(NAME)


@dataclass(frozen=True)
class Points:
    """The points of a map, its poles and cones, that were dragged or selected on one object. On another mesh, or with
    another number of points asked for, they do not count.

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
        fields, angles = {}, [turns * angle for _, angle in self.cones]
        if angles and turns != 1 and all(abs(angle - round(angle)) < ROUNDING for angle in angles):
            fields["cones"] = dict(self.cones)
        if self.poles and (turns == 1 or is_open):
            fields |= {"moves": self.moves, "poles": self.base or wanted.request.poles}
            wanted = replace(wanted, points=self.poles)
        return replace(wanted, request=replace(wanted.request, **fields))


def points_of(obj, dials):
    """The `Points` of an object that count with these dials; None where they do not, or what it stores is none."""
    try:
        values = json.loads(of(obj)[MOVED])
        rows = {name: tuple(map(tuple, values[name])) for name in ("moves", "cones")}
        found = Points(**{**values, "poles": tuple(values["poles"]), "base": tuple(values["base"]), **rows})
        moves = [number for index, vertex in found.moves for number in (index, vertex)]
        used = [*found.poles, *found.base, *moves, *(vertex for vertex, _ in found.cones)]
        is_one = all(range(found.vertices)[number] == number for number in used)
        is_one &= all(math.isfinite(angle) for _, angle in found.cones)
    except (ValueError, TypeError, LookupError, OverflowError, RecursionError):
        return None
    counts = found.vertices, found.count
    is_one &= dials.poles not in BY_SELECTION and counts == (len(obj.data.vertices), asked_count(dials))
    return found if is_one else None


def asked_count(dials):
    """See `Points.count`."""
    return dials.pole_count if dials.poles == "COUNT" else -1


def kept(dials, poles, mesh):
    """The dials, {name: value}, that an object stores of a map with these poles: points of one run are moved ones from
    then on."""
    if dials.get("poles") not in BY_SELECTION:
        return dials
    chosen = poles if isinstance(poles, tuple) else ()
    text = Points(len(mesh.vertices), -1, poles=chosen, base=chosen).text if chosen else ""
    return dials | {"poles": "AUTOMATIC", MOVED: text}


@contextmanager
def quietly():
    """While nothing follows a dial. What was before comes back whatever is interrupted: else no map would follow."""
    with ExitStack() as stack:
        stack.callback(_quiet.__setitem__, slice(None), list(_quiet))
        _quiet.append(True)
        yield


def are_quiet():
    return bool(_quiet)


def _default(one):
    return list(one.default_array) if getattr(one, "is_array", False) else one.default


def _plain(value):
    """As JSON has it."""
    return list(value) if hasattr(value, "__len__") and not isinstance(value, str) else value
