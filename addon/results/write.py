# SPDX-License-Identifier: GPL-3.0-or-later
"""The end of a run, in Blender's main thread: maps are written to the objects and reported."""

from dataclasses import dataclass, field, replace

import numpy as np

from .. import native
from ..maps import mapped, packing
from ..materials import material
from ..scene import gathering, mesh_io, stored_dials, targets, uv_maps
from ..solving.jobs import REFUSALS
from ..writing import transaction
from . import heat, points, report, restore, stored, tags
from .report import Outcome, with_coarse_places


@dataclass(frozen=True)
class WriteOptions:
    """What is written besides the maps."""

    shown: int = 0  # 0 the main map, j the map of form j
    checker: bool = True  # whether the map is shown by a material
    texture: str = material.CHECKER  # what it shows
    checker_scale: float = 0.0  # squares, bricks, scales ... per UV unit; 0 lets the first object decide
    seams: bool = False
    shape: bool = False  # the conformal image in space
    empties: bool = False  # at poles and branch points
    size: float = 0.0  # width of an image of the texture on the surface; 0 for the number of squares
    own: object | None = None  # `user_texture.Own`: the texture is one of the user's
    together: int = 1  # objects whose tiles have one size
    repeats: int = 1  # images of the texture side by side in a tile, at least
    stored: dict = field(default_factory=dict)  # the dials of which the maps are made


def write(step, found, results, options, time_has_passed=False):
    """Writes the maps of every `mapped.MappedObject` and reports every other result; an object that is refused is not
    touched. Gives the `Outcome`.

    found : the `targets.Target`s; step : the `transaction.Step` of their objects
    time_has_passed : Blender was alive during the solve, so each mesh is compared with what was read
    """
    outcome = Outcome(objects=targets.objects(found))
    for target, result in zip(found, results):
        reason = _why_not(target, result, time_has_passed)
        if reason:
            outcome.refuse(target.name, reason)
        elif not result.done:
            outcome.skip(target.find(), result)
        else:
            with transaction.naming(target):
                _write_object(step, outcome, target, result, options)
    if outcome.done:
        report.store_text(outcome.entries)
        step.discard(material.unused_copies())
        outcome.notes += [f"{options.own.name}: {options.own.text}"] if options.own else []
    return outcome


def _why_not(target, result, time_has_passed):
    """Why nothing is written to an object, or ""."""
    if target.refused:
        return target.refused
    if isinstance(result, REFUSALS):
        return native.sentence(result)
    has_changed = target.has_changed(time_has_passed)
    return "it changed during the solve; please run it again" if has_changed else ""


def _write_object(step, outcome, target, made, options):
    obj, polygons = target.find(), target.polygons
    if target.makes_object:
        obj = tags.modifier_result(step, obj)
        outcome.objects.append(obj)
    if made.main == mapped.ISLANDS:
        made = packing.packed(step.context, made)
    restore.remember(obj.data)
    written, new_seams = _write_maps(obj.data, polygons, made, options)
    if options.checker:
        shown = _shown(written, options)
        look = _look(made, options, shown is written[0] and bool(made.tiled))
        look = outcome.looks.setdefault((look.is_tiling, look.is_turned), look)
        covering = outcome.covering(shown, look)
        for each in (obj, *target.find_sharers()):
            material.cover(each, covering)
    heat.refresh(obj)
    obj.data.update()
    for each in (obj, *gathering.others(obj)):
        stored_dials.write(each, points.kept(options.stored, made, obj.data))
    options = replace(options, stored=stored_dials.of(obj))
    entry = report.object_report(obj, made, written, new_seams, options)
    entry = with_coarse_places(obj, polygons, entry)
    report.store(obj, entry)
    step.remove(tags.empties_of(obj))
    if options.empties:
        vertices, kinds = stored.points(obj, whole=True)
        is_pole, is_marked = kinds == stored.POLE, kinds != stored.CONE
        tags.write_empties(step.context, obj, vertices[is_marked], is_pole[is_marked])
    outcome.add(obj, target, made, written, entry)


def _write_maps(mesh, polygons, made, options):
    """Maps, seams and shape; gives the `uv_maps.WrittenMap`s and the number of new seams."""
    if polygons.faces is None:
        uv_maps.remove_maps(mesh)
    written = [uv_maps.write_map(mesh, polygons, name, uv) for name, uv in made.maps()]
    uv_maps.add_own_maps(mesh, [w.name for w in written])
    uv_maps.show_map(mesh, _shown(written, options).name)
    new_seams = mesh_io.add_seams(mesh, _cuts(mesh, polygons, made)) if options.seams else 0
    shape = mapped.shape_points(made.solved) if options.shape else None
    if shape is not None:
        uv_maps.write_shape(mesh, shape)
    return written, new_seams


def _shown(written, options):
    return written[min(options.shown, len(written) - 1)]


def _cuts(mesh, polygons, made):
    """(#S,2) vertices of the object: where the main map is cut, and where the mapped faces end."""
    islands = packing.cuts([part.component.surface for part in made.parts])
    return np.concatenate([islands, targets.border(mesh, polygons), *(part.seams for part in made.done)])


def _look(made, options, is_tiling):
    """A tiling gets as many images in each tile as come nearest to the wanted number of squares. Elsewhere density is
    to be seen: the squares are those of density 1, so that there are more of them where it is higher."""
    if is_tiling:
        cells = material.cells(options.texture)
        cells *= max(options.repeats, round(options.checker_scale / cells))
        turns = max(part.map.turns for part in made.tiled)
        own = options.own and options.own.on_turned(turns)
        return material.Look(options.texture, cells, made.unit_length, True, own, turns != 1)
    plain = made.of_forms()
    cells = options.checker_scale
    if options.size and plain.unit_length:
        cells = material.cells(options.texture) * plain.unit_length / options.size
    cells = cells or plain.squares_that_fit(material.across(options.texture))
    return material.Look(options.texture, cells, plain.unit_length, own=options.own)
