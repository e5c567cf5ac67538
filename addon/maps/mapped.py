# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of solves: the main one, of tilings or of forms part by part, and those of single forms. No bpy here."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from .. import native
from ..native import holomorph, module
from ..scene.uv_maps import MAIN_MAP

Request, Arrangement = module("tiling.request").Request, holomorph.arrangement.Arrangement
AUTOMATIC, SEAMLESS, BALANCED, ISLANDS = "AUTOMATIC", "SEAMLESS", "BALANCED", "ISLANDS"  # what the main map is
SQUARES_LIMIT = 10_000


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
        return self.vertices(self.map.seams)


@dataclass(frozen=True, eq=False)
class MappedObject:
    """The maps of one object: what is asked of them, none of which needs a new solve, and when they are made, the parts
    in the library's order."""

    request: Request = Request()
    arrangement: Arrangement = Arrangement()
    main: str = AUTOMATIC  # what the main map is
    forms: int = 8  # basis forms that get a map of their own, at most
    points: tuple = ()  # vertices of the poles that are there then; chosen themselves where moves are of others
    solved: object | None = None  # `solve.SolvedObject`
    parts: tuple = ()
    packed: np.ndarray | None = None  # (#C, 2) the main map where Blender has packed its islands

    @property
    def done(self):
        """The parts that have maps."""
        return [part for part in self.parts if not part.skipped]

    @cached_property
    def tiled(self):
        """The parts whose main map is a tiling, or has tilings of pieces."""
        return [part for part in self.parts if part.map and part.map.is_tiled]

    @property
    def is_astray(self):
        """Whether other poles were moved than those that were dragged: with other dials, others are placed."""
        if not self.points:
            return False
        poles = [part.vertices(part.tiling.poles) for part in self.tiled if part.tiling]
        return not set(self.points) <= set(np.concatenate([*poles, ()]).tolist())

    @property
    def part_maps(self):
        """The `holomorph.Map`s of the parts that have one."""
        return [part.map for part in self.done]

    @cached_property
    def unit_length(self):
        """The length on the surface of a UV unit of the main map, where the density is the median one; 0 for maps
        without area."""
        return holomorph.arrangement.unit_length(self.part_maps, self.arrangement)

    def of_forms(self):
        """The same parts with maps of forms alone."""
        if not self.tiled:
            return self
        request = replace(self.request, main="balanced", evenness=0.0)
        return mapped([replace(self, request=request, main=BALANCED)])[0]

    def maps(self):
        """Yields (name, (#C, 2) float32) for every map, the main one first; parts that lack it are zero there."""
        arrangement, corners = self.arrangement, len(self.solved.polygons.corner_vertices)
        main = self.packed
        if main is None:
            main = holomorph.arrangement.arranged(self.part_maps, corners, arrangement).astype(np.float32)
        yield MAIN_MAP, main
        count = 0 if self.packed is not None else min(self.solved.form_count, self.forms)
        parts = [(one.surface, one.structure) for one in self.solved.done]
        for index in range(count):
            uv = holomorph.arrangement.arranged_form(parts, index, corners, arrangement)
            yield f"{MAIN_MAP} {index + 1}", uv.astype(np.float32)

    def squares_that_fit(self, across):
        """Squares of a texture per UV unit so that about `across` of them lie along the diagonal of the bounding box of
        the largest part where the density is the median one, at density 1; an even number."""
        package = holomorph.arrangement
        size = max(package.diagonal(made.surface) for made in self.part_maps)
        unit = package.unit_length(self.part_maps, replace(self.arrangement, density=1.0))
        return min(max(2 * round(across * unit / size / 2), 2), SQUARES_LIMIT) if unit > 0 else across


def shape_points(solved):
    """(#V,3) conformal images in space of the parts that have one, zeros elsewhere; None if no part has one."""
    found = [(holomorph.conformal_image(part.structure), part.surface.vertex_index) for part in solved.done]
    points = np.zeros((len(solved.polygons.vertices), 3))
    for image, own in found:
        if image is not None:
            points[own] = image[own]
    return points if any(image is not None for image, _ in found) else None


def follow(wanted, is_equal, found, progress):
    """What follows the solves of a `jobs.Job`: the `mapped` objects, by those that are wanted for each of its tasks."""
    objects = [replace(wanted[k], solved=solved) for k, solved in found.items()]
    return dict(zip(found, mapped(objects, is_equal, progress)))


def mapped(objects, is_equal=False, progress=None):
    """The `MappedObject`s with their parts. What was made is kept with their solves: a second call is quick.

    is_equal : whether squares have one size over all objects, so that a number of tiles is over all of them
    """
    count = len(objects)
    if is_equal or count == 1:
        made = _mapped_together(objects, progress)
        return _of_one_length(made) if count > 1 else made
    sizes, done, made = [one.solved.polygons.face_count for one in objects], 0.0, []
    for one, size in zip(objects, sizes):
        share = size / (sum(sizes) or 1)
        made += _mapped_together([one], holomorph.core.progress.scaled(progress, done, done + share))
        done += share
    return made


