# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of the tile operator, in Blender's main thread: what was tiled is written to the objects and reported."""

from dataclasses import dataclass

import numpy as np

from .. import native
from ..maps import tiling
from ..materials import material, patterns
from ..scene import faces, mesh_edges, mesh_io
from . import empties, heat, report, restore, run, tile_report

CHECKER_CELLS = 4  # squares across an image of the checker


@dataclass(frozen=True)
class TileWriteOptions:
    """What is written besides the map, and what needs no new tiling."""

    quarters: int = 0  # turns of the texture by 90 degrees
    checker: bool = True  # whether the map is shown by a material
    texture: str = material.CHECKER
    repeats: int = 1  # images of the texture across a tile
    seams: bool = False
    empties: bool = False
    pole_group: str = ""  # see `tile_choices.allowed`


def write(context, targets, results, options, time_has_passed=False):
    """Writes the tiling of every object and reports every other; an object that is refused is not touched."""

    def write_object(outcome, obj, polygons, tiled):
        _problems(outcome, obj, tiled)
        if tiled.done:
            _write_object(context, outcome, obj, polygons, tiled, options)
        else:
            outcome.entries.append(_entry(obj, tiled, [], 0, options))

    return run.write_each(context, targets, results, write_object, time_has_passed)


def _problems(outcome, obj, tiled):
    for index, part in enumerate(tiled.parts, 1):
        if part.tiling is None:
            which = "" if len(tiled.parts) == 1 else f"part {index} of {len(tiled.parts)} "
            outcome.problems.append(f"{obj.name}: {which}skipped: {native.sentence(part.reason)}")
    outcome.problems += run.surface_problems(obj, tiled.solved.surface)


def _write_object(context, outcome, obj, polygons, tiled, options):
    mesh = obj.data
    restore.remember(mesh)
    if polygons.faces is None:
        mesh_io.remove_maps(mesh)
    written = mesh_io.write_map(mesh, polygons, mesh_io.MAIN_MAP, tiling.placed(tiled, options.quarters))
    mesh_io.add_own_maps(mesh, [written.name])
    mesh_io.show_map(mesh, written.name)
    cuts = [_seam_pairs(tiled), faces.border(mesh, polygons)] if options.seams else []
    new_seams = mesh_edges.add_seams(mesh, np.concatenate(cuts)) if cuts else 0
    if options.checker:
        _show(outcome, obj, tiled, written, options)
    heat.refresh(obj)
    mesh.update()
    entry = run.with_coarse_places(obj, polygons, _entry(obj, tiled, [written], new_seams, options))
    report.store_on_object(obj, entry)
    empties.remove(obj)
    if options.empties:
        empties.write(context, obj, *tile_report.marks(obj[report.PROPERTY]))
    outcome.entries.append(entry)
    outcome.done.append(obj.name)
    run.judge(outcome, obj, entry)


def _entry(obj, tiled, written, new_seams, options):
    parts = [tile_report.part_report(part) for part in tiled.parts]
    entry = report.object_report(obj, tiled.solved, written, new_seams, options, parts)
    return entry | {"asked": tile_report.asked(tiled.options)}


def _seam_pairs(tiled):
    return np.concatenate([part.vertices(part.tiling.seams) for part in tiled.done])


def _show(outcome, obj, tiled, written, options):
    if not outcome.looks:
        is_checker = options.texture == material.CHECKER
        cells = CHECKER_CELLS if is_checker else patterns.TEXTURES[options.texture].cells
        outcome.looks[True] = material.Look(options.texture, options.repeats * cells, tiled.unit_length, is_tiling=True)
    material.cover(obj, material.showing(written.name, written.kind == "attribute", outcome.looks[True]))
