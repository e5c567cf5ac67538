# SPDX-License-Identifier: GPL-3.0-or-later
"""What is asked for by the properties of the tile operator, or by the headless command under the same names, for one
object with its selection."""

import math

import numpy as np

from ..maps.options import TILING, MapOptions, TileOptions, dials
from ..materials import material
from ..materials.own import AUTOMATIC
from ..results import report, stored
from ..results.write import WriteOptions
from ..scene import mesh_io
from ..solving import choices
from . import map_choices

AXES = "XYZ"
ALLOWING = 0.5  # weight of a vertex above which a pole may be there
SQUARES = 4  # of the checker, across an image
# Lattices that quarter turns of a map that is made leave as they are, and so the texture whole. On others it is turned
# before its jumps are rounded.
QUARTERED = ("square", ((1.0, 0.0), (0.0, 1.0)))


def request(properties):
    """The `choices.Choices`."""
    is_selection_taken = properties.poles == "SELECTED" or properties.direction == "EDGES"
    faces = choices.WHOLE if is_selection_taken else choices.SELECTED
    return choices.Choices(faces=faces, modifiers=properties.modifiers)


def options(properties, target, own=None):
    """The `options.MapOptions` for a `targets.Target` and the `own.Own` that is its texture.

    @throws ValueError there is nothing of what is asked for on one of them"""
    obj = target.find()
    if target.makes_object and _are_on_the_mesh(properties):
        raise ValueError(f"{obj.name}: select poles and edges on the mesh itself, not on the result of its modifiers")
    lattice = _lattice(properties, own)
    quarters = properties.quarters if lattice in QUARTERED else 0
    tiling = TileOptions(
        tiles=0.0 if properties.size else float(properties.tiles),
        density=map_choices.density(properties.size, properties.repeats),
        poles=_poles(properties, obj),
        lattice=lattice,
        direction=_direction(properties, obj),
        boundary=properties.boundary,
        turn=(properties.quarters - quarters) * math.pi / 2 + properties.turn,
        quarters=quarters,
        pole_group=properties.pole_group,
        allowed=allowed(properties.pole_group, obj),
        **dials(properties),
    )
    return MapOptions(forms=0, main=TILING, tiling=tiling)


def write_options(properties, own=None):
    texture = map_choices.shown_texture(properties.texture, own)
    cells = properties.repeats * (SQUARES if texture == material.CHECKER else material.cells(texture))
    more = {"empties": properties.empties, "size": properties.size, "own": own}
    return WriteOptions(0, properties.checker, texture, cells, properties.seams, **more)


def _lattice(properties, own):
    if own is not None:
        return own.lattice
    return "square" if properties.lattice == AUTOMATIC else properties.lattice


def _are_on_the_mesh(properties):
    return properties.poles in ("SELECTED", "KEPT") or properties.direction == "EDGES" or bool(properties.pole_group)


def _poles(properties, obj):
    if properties.poles == "COUNT":
        return properties.pole_count
    if properties.poles == "AUTOMATIC":
        return "auto"
    if properties.poles == "KEPT":
        return _kept_poles(obj)
    if properties.poles == "COARSE":
        return _poles_where_coarse(obj)
    selected = tuple(sorted(mesh_io.selected_vertices(obj.data).tolist()))
    if not selected:
        raise ValueError(f"{obj.name}: select the vertices to use as poles")
    return selected


def _kept_poles(obj):
    vertices, is_pole = stored.marks(obj.get(report.PROPERTY))
    kept = vertices[is_pole & (vertices < len(obj.data.vertices))]
    if not len(kept):
        raise ValueError(f"{obj.name}: it has no poles from an earlier tiling")
    return tuple(sorted(kept.tolist()))


def _poles_where_coarse(obj):
    """The poles of the last tiling, and the coarsest vertices of the places that its report names."""
    text = obj.get(report.PROPERTY)
    vertices, is_pole = stored.marks(text)
    if not is_pole.any():
        return "auto"
    found = [place["vertex"] for place in stored.parsed(text).get("coarse_places", [])]
    poles = {*vertices[is_pole].tolist(), *found}
    return tuple(sorted(vertex for vertex in poles if vertex < len(obj.data.vertices)))


def allowed(name, obj):
    """Where poles may be, see `options.TileOptions`: where the group's weight is above `ALLOWING`."""
    if not name:
        return None
    group = obj.vertex_groups.get(name)
    if group is None:
        raise ValueError(f"{obj.name}: there is no vertex group {name!r}")
    mask = mesh_io.weights(obj.data, group.index) > ALLOWING
    if not mask.any():
        raise ValueError(f"{obj.name}: no vertex has a weight above {ALLOWING} in {name!r}")
    return mask.tobytes()


def _direction(properties, obj):
    """The direction of `options.TileOptions`, in the frame of the polygons: as the object stands in space, without its
    translation."""
    if properties.direction in ("NONE", "UPRIGHT"):
        return None if properties.direction == "NONE" else "upright"
    linear = np.array(obj.matrix_world, np.float64)[:3, :3]
    if properties.direction in AXES:
        axis = linear[:, AXES.index(properties.direction)]
        if not _has_length(axis):
            raise ValueError(f"{obj.name}: its {properties.direction} axis is scaled to 0: choose another direction")
        return tuple(axis.tolist())
    edges = mesh_io.edge_vectors(obj.data, mesh_io.marked_edges(obj.data, "select")) @ linear.T
    if not _has_length(edges):
        raise ValueError(f"{obj.name}: select the edges for the rows to follow")
    return mean_direction(edges)


def _has_length(vectors):
    return vectors.any() and np.isfinite(vectors).all()


def mean_direction(vectors):
    """The line that (n, 3) vectors lie along most, whichever way each points: the first axis of their moments; its
    largest coordinate is positive."""
    vectors = vectors / np.abs(vectors).max()
    _, axes = np.linalg.eigh(vectors.T @ vectors)
    axis = axes[:, -1]
    return tuple((axis * np.sign(axis[np.argmax(np.abs(axis))])).tolist())