def _mapped_together(objects, progress):
    """With squares of one size. Maps are kept with each solve, which equal objects share, under what was asked of it
    and of all of them."""
    together = tuple((one.solved.number, one.request.key) for one in objects)
    keys = [(own, together) for own in together]
    if not all(key in one.solved.maps for one, key in zip(objects, keys)):
        for one, key, kept in zip(objects, keys, _made(objects, progress)):
            one.solved.keep_maps(key, kept)
    made = [_with_parts(one, *one.solved.maps[key]) for one, key in zip(objects, keys)]
    if not any(one.is_astray for one in made):
        return made
    anew = [_with_poles(one, own) if one.is_astray else own for one, own in zip(made, objects)]
    return _mapped_together(anew, progress)


def _with_poles(made, wanted):
    """What is wanted for poles that went astray: all of them are chosen first. A choice leaves out those that these
    dials do not need, so of what was dragged, the nearest of the others is dragged there then."""
    asked = wanted.request
    if asked.moves or asked.poles == wanted.points:
        dragged = tuple(vertex for _, vertex in asked.moves)
        return replace(wanted, request=replace(asked, poles=wanted.points, moves=()), points=dragged)
    moves = [move for part in made.tiled if part.tiling for move in _drags(part, wanted.points)]
    return replace(wanted, request=replace(asked, moves=tuple(moves)), points=())


def _drags(part, dragged):
    """(index of a pole, vertex) of the vertices of this part that should be poles of it and are not."""
    poles, surface = part.vertices(part.tiling.poles), part.component.surface
    places, free = surface.vertices[part.tiling.poles], ~np.isin(poles, dragged)
    for vertex in np.setdiff1d(np.intersect1d(dragged, surface.vertex_index), poles)[: free.sum()]:
        here = surface.vertices[surface.vertex_index == vertex][0]
        nearest = np.where(free, np.linalg.norm(places - here, axis=1), np.inf).argmin()
        free[nearest] = False
        yield int(nearest), int(vertex)


def _with_parts(wanted, parts, size):
    """The same object with these of the `done` components, and the parts that have no structure."""
    made, components = iter(parts), wanted.solved.components
    every = [MappedPart(one, skipped=one.reason) if one.structure is None else next(made) for one in components]
    return replace(wanted, request=replace(wanted.request, size=size), parts=tuple(every))


def _of_one_length(made):
    """The same objects, but that maps of forms have one texel density: that of the tilings, or the largest with which
    each object has room."""
    found = [one for one in made if one.done]
    maps = [one.part_maps for one in found]
    per_length = holomorph.arrangement.common_length(maps, found[0].arrangement) if found else 0.0
    return [replace(one, arrangement=replace(one.arrangement, per_length=per_length)) for one in made]


def _made(objects, progress):
    """[(the `MappedPart`s of the `done` components, the size with which they are the same alone)] of each object.
    Refusals are told. What no tiling fits gets another map, if what is chosen fits anywhere."""
    asked = [[_asked(one.request, part) for part in one.solved.done] for one in objects]
    size = objects[0].request.size_of([surface for parts in asked for _, surface, _ in parts])
    found = holomorph.maps.map.map_objects(asked, size, progress=progress)
    return [(_parts(*each, made), own_size) for *each, (made, own_size) in zip(objects, asked, found)]


def _asked(request, part):
    """(request, surface, structure) of a `PartStructure`: a tiling where points are chosen on it, and one with poles
    does not turn; the balanced map where a structure was chosen, or there is no area."""
    own = request.on_part(part.surface)
    if own.main == "automatic" and (part.is_chosen or not part.surface.area > 0):
        own = replace(own, main="balanced")
    elif own.main != "balanced" and own.has_points:
        own = replace(own, main="seamless", **{"poles": "auto", "moves": {}} if own.cones else {"turns": 1})
    return own, part.surface, part.structure


def _parts(one, asked, made):
    """The `MappedPart`s of one object."""
    reasons, done = [native.sentence(each) if isinstance(each, Exception) else "" for each in made], one.solved.done
    is_asked = one.main == ISLANDS or (one.main == SEAMLESS and one.request.is_chosen)
    if is_asked and all(reasons):
        return [MappedPart(component, skipped=reason) for component, reason in zip(done, reasons)]
    return [_part(*each) for each in zip(done, asked, made, reasons)]


def _part(component, asked, made, refusal):
    """With another map than a tiling, or islands, that are refused."""
    request, *given = asked
    if refusal and request.main == "balanced":
        return MappedPart(component, skipped=refusal)
    if refusal:
        made = holomorph.automatic_map(*given, main="untiled", evenness=request.evenness)
    if refusal and request.main == "islands":
        return MappedPart(replace(component, note=refusal), made)
    return MappedPart(component, made, not_seamless=refusal)
