# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of solves: the main one, of tilings or of forms part by part, and those of single forms. No bpy here."""

from dataclasses import astuple, dataclass, replace

import numpy as np

from .. import native
from ..native import holomorph
from ..scene.uv_maps import MAIN_MAP
from . import forms
from .options import AUTOMATIC, BALANCED, SEAMLESS, TILING, MapOptions

MIXED_EVENED = 20_000  # triangles up to which maps are evened while forms are mixed: it takes 0.2 s

MAINS = {AUTOMATIC: "automatic", SEAMLESS: "seamless", TILING: "seamless"}  # as `holomorph.automatic_maps` names them


@dataclass(frozen=True)
class MappedPart:
    """The main map of one part."""

    component: object  # `PartStructure` of the package
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
        return holomorph.arrangement.unit_length(self.part_maps, self.options.arrangement)

    def of_forms(self):
        """The same parts with maps of forms alone."""
        if not self.tiled:
            return self
        conformal = replace(self.options.tiling, evenness=0.0)
        return mapped([self.solved], [replace(self.options, main=BALANCED, tiling=conformal)])[0]

    def maps(self):
        """Yields (name, (#C, 2) float32) for every map, the main one first; parts that lack it are zero there."""
        yield MAIN_MAP, self._main_map() if self.packed is None else self.packed
        count = 0 if self.packed is not None else min(self.solved.form_count, self.options.forms)
        parts = [(one.surface, one.structure) for one in self.solved.done]
        for index in range(count):
            uv = holomorph.arrangement.arranged_form(parts, index, self._corners, self.options.arrangement)
            yield f"{MAIN_MAP} {index + 1}", uv.astype(np.float32)

    def _main_map(self):
        arranged = holomorph.arrangement.arranged(self.part_maps, self._corners, self.options.arrangement)
        return arranged.astype(np.float32)

    @property
    def _corners(self):
        return len(self.solved.polygons.corner_vertices)


def follow(options, is_equal=False):
    """What follows the solves of a `jobs.Job`: the `mapped` ones, by options for each of its tasks."""

    def then(found, progress):
        own = [options[k] for k in found]
        return dict(zip(found, mapped(list(found.values()), own, is_equal, progress)))

    return then


def mapped(solved, options, is_equal=False, progress=None):
    """The `MappedObject`s of solves by the options of each. What was made is kept with them: a second call is quick.

    is_equal : whether squares have one size over all objects, so that a number of tiles is over all of them
    """
    keys, count = [_asked(*each) for each in zip(solved, options)], len(solved)
    groups = [list(range(count))] if is_equal else [[k] for k in range(count)]
    scaled, areas, done, made = holomorph.core.progress.scaled, [_area(one) for one in solved], 0.0, []
    for group in groups:
        share = sum(areas[k] for k in group) / (sum(areas) or 1.0)
        own = [solved[k] for k in group], [options[k] for k in group], [keys[k] for k in group]
        made += _mapped_together(*own, scaled(progress, done, done + share))
        done += share
    return _of_one_length(made) if is_equal and count > 1 else made


def _area(solved):
    return sum(component.surface.area for component in solved.done)


def _asked(solved, options):
    """What decides how the parts of a solve are mapped, before they are laid out."""
    mains = tuple(_main(component, options) for component in solved.done)
    return solved.number, mains, options.main == TILING, options.tiling.made, options.amounts, options.turns


def _mapped_together(solved, options, keys, progress):
    """With squares of one size. Maps are kept with each solve, under what was asked of all of them."""
    together = tuple(keys)
    if not all((key[0], together) in one.maps for key, one in zip(keys, solved)):
        for key, one, kept in zip(keys, solved, _made(solved, options, progress)):
            one.keep_maps((key[0], together), kept)
    return [_object(one, own, *one.maps[key[0], together]) for one, own, key in zip(solved, options, keys)]


def _object(solved, options, parts, size):
    """The `MappedObject`, also of the parts that have no structure."""
    made, tiling = iter(parts), replace(options.tiling, size=size)
    every = [MappedPart(one, skipped=one.reason) if one.structure is None else next(made) for one in solved.components]
    return MappedObject(solved, replace(options, tiling=tiling), tuple(every))


def _of_one_length(made):
    """The same objects, but that maps of forms have one texel density: that of the tilings, or the largest with which
    each object has room."""
    found = [one for one in made if one.done]
    maps = [one.part_maps for one in found]
    per_length = holomorph.arrangement.common_length(maps, found[0].options.arrangement) if found else 0.0
    return [replace(one, options=replace(one.options, per_length=per_length)) for one in made]


def _main(component, options):
    """The main map that the library is asked for."""
    is_plain = options.are_plain and not component.is_chosen and component.surface.area > 0
    return MAINS.get(options.main, "balanced") if is_plain or options.main != AUTOMATIC else "balanced"


def _made(solved, options, progress):
    """[(the `MappedPart`s of the `done` components, the size with which they are the same alone)] of each solve.
    Refusals are told. What no tiling fits gets another map, if what is chosen fits anywhere."""
    wanted = options[0].tiling
    components = [one.done for one in solved]
    requests = [[_request(part, own) for part in parts] for parts, own in zip(components, options)]
    size = wanted.size and holomorph.maps.size.SizePolicy(*wanted.size)
    if not size:
        surfaces = [part.surface for parts in components for part in parts]
        tiles = None if wanted.density else wanted.tiles or None
        size = holomorph.maps.size.SizePolicy.of(surfaces, tiles, wanted.density or None)
    found = holomorph.maps.map_objects.map_objects(requests, size, progress=progress)
    return [(_parts(*each, maps), astuple(own)) for *each, (maps, own) in zip(components, requests, options, found)]


def _parts(components, requests, options, made):
    """The `MappedPart`s of one object."""
    reasons = ["" if hasattr(one, "uv") else native.sentence(one) for one in made]
    if options.main == TILING and options.tiling.is_chosen and all(reasons):
        return [MappedPart(component, skipped=reason) for component, reason in zip(components, reasons)]
    return [_part(*each) for each in zip(components, requests, made, reasons)]


def _part(component, request, made, refusal):
    """With another map than a tiling that is refused."""
    if refusal and request.main == "balanced":
        return MappedPart(component, skipped=refusal)
    if refusal:
        given = request.surface, request.structure
        made = holomorph.automatic_map(*given, main="untiled", evenness=request.evenness)
    return MappedPart(component, made, not_seamless=refusal)


def _request(component, options):
    """The `holomorph.maps.request.Request` for a part. Evening is slow while forms are mixed."""
    main, wanted = _main(component, options), options.tiling
    is_slow = main == "balanced" and options.are_mixed and len(component.surface.triangles) > MIXED_EVENED
    made = holomorph.maps.request.request_of_part(
        component.surface,
        component.structure,
        main,
        wanted.poles,
        None if wanted.allowed is None else np.frombuffer(wanted.allowed, bool),
        wanted.moved,
        0.0 if is_slow else wanted.evenness,
        wanted.direction,
        {"lattice": wanted.lattice, "boundary": wanted.boundary, "turn": wanted.turn or None},
    )
    return replace(made, coefficients=forms.coefficients(component, options)) if main == "balanced" else made
