# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of a solve: the main one, of tilings or of forms part by part, and those of single forms. No bpy here."""

import math
from dataclasses import dataclass, replace

import numpy as np

from .. import native
from ..scene.uv_maps import MAIN_MAP
from . import forms
from .options import AUTOMATIC, BALANCED, SEAMLESS, TILING, MapOptions, dials

MIXED_EVENED = 20_000  # triangles up to which maps are evened while forms are mixed: it takes 0.2 s

MAINS = {AUTOMATIC: "automatic", SEAMLESS: "seamless", TILING: "seamless"}  # as `holomorph.automatic_maps` names them


@dataclass(frozen=True)
class MappedPart:
    """The main map of one part."""

    component: object  # `solve.SolvedComponent`
    map: object | None = None  # the `holomorph.Map`, its vertices as the part counts them
    skipped: str = ""  # why it has no map
    not_seamless: str = ""  # why it has another map than the tiling that was asked for

    @property
    def tiling(self):
        """The `holomorph.Tiling`, None where the map is none."""
        return self.map.tiling if self.map else None

    def vertices(self, own):
        """Vertices of the whole object."""
        return self.component.surface.vertex_index[np.asarray(own, np.int64)]

    @property
    def seams(self):
        """(#S, 2) vertices of the whole object: where the main map is cut."""
        made, structure = self.map.own, self.component.structure
        return self.vertices(made.seams) if made else structure.edges[structure.seams]


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
        """The parts whose main map is a tiling, or has tilings of pieces."""
        return [part for part in self.parts if part.map and part.map.is_tiled]

    @property
    def part_maps(self):
        """The `holomorph.Map`s of the parts that have one."""
        return [part.map for part in self.done]

    @property
    def unit_length(self):
        """The length on the surface of a UV unit of the main map, where the density is the median one; 0 for maps
        without area."""
        return native.load().arrangement.unit_length(self.part_maps, self.options.arrangement)

    @property
    def filling(self):
        """`options.MapOptions.per_length` with which maps of forms fill the UV square; infinite where none has area."""
        return native.load().arrangement.square(self.part_maps, self.options.arrangement).filling

    def of_forms(self):
        """The same parts with maps of forms alone."""
        if not self.tiled:
            return self
        conformal = replace(self.options.tiling, evenness=0.0)
        return mapped(self.solved, replace(self.options, main=BALANCED, tiling=conformal))

    def maps(self):
        """Yields (name, (#C, 2) float32) for every map, the main one first; parts that lack it are zero there."""
        yield MAIN_MAP, self._main_map() if self.packed is None else self.packed
        count = 0 if self.packed is not None else min(self.solved.form_count, self.options.forms)
        parts, library = [(one.surface, one.structure) for one in self.solved.done], native.load().arrangement
        for index in range(count):
            uv = library.arranged_form(parts, index, self._corners, self.options.arrangement)
            yield f"{MAIN_MAP} {index + 1}", uv.astype(np.float32)

    def _main_map(self):
        arranged = native.load().arrangement.arranged(self.part_maps, self._corners, self.options.arrangement)
        return arranged.astype(np.float32)

    @property
    def _corners(self):
        return len(self.solved.polygons.corner_vertices)


class Mapper:
    """Makes the `MappedObject` of one solve after the other. Where their texels are to be equal, a number of tiles is
    over all of them: the one with the largest part is made with its share, and the others with the density of that."""

    def __init__(self, is_equal=True):
        self._is_equal = is_equal
        self._area = self._wanted = 0.0  # the area of all objects; tiles for an area that are asked for
        self._density = self._per_length = 0.0  # tiles for an area, and UV units for a length, once one is made

    def plan(self, solved):
        """The order in which to map: indices of `{index: solve.SolvedObject}`."""
        if not self._is_equal:
            return list(solved)
        surfaces = [component.surface for one in solved.values() for component in one.done]
        self._area = sum(surface.area for surface in surfaces)
        self._wanted = native.load().maps.sizing.usual_density(surfaces)
        return sorted(solved, key=lambda index: -max((part.area for part in solved[index].done), default=0.0))

    def __call__(self, solved, options, progress=None):
        if not self._is_equal:
            return mapped(solved, options, progress)
        made = mapped(solved, replace(options, tiling=self._shared(solved, options.tiling)), progress)
        self._density = self._density or _middle_density(made) or self._asked(options.tiling)
        if made.tiled and not self._per_length and made.unit_length > 0:
            self._per_length = 1 / made.unit_length
        return made

    def _shared(self, solved, wanted):
        """The `options.TileOptions` for one of the objects."""
        if self._density:
            return replace(wanted, density=self._density, tiles=0.0, is_shared=True)
        share = sum(component.area for component in solved.done) / self._area if self._area else 1.0
        return replace(wanted, tiles=share * wanted.tiles)

    def _asked(self, wanted):
        if wanted.density:
            return wanted.density
        return wanted.tiles / self._area if wanted.tiles and self._area else self._wanted

    def equalised(self, results):
        """The same results, but that the maps of forms in them have one texel density."""
        found = [made for made in results if isinstance(made, MappedObject) and made.done]
        if not self._is_equal or len(found) < 2:
            return results
        per_length = self._per_length or min(made.filling for made in found)
        if not math.isfinite(per_length):
            return results
        return [_with_length(made, per_length) if isinstance(made, MappedObject) else made for made in results]


