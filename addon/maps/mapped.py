# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of a solve: the main one, of tilings or of forms part by part, and those of single forms. No bpy here.

All parts of the button's maps have the same texel density: that of the object's largest tiling.
"""

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import native
from ..scene.uv_maps import MAIN_MAP
from . import forms, tiling
from .options import AUTOMATIC, SEAMLESS, TILING, MapOptions


@dataclass(frozen=True)
class MappedPart:
    """The main map of one part: a tiling, the balanced map of its forms, or none."""

    component: object  # `solve.SolvedComponent`
    tiling: object | None = None  # the `holomorph.Tiling`, its vertices as the part counts them
    skipped: str = ""  # why it has no map
    not_seamless: str = ""  # why it has another map than the tiling that was asked for

    def vertices(self, own):
        """Vertices of the whole object."""
        return self.component.surface.vertex_index[np.asarray(own, np.int64)]

    @property
    def seams(self):
        """(#S, 2) vertices of the whole object: where the main map is cut."""
        structure = self.component.structure
        return self.vertices(self.tiling.seams) if self.tiling else structure.edges[structure.seams]


@dataclass(frozen=True)
class MappedObject:
    """The parts of one object in the library's order."""

    solved: object  # `solve.SolvedObject`
    options: MapOptions
    parts: tuple
    packed: np.ndarray | None = None  # (#C, 2) the main map where Blender has packed its islands

    @property
    def done(self):
        """The parts that have maps."""
        return [part for part in self.parts if not part.skipped]

    @property
    def tiled(self):
        """The parts whose main map is a tiling."""
        return [part for part in self.parts if part.tiling]

    @property
    def density(self):
        """Tiles for an area on the surface, where there is the median of them; 0 without a tiling."""
        area = sum(part.component.area for part in self.tiled)
        return sum(part.tiling.tiles for part in self.tiled) / area if area > 0 else 0.0

    @property
    def unit_length(self):
        """The length on the surface of a UV unit of the main map, where the density is the median one; 0 for maps
        without area."""
        if not self.tiled:
            return forms.unit_length(self.solved, self.options)
        density = np.median([part.tiling.quality.median_density for part in self.tiled])
        return 1 / math.sqrt(density) if density > 0 else 0.0

    def maps(self):
        """Yields (name, (#C, 2) float32) for every map, the main one first; parts that lack it are zero there."""
        yield MAIN_MAP, self._main_map()
        count = 0 if self.packed is not None else min(self.solved.form_count, self.options.forms)
        for index in range(1, 1 + count):
            yield f"{MAIN_MAP} {index}", forms.values(self.solved, index, self.options)

    def _main_map(self):
        """Tilings from (0, 0) on, and to the right of them the other parts at the same texel density."""
        if self.packed is not None:
            return self.packed
        if not self.tiled:
            return forms.values(self.solved, 0, self.options)
        result = tiling.placed(self.solved, self.tiled, self.options.tiling.quarters)
        rest = replace(self.solved, components=tuple(part.component for part in self.done if not part.tiling))
        if not rest.done:
            return result
        plain = replace(self.options, density=1.0, per_length=0.0)
        density = forms.unit_length(rest, plain) / self.unit_length
        values = forms.values(rest, 0, replace(plain, density=density))
        corners = np.concatenate([part.surface.corner_index for part in rest.done])
        low, right = forms.CENTRE.real - density / 2, math.ceil(result[:, 0].max())
        result[corners] = values[corners] + np.float32([right + self.options.margin * density - low, -low])
        return result


class Mapper:
    """Makes the `MappedObject` of one solve after the other. Where their texels are to be equal, as many tiles for
    their area are asked for as of the first tiling, and other maps have the density that it got."""

    def __init__(self, is_equal=True):
        self._is_equal = is_equal
        self._density = self._per_length = 0.0  # tiles for an area, and UV units for a length

    def __call__(self, solved, options, progress=None):
        made = mapped(solved, options, progress, self._density)
        if self._is_equal and made.tiled and not self._density:
            self._density = made.density
            self._per_length = 1 / made.unit_length if made.unit_length > 0 else 0.0
        return made

    def equalised(self, results):
        """The same results, but that the maps of forms in them have one texel density."""
        found = [made for made in results if isinstance(made, MappedObject) and made.done]
        if not self._is_equal or len(found) < 2:
            return results
        per_length = self._per_length or min(forms.filling(made.solved, made.options) for made in found)
        if not math.isfinite(per_length):
            return results
        return [_with_length(made, per_length) if isinstance(made, MappedObject) else made for made in results]


def _with_length(made, per_length):
    return replace(made, options=replace(made.options, per_length=per_length))


def mapped(solved, options, progress=None, density=0.0):
    """The `MappedObject` of a solve. What was made is kept with the parts: a second call is quick.

    density : tiles for an area; 0 for the number that the options ask for
    """
    asked = [component for component in solved.done if _may_be_tiled(component, options)]
    total, done, made = sum(component.area for component in asked), 0.0, {}
    tiles, is_button = density * total or options.tiling.tiles, options.main != TILING
    for component in sorted(asked, key=lambda one: -one.area) if is_button else asked:
        share = component.area / total if total > 0 else 1.0
        own = tiling.own_options(component, options.tiling, density * component.area if is_button else tiles * share)
        step = native.load().progress.scaled(progress, done, done + share)
        part = made[id(component)] = _part(component, options.main, own, step)
        density = density or (part.tiling.tiles / component.area if is_button and part.tiling else 0.0)
        done += share
    parts = [made.get(id(one)) or MappedPart(one, skipped=one.reason) for one in solved.components]
    return MappedObject(solved, options, tuple(parts))


def _may_be_tiled(component, options):
    if options.main != AUTOMATIC:
        return options.main in (SEAMLESS, TILING)
    return options.are_plain and not component.is_chosen and component.area > 0


def _part(component, main, options, progress):
    """The `MappedPart` by these `TileOptions`; what was made, or refused, before is kept."""
    key = main, options
    if key not in component.tilings:
        component.keep_tiling(key, _new_part(component, main, options, progress))
    return component.tilings[key]


def _new_part(component, main, options, progress):
    holomorph = native.load()
    try:
        if main != AUTOMATIC:
            return MappedPart(component, tiling.tile(component, options, progress))
        tiles = options.tiles or None
        made = holomorph.automatic_map(component.surface, component.structure, tiles=tiles, progress=progress)
    except (holomorph.InvalidMesh, holomorph.TopologyError, holomorph.SolverError) as error:
        reason = native.sentence(error)
        return MappedPart(component, skipped=reason) if main == TILING else MappedPart(component, not_seamless=reason)
    if not made.tiling:
        forms.keep_main_map(component, MapOptions(), made.quality)
    return MappedPart(component, made.tiling)
