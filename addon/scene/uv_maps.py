# SPDX-License-Identifier: GPL-3.0-or-later
"""UV maps on Blender's meshes: which are ours, reading and writing them.

UVs are double precision on our side and float32 on Blender's.
"""

import re
from dataclasses import dataclass

import numpy as np

from .. import compatibility
from ..compatibility import Values
from .mesh_io import is_attribute, read_values, write_values

MAIN_MAP = "Holomorphic"
SHAPE = "Holomorphic Shape"  # vector attribute of vertices
BAKE_MAP = "Holomorphic Bake"
OF_BAKE = "holomorph_bake_map"  # custom property of a mesh: name of the map that images are baked by
BEFORE = "holomorph_shown_before"  # custom property of a mesh: the UV maps that were active, in editors and for renders
OWN_MAPS = "holomorph_maps"  # custom property of a mesh: names of the maps that were made here, one in a line


@dataclass(frozen=True)
class WrittenMap:
    """A map as it stands on the mesh: `kind` is "uv_map", or "attribute" where no UV slot was free."""

    name: str
    kind: str


def own_maps(mesh):
    """Names of the maps that were made here, the main one first."""
    return str(mesh.get(OWN_MAPS, "")).splitlines()


def add_own_maps(mesh, names):
    """Notes which maps were made here: a name alone may be that of someone else's map."""
    mesh[OWN_MAPS] = "\n".join(dict.fromkeys([*own_maps(mesh), *names]))


def _own_map(mesh, name):
    """The map of ours that was to have this name, "" without one; Blender numbers it where the name was taken."""
    numbered = re.compile(rf"{re.escape(name)}(\.[0-9]+)?")
    return next((own for own in own_maps(mesh) if numbered.fullmatch(own) and _has_map(mesh, own)), "")


def main_map(mesh):
    """The name of the main map, "" without one; another than `MAIN_MAP` where that is taken by someone else's map."""
    return _own_map(mesh, MAIN_MAP)


def is_own_attribute(mesh, attribute):
    """Whether a corner attribute is a map of ours; from Blender 3.5 on, UV maps are such attributes too."""
    is_map = attribute.domain == "CORNER" and attribute.data_type == "FLOAT2"
    return is_map and attribute.name in own_maps(mesh)


def has_maps(mesh):
    """Whether there are maps of an earlier run."""
    return any(_has_map(mesh, name) for name in own_maps(mesh))


def remove_maps(mesh):
    """Removes the maps of an earlier run, and no other."""
    own = own_maps(mesh)
    for name in [layer.name for layer in mesh.uv_layers if layer.name in own]:
        mesh.uv_layers.remove(mesh.uv_layers[name])
    others = [a.name for a in mesh.attributes if is_own_attribute(mesh, a)]
    for name in others + [SHAPE] * is_attribute(mesh, SHAPE, "POINT", "FLOAT_VECTOR"):
        mesh.attributes.remove(mesh.attributes[name])
    if OWN_MAPS in mesh:
        del mesh[OWN_MAPS]


def bake_map(mesh):
    """The name of the map that images are baked by, "" without one."""
    name = str(mesh.get(OF_BAKE, ""))
    return name if name in mesh.uv_layers else ""


def has_room_for_bake_map(mesh):
    return bool(bake_map(mesh)) or len(mesh.uv_layers) < compatibility.UV_MAP_LIMIT


def write_bake_map(mesh, polygons, uv):
    """Writes (#C,2) float32 `uv` as the map that images are baked by, in place of an earlier one; returns its name.
    @pre there is room for it"""
    name = bake_map(mesh)
    if name:
        overwrite_map(mesh, polygons, name, uv)
    else:
        name = mesh[OF_BAKE] = write_map(mesh, polygons, BAKE_MAP, uv).name
    return name


def remove_bake_map(mesh):
    """Returns whether there was one."""
    name = bake_map(mesh)
    if name:
        mesh.uv_layers.remove(mesh.uv_layers[name])
    mesh.pop(OF_BAKE, None)
    return bool(name)


def _of_loops(mesh, polygons, uv, before=""):
    """(#C,2) in the order of the loops; without `polygons` it is. Loops of no corner have what the map `before` has."""
    if polygons is None or polygons.loops is None:
        return uv
    scattered = read_map(mesh, before) if before else np.zeros((len(mesh.loops), 2), np.float32)
    scattered[polygons.loops] = uv
    return scattered


