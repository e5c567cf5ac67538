# SPDX-License-Identifier: GPL-3.0-or-later
"""The work of a bake: an atlas, then one pass for each object and channel. Nothing of the file is changed by it."""

from contextlib import closing
from dataclasses import dataclass, field, fields, replace
from pathlib import Path

import bpy
import numpy as np

from .. import native
from ..scene import gathering, mesh_io, stored_dials, uv_maps
from ..solving.jobs import Work
from . import atlas, bake_scene
from .channels import CHANNELS, ONE, BakeOptions

UNFOLDING = 0.3  # of the work


@dataclass(frozen=True, eq=False)
class Baked:
    """Images of some objects, and the map that they lie on with."""

    names: list  # of the objects
    polygons: list  # `mesh_io.Polygons` of each
    atlas: atlas.Atlas
    images: dict = field(default_factory=dict)  # channel: bytes of a file


def why_not(obj):
    """Why an object cannot be baked, one sentence, or ""."""
    if gathering.why_fixed(obj):
        return gathering.why_fixed(obj)
    made = stored_dials.made(obj)
    if made is None or not made.is_tiled or not uv_maps.main_map(obj.data):
        return "it has no seamless tiling to bake; press Seamless Tiling first (other maps need no bake)"
    if not obj.material_slots:
        return "it has no material to bake"
    return "" if uv_maps.has_room_for_bake_map(obj.data) else "no UV map slot is free for the bake; remove a UV map"


def bakeable(objects):
    """The objects that are baked, one of each mesh. @throws ValueError one of them cannot be"""
    if "cycles" not in bpy.types.Scene.bl_rna.properties:
        raise ValueError("Cycles is off: enable it in the preferences, among the add-ons")
    for obj in objects:
        reason = why_not(obj)
        if reason:
            raise ValueError(f"{obj.name}: {reason}")
    return one_of_each_mesh(objects)


def one_of_each_mesh(objects):
    """The first object of each mesh, in their order."""
    return list({obj.data: obj for obj in reversed(objects)}.values())[::-1]


def options(properties):
    """The `BakeOptions` of properties of the same names. @throws ValueError"""
    if not properties.channels:
        raise ValueError("choose a channel to bake")
    folder = properties.folder
    if folder and not Path(bpy.path.abspath(folder)).is_dir():
        raise ValueError(f"the folder {folder} does not exist")
    names = (one.name for one in fields(BakeOptions))
    return BakeOptions(**{name: getattr(properties, name) for name in names})


class BakeWork(Work):
    """Bakes objects in Blender's main thread, a pass whenever it is asked whether it is running.

    `baked` are the `Baked` in the end; `error` says why there are none.
    """

    def __init__(self, context, objects, options, progress=None):
        super().__init__(progress)
        self.baked = []
        self._passes = self._bake(context, objects, options)

    def start(self):
        """There is no thread."""

    def is_running(self):
        return self._goes_on()

    def run(self):
        with closing(self._passes):
            while self._goes_on():
                pass

    def cancel(self):
        super().cancel()
        self._passes.close()

    def _goes_on(self):
        try:
            self.watch(*next(self._passes))
        except StopIteration:
            return False
        except (ValueError, RuntimeError, MemoryError) as error:
            self._passes.close()
            self.error = error
            return False
        return True

    def _bake(self, context, objects, options):
        """Yields (the fraction that is done, what comes next)."""
        channels = [channel for channel in CHANNELS if channel in options.channels]
        groups = [objects] if options.images == ONE else [[obj] for obj in objects]
        baked, count = [], len(objects) * len(channels)
        with bake_scene.bake_scene() as made:
            for index, group in enumerate(groups):
                yield UNFOLDING * index / len(groups), f"unfolding {group[0].name}"
                baked.append(_unfolded(context, group, options))
            done = 0
            for one in baked:
                copies = [_copy(made, *each) for each in zip(one.names, one.polygons, one.atlas.uvs)]
                for channel in channels:
                    image = made.new_image(channel, one.atlas.side)
                    for name, (copy, map_name) in zip(one.names, copies):
                        yield UNFOLDING + (1 - UNFOLDING) * done / count, f"baking {channel.lower()} of {name}"
                        made.bake(copy, map_name, channel, image, options.room)
                        done += 1
                    image.pack()
                    one.images[channel] = image.packed_file.data
        self.baked = baked


def _unfolded(context, group, options):
    """The `Baked` of some objects, without images yet. @throws ValueError"""
    metres = context.scene.unit_settings.scale_length
    polygons = [mesh_io.read(obj) for obj in group]
    in_metres = [replace(one, vertices=one.vertices * metres) for one in polygons]
    try:
        found = atlas.make(context, in_metres, options)
    except ValueError as error:
        raise ValueError(f"{group[0].name}: {native.sentence(error)}") from error
    return Baked([obj.name for obj in group], polygons, found)


def _copy(made, name, polygons, uv):
    """(copy of an object in the scene, name of its map for the bake)."""
    obj = bpy.data.objects[name]
    try:
        copy = made.add(obj)
    except ValueError as error:
        raise ValueError(f"{name}: {error}") from error
    map_name = uv_maps.write_bake_map(copy.data, polygons, np.asarray(uv, np.float32))
    copy.data.uv_layers.active = copy.data.uv_layers[map_name]  # whose tangents normals are told in
    return copy, map_name