def _with_length(made, per_length):
    return replace(made, options=replace(made.options, per_length=per_length))


def _middle_density(made):
    """Tiles for an area, from which no tiling of an object is far; 0 without one."""
    found = [part.map.density for part in made.tiled]
    return math.sqrt(min(found) * max(found)) if found else 0.0


def mapped(solved, options, progress=None):
    """The `MappedObject` of a solve. What was made is kept with it: a second call is quick."""
    mains = tuple(_main(component, options) for component in solved.done)
    asked = mains, options.main == TILING, options.tiling.made, options.amounts, options.turns
    if asked not in solved.maps:
        solved.keep_maps(asked, _parts(solved.done, mains, options, progress))
    made = iter(solved.maps[asked])
    parts = [MappedPart(one, skipped=one.reason) if one.structure is None else next(made) for one in solved.components]
    return MappedObject(solved, options, tuple(parts))


def _main(component, options):
    """The main map that the library is asked for, "" for one of forms."""
    is_plain = options.are_plain and not component.is_chosen and component.area > 0
    return MAINS.get(options.main, "") if is_plain or options.main != AUTOMATIC else ""


def _parts(components, mains, options, progress):
    """The `MappedPart`s; refusals are told. What no tiling fits gets another map, if what is chosen fits anywhere."""
    found = _tilings([pair for pair in zip(components, mains) if pair[1]], options, progress)
    made = [next(found) if main else None for main in mains]
    reasons = [_refusal(one) for one in made]
    if options.main == TILING and options.tiling.is_chosen and all(reasons):
        return [MappedPart(component, skipped=reason) for component, reason in zip(components, reasons)]
    return [_part(*each, options, progress) for each in zip(components, made, reasons)]


def _refusal(made):
    return native.sentence(made) if isinstance(made, native.load().Error) else ""


def _part(component, made, refusal, options, progress):
    """With another map than a tiling that is refused; of forms where none is asked for."""
    if refusal:
        of_part, dial = (component.surface, component.structure), dials(options.tiling)
        made = native.load().automatic_map(*of_part, main="untiled", **dial)
    elif made is None:
        made = _form_map(component, options, progress)
    return MappedPart(component, made, not_seamless=refusal)


def _form_map(component, options, progress):
    """The `holomorph.Map` of forms; evening is the last part of the work."""
    is_slow = options.are_mixed and len(component.surface.triangles) > MIXED_EVENED
    return native.load().form_map(
        component.surface,
        component.structure,
        forms.coefficients(component, options),
        evenness=0.0 if is_slow else options.tiling.evenness,
        progress=native.load().core.progress.scaled(progress, 1.0, 1.0),
    )


def _tilings(asked, options, progress):
    """An iterator over what `holomorph.automatic_maps` gives for pairs of a component and its main map."""
    wanted, components = options.tiling, [component for component, _ in asked]
    made = native.load().automatic_maps(
        [component.surface for component in components],
        [component.structure for component in components],
        main=[main for _, main in asked],
        tiles=None if wanted.density else wanted.tiles or None,
        density=wanted.density or None,
        **({"density_tolerance": 0.0} if wanted.is_shared else {}),
        poles=wanted.poles,
        allowed=None if wanted.allowed is None else np.frombuffer(wanted.allowed, bool),
        moves=wanted.moved,
        lattice=wanted.lattice,
        direction=wanted.direction,
        boundary=wanted.boundary,
        turn=wanted.turn or None,
        progress=progress,
        **dials(wanted),
    )
    return iter(made)