def write_map(mesh, polygons, name, uv):
    """Writes (#C,2) float32 `uv` as a new UV map, or as a corner attribute when all slots are taken.

    Where these are some of the mesh's polygons, the others keep the UVs that they have in our map of this name, or else
    in the active one.
    """
    own = "" if polygons.faces is None else _own_map(mesh, name)
    if own:
        overwrite_map(mesh, polygons, own, uv)
        return WrittenMap(own, "uv_map" if is_uv_map(mesh, own) else "attribute")
    uv = _of_loops(mesh, polygons, uv, "" if polygons.faces is None else getattr(mesh.uv_layers.active, "name", ""))
    # References to layers do not survive the next `new`: look up by name, keep nothing.
    if len(mesh.uv_layers) < compatibility.UV_MAP_LIMIT:
        layer = mesh.uv_layers.new(name=compatibility.free_name(mesh, name), do_init=False)
        write_values(compatibility.uv_values(layer), uv)
        return WrittenMap(layer.name, "uv_map")
    attribute = mesh.attributes.new(name, "FLOAT2", "CORNER")
    write_values(_attribute_vectors(attribute, 2), uv)
    return WrittenMap(attribute.name, "attribute")


def is_uv_map(mesh, name):
    """Whether a map is one of the UV maps that Blender has room for, and no attribute."""
    return name in mesh.uv_layers.keys()[: compatibility.UV_MAP_LIMIT]


def _has_map(mesh, name):
    return name in mesh.uv_layers or name in mesh.attributes


def _values(mesh, name):
    """The `compatibility.Values` of a UV map or corner attribute."""
    layer = mesh.uv_layers.get(name)
    return _attribute_vectors(mesh.attributes[name], 2) if layer is None else compatibility.uv_values(layer)


def read_map(mesh, name):
    """(#loops,2) float32 of a UV map or corner attribute."""
    return read_values(_values(mesh, name))


def read_corners(mesh, polygons, name):
    """(#C,2) float32 of a map, corners in the order of `polygons`."""
    return polygons.of_corners(read_map(mesh, name))


def overwrite_map(mesh, polygons, name, uv):
    """Writes (#C,2) float32 `uv` into a UV map or corner attribute that there is."""
    is_part = polygons is not None and polygons.faces is not None
    write_values(_values(mesh, name), _of_loops(mesh, polygons, uv, name if is_part else ""))
    mesh.update()


def show_map(mesh, name):
    """Makes a UV map the active one, in the editors and for rendering; an attribute cannot be."""
    layer = mesh.uv_layers.get(name)
    if layer is not None:
        mesh.uv_layers.active = layer
        layer.active_render = True


def remember_shown(mesh):
    """Notes which active maps are not ours. @pre ours are not yet removed or written"""
    before, ours = dict(mesh.get(BEFORE, {})), (*own_maps(mesh), bake_map(mesh))
    active, rendered = mesh.uv_layers.active, next((layer for layer in mesh.uv_layers if layer.active_render), None)
    for use, layer in (("active", active), ("rendered", rendered)):
        if layer is not None and layer.name not in ours:
            before[use] = layer.name
    if before:
        mesh[BEFORE] = before


def show_remembered(mesh):
    """Makes the maps active again that were noted; returns whether any were."""
    before = dict(mesh.get(BEFORE, {}))
    mesh.pop(BEFORE, None)
    active, rendered = (mesh.uv_layers.get(before.get(use, "")) for use in ("active", "rendered"))
    if active is not None:
        mesh.uv_layers.active = active
    if rendered is not None:
        rendered.active_render = True
    return bool(before)


def write_shape(mesh, points):
    """Writes (#V,3) points as a vector attribute of the vertices."""
    if SHAPE in mesh.attributes:
        mesh.attributes.remove(mesh.attributes[SHAPE])
    attribute = mesh.attributes.new(SHAPE, "FLOAT_VECTOR", "POINT")
    write_values(_attribute_vectors(attribute, 3), points)


def _attribute_vectors(attribute, width):
    return Values(attribute.data, "vector", np.float32, width)
