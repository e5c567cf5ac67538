# SPDX-License-Identifier: GPL-3.0-or-later
"""A mesh of quads over the mesh of an object, as an object of its own with what that one has."""

from dataclasses import dataclass

import numpy as np

from ..compatibility import Values
from ..results import report, tags
from ..scene import mesh_io, uv_maps
from ..solving import jobs
from ..writing import transferred
from . import geometry

OF = "holomorph_quads_of"  # custom property: name of the object that they are of
MAP = "Quads"  # UV map in which each is a whole square
INSIDE = 1e-9  # a coordinate: less lies on a side of a triangle, which may have another material beyond
KEPT = {}  # the last surface by its key, with its cones: another number of quads is quick


@dataclass
class QuadsWork(jobs.Work):
    """Makes the quads; after `run`, `made` is the `holomorph.Quads`."""

    polygons: object  # mesh_io.Polygons
    faces: int
    lines: str
    mirror: bool
    marked: np.ndarray  # (n, 2) vertices of edges that are lines, too
    progress: object = None
    made: object = None

    def __post_init__(self):
        super().__init__(self.progress)

    def work(self):
        key = jobs.Task(self.polygons).key
        surface = KEPT.get(key) or self.polygons.surface(strict=False)
        options = {"lines": self.lines, "mirror": self.mirror, "marked": self.marked}
        self.made = surface.quads(self.faces, **options, progress=self.watch)
        KEPT.clear()
        KEPT[key] = surface


def write(step, obj, quads):
    """Makes the object: a copy of `obj` in its place, with its modifiers, materials, vertex groups, weights and UV
    maps, but with the mesh of the `holomorph.Quads`. That of an earlier run is replaced."""
    step.remove(geometry.earlier(obj, OF))
    mesh = _mesh(obj, quads)
    made = obj.copy()
    made.data = mesh
    made.name = mesh.name = f"{obj.name} Quads"
    report.remove(made)
    tags.put(made, OF, obj)
    for collection in [c for c in obj.users_collection if c.library is None] or [step.context.scene.collection]:
        collection.objects.link(made)
    transferred.weights(step.context, obj, [made], "POLYINTERP_NEAREST")
    transferred.maps(step.context, obj, [made])
    polygons = mesh_io.Polygons(quads.positions, quads.corner_vertices, quads.face_offsets, None)
    uv_maps.write_map(mesh, polygons, MAP, quads.uv.astype(np.float32))
    made.select_set(False)  # the next operator is meant for the object alone
    return made


def _mesh(obj, quads):
    own = mesh_io.read_values(Values(obj.data.vertices, "co", np.float32, 3))
    mesh = mesh_io.new_mesh(obj.name, quads.of(own.astype(float)), quads.corner_vertices, quads.face_offsets)
    for slot in obj.material_slots:
        mesh.materials.append(slot.material)
    if len(obj.material_slots) > 1:
        of_faces = mesh_io.read_values(Values(obj.data.polygons, "material_index", np.int32))
        mesh_io.write_values(Values(mesh.polygons, "material_index", np.int32), _most(quads, of_faces))
    if any(polygon.use_smooth for polygon in obj.data.polygons[:1]):
        mesh_io.shade_smooth(mesh, geometry.SHARP)
    return mesh


def _most(quads, of_faces):
    """(#F,) the value of the faces that most corners of each quad lie in; those on sides of triangles count half."""
    counts = np.diff(quads.face_offsets)
    value = of_faces[quads.faces][quads.corner_vertices]
    inside = 1 + (quads.weights.min(axis=1) > INSIDE)[quads.corner_vertices]
    votes = np.zeros((len(counts), value.max() + 1))
    np.add.at(votes, (np.repeat(np.arange(len(counts)), counts), value), inside)
    return votes.argmax(axis=1).astype(np.int32)
