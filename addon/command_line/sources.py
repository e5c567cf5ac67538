# SPDX-License-Identifier: GPL-3.0-or-later
"""The objects that the headless command is about: those of a mesh file, or of the .blend."""

import math
from dataclasses import replace

import bpy

from .. import compatibility
from ..native import holomorph, module
from ..operators import request
from ..scene import gathering, mesh_io, stored_dials, targets
from ..solving import jobs
from . import exchange
from . import options as options_of
from .options import Refused, UsageError

intake = module("mesh.intake")
near_origin = module("core.arrays").near_origin
SHARP_ANGLE = 0.7  # radians, 40 degrees: sharper edges of an imported mesh stay sharp
Z_UP_FROM_Y_UP = math.pi / 2  # radians about the x axis, as Blender's own importers rotate OBJ files


def collect(options):
    """[(options, `targets.Target`s)]: objects that store the same dials have the same. @throws Refused"""
    _check_mesh(options.mesh)
    try:
        asked, file = _request(options), _intake(options)
        if file is not None and not file.has_more:
            found = targets.collect([_object_of(options, file)], asked)
            return [(options, [_of_file(target, file) for target in found])]
        objects = _named(options, _mesh_objects(options))
        if asked.vertices is not None and len(objects) > 1:
            raise UsageError("vertices are chosen on one object: name it with --object")
        bpy.context.view_layer.update()  # the objects' matrices
        return [(own, targets.collect(some, _request(own))) for own, some in _by_dials(options, objects)]
    except ValueError as error:
        raise UsageError(str(error)) from error
    except (holomorph.Error, exchange.ExchangeError) as error:
        raise Refused(str(error)) from error


def _check_mesh(path):
    """@throws UsageError where it is that of no mesh file"""
    if path is None:
        return
    if not path.is_file():
        raise UsageError(f"{path}: there is no such file")
    known = (*module("files.formats").POLYGONAL, *exchange.SCENES)
    if path.suffix.lower() not in known:
        raise UsageError(f"{path}: the file name must end in {', '.join(known[:-1])} or {known[-1]}")


def _by_dials(options, objects):
    """[(options, objects)] by the dials that they store; a mesh has those of its first object."""
    dials, groups = {}, []
    for obj in objects:
        stored = dials.setdefault(obj.data, stored_dials.chosen(obj))
        own = options_of.for_object(options, stored)
        alike = next((some for other, some in groups if other == own), None)
        if alike is None:
            groups.append((own, [obj]))
        else:
            alike.append(obj)
    return groups


def _request(options):
    """What is asked of every object; vertices are named for a single one. @throws ValueError"""
    solvers = holomorph.SOLVERS
    if options.solver not in solvers:
        raise UsageError(f"--solver: {options.solver!r} is not one of {', '.join(solvers)}")
    asked = replace(request.choices(options), solver=options.solver)
    if asked.faces != jobs.ASKED:
        asked = replace(asked, faces=jobs.WHOLE)
    if options.pole:
        return replace(asked, use=jobs.POLES, vertices=tuple(options.pole))
    if options.rectangle:
        return replace(asked, use=jobs.RECTANGLE, vertices=tuple(options.rectangle))
    return asked


def _intake(options):
    """The package's `Intake` of the mesh file, None without one and of what Blender alone reads. An OBJ file that has
    more than polygons is for Blender to read, which does not tell what it leaves out."""
    if options.mesh is None or options.mesh.suffix.lower() in exchange.SCENES:
        return None
    file = intake.read(options.mesh, options.up)
    told = [refused.reason for refused in file.surface.refused] if file.has_more else file.surface.repairs.notes
    options.warnings += [f"{options.mesh}: {sentence}" for sentence in told]
    return file


def _object_of(options, file):
    """The polygons of an `Intake` as an object, in an otherwise empty scene unless a .blend was opened."""
    _empty_scene()
    points, place = near_origin(file.vertices)
    mesh = mesh_io.new_mesh(options.mesh.stem, points, file.corner_vertices, file.face_offsets)
    mesh_io.shade_smooth(mesh, SHARP_ANGLE)
    obj = bpy.data.objects.new(mesh.name, mesh)
    obj.location = intake.upright(place, file.surface.up)
    if file.surface.up == "Y":
        obj.rotation_euler.x = Z_UP_FROM_Y_UP
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj


def _of_file(target, file):
    """The target of the object with the positions of the file, more precise than Blender's, and the faces that were
    left out of it."""
    vertices = intake.upright(near_origin(file.vertices)[0], file.surface.up)
    return replace(target, polygons=replace(target.polygons, vertices=vertices, left_out=file.surface.refused))


def _empty_scene():
    if not bpy.data.filepath:
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)


def _mesh_objects(options):
    if options.mesh is not None:
        _empty_scene()
        return exchange.read(options.mesh, options.up or "Y")
    if not bpy.data.filepath:
        raise UsageError("name a mesh file after --, or a .blend file before --python")
    objects = compatibility.objects_in(bpy.context.view_layer)
    return [o for o in objects if o.type == "MESH" and not gathering.is_helper(o)]


def _named(options, meshes):
    """The mesh objects that --object names, or all."""
    missing = set(options.object) - {o.name for o in meshes}
    if missing:
        raise UsageError(f"there is no mesh object named {sorted(missing)[0]!r} in the scene")
    if options.object:
        meshes = [o for o in meshes if o.name in options.object]
    if not meshes:
        raise Refused("there is no mesh object in the scene")
    return meshes
