# SPDX-License-Identifier: GPL-3.0-or-later
"""The main map of a solve where it is a seamless tiling, and which parts get one. Arrays only, no bpy.

All parts of an object have the same texel density: that of its largest tiling.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import native
from ..scene.mesh_io import MAIN_MAP
from . import maps, tiling


@dataclass(frozen=True)
class MappedObject:
    """A solve, and the tilings in its main map."""

    solved: object  # `solve.SolvedObject`
    tiled: object  # `tiling.TiledObject`

    @property
    def done(self):
        """The parts that have maps."""
        return self.solved.done


class Mapper:
    """Makes the `MappedObject` of one solve after the other; where they are to be equal, as many tiles for their area
    are asked for as of the first tiling, and other maps have the density that it got."""

    def __init__(self, options, is_equal=True):
        self._options, self._is_equal = options, is_equal
        self._density = self._per_length = 0.0  # tiles for an area, and UV units for a length

    def __call__(self, solved, progress=None):
        made = tiled(solved, self._options, progress, self._density)
        if self._is_equal and made.done and not self._density:
            self._density, self._per_length = made.density, 1 / made.unit_length
        return MappedObject(solved, made)

    def options(self, results):
        """The options with which the maps of these results have one texel density."""
        mapped = [made for made in results if isinstance(made, MappedObject) and made.done]
        if not self._is_equal or len(mapped) < 2:
            return self._options
        fitting = min(maps.filling(made.solved, self._options) for made in mapped)
        per_length = self._per_length or (fitting if math.isfinite(fitting) else 0.0)
        return replace(self._options, per_length=per_length)


def tiled(solved, options, progress=None, density=0.0):
    """The `tiling.TiledObject` of the parts whose main map is a tiling, and of those that ask for one and are refused.
    What was made is kept with the parts: a second call is quick.

    density : tiles for an area; 0 lets the library choose for the largest part, and the others follow
    """
    asked = sorted((c for c in solved.done if _may_be_tiled(c, options)), key=lambda c: -c.area)
    total, done, made = sum(c.area for c in asked), 0.0, {}
    for component in asked:
        share = component.area / total
        part = _part(component, options.main, density, tiling.scaled(progress, done, share))
        done += share
        if part is not None:
            made[id(component)] = part
            density = density or (part.tiling.tiles / component.area if part.tiling else 0.0)
    return tiling.TiledObject(solved, tuple(made[id(c)] for c in solved.components if id(c) in made))


def _may_be_tiled(component, options):
    if options.main != maps.AUTOMATIC:
        return options.main == maps.SEAMLESS
    return options.are_plain and not component.is_chosen and component.area > 0


def _part(component, main, density, progress):
    """The `tiling.TiledPart` of a part by `holomorph.automatic_map`; None where the balanced map stays."""
    key = main, density
    if key not in component.tilings:
        component.keep_tiling(key, _automatic_part(component, main, density or None, progress))
    return component.tilings[key]


def _automatic_part(component, main, density, progress):
    holomorph = native.load()
    options = {"main": main.lower(), "density": density, "progress": progress}
    try:
        made = holomorph.automatic_map(component.surface, component.structure, **options)
    except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError) as error:
        return tiling.TiledPart(component, None, str(error))
    if made.tiling:
        return tiling.TiledPart(component, made.tiling)
    maps.keep_main_map(component, maps.MapOptions(), made.quality)
    return None


def map_values(solved, options, tiled):
    """As `maps.map_values`, with the tilings of `tiled` in the main map, and the other parts beside them."""
    for index, name in enumerate(maps.map_names(solved, options)):
        is_seamless = name == MAIN_MAP and tiled.done
        yield name, _main_values(solved, options, tiled) if is_seamless else maps.values(solved, index, options)


def _main_values(solved, options, tiled):
    """The tilings from (0, 0) on, and to the right of them the other parts at the same texel density."""
    result = tiling.placed(tiled)
    rest = replace(solved, components=tuple(others(solved, tiled)))
    if not rest.done:
        return result
    plain = replace(options, density=1.0, per_length=0.0)
    density = maps.unit_length(rest, plain) / tiled.unit_length
    values = maps.values(rest, 0, replace(plain, density=density))
    corners = np.concatenate([part.surface.corner_index for part in rest.done])
    low, right = maps.CENTRE.real - density / 2, math.ceil(result[:, 0].max())
    result[corners] = values[corners] + np.float32([right + options.margin * density - low, -low])
    return result


def others(solved, tiled):
    """The components whose main map is no tiling."""
    own = {id(part.component) for part in tiled.done}
    return [component for component in solved.components if id(component) not in own]
