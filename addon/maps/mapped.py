# SPDX-License-Identifier: GPL-3.0-or-later
"""The maps of solves: the main one, of tilings or of forms part by part, and those of single forms. No bpy here."""

import numbers
from dataclasses import astuple, dataclass, replace
from functools import cached_property

import numpy as np

from .. import native
from ..native import holomorph
from ..scene.uv_maps import MAIN_MAP

AUTOMATIC, SEAMLESS, BALANCED, ISLANDS = "AUTOMATIC", "SEAMLESS", "BALANCED", "ISLANDS"  # what the main map is
MAINS = {AUTOMATIC: "automatic", SEAMLESS: "seamless"}  # as `holomorph.automatic_maps` names them
SQUARES_LIMIT = 10_000


@dataclass(frozen=True)
class TileOptions:
    """The arguments of `holomorph.Structure.tile` for one object."""

    tiles: float = 0.0  # tiles over the whole object; 0 lets the library choose
    density: float = 0.0  # tiles for an area, instead; 0 for their number
    size: tuple = ()  # values of a `holomorph.maps.size.SizePolicy` that counts instead, as it was found with others
    poles: object = "auto"  # or a number for each part, or a tuple of vertices of the object
    lattice: object = "square"  # a name, or its (2, 2) matrix as tuples
    direction: object = "upright"  # or a vector in the frame of the solved polygons, or None
    boundary: str = "automatic"
    turn: float = 0.0  # radians by which the texture is rotated
    quarters: int = 0  # turns of the map by 90 degrees after it is made
    pole_group: str = ""  # the vertex group that `allowed` was read of
    # Bytes of the bools that tell where poles may be that are not chosen; None for anywhere.
    allowed: bytes | None = None
    evenness: float = 0.5  # from 0 for angles to 1 for squares of one size
    turns: int = 1  # 2, 4 or 6: the sides of a cut may turn by this part of a full turn
    lines: str = "automatic"  # at which rows end, or along which they run, where the map turns
    marked: bytes | None = None  # of the vertices of edges that are lines besides those found, (n, 2) int64
    cones: tuple = ()  # (vertex, angle in full turns) where they are chosen; none are searched for
    moved: tuple = ()  # (index of a pole in its part's tiling, vertex to which it was dragged)
    points: tuple = ()  # vertices of the poles that are there then; chosen themselves where the indices are of others

    @property
    def is_chosen(self):
        """Whether poles, places for them, or a number of tiles are chosen."""
        return bool(self.tiles or self.moved or self.cones) or self.allowed is not None or self.poles not in ("auto", 0)

    @property
    def made(self):
        """What of it decides how a tiling is made, before it is laid out."""
        return replace(self, quarters=0, pole_group="")


@dataclass(frozen=True)
class MapOptions:
    """What the redo panel changes of the maps of one object. None of it needs a new solve."""

    forms: int = 8  # basis forms that get a map of their own, at most
    density: float = 1.0  # factor of UV lengths, about the middle of the UV square
    rotation: float = 0.0  # radians, counter-clockwise, of every part
    margin: float = 0.02  # least distance between parts, in sides of the UV square
    main: str = AUTOMATIC  # what the main map is
    per_length: float = 0.0  # UV length for a length on the surface, at density 1; 0 fills the UV square
    tiling: TileOptions = TileOptions()

    @property
    def package_main(self):
        """The main map that the package is asked for: another than "balanced" where nothing else is chosen."""
        return MAINS.get(self.main, "balanced") if self.density == 1 or self.main != AUTOMATIC else "balanced"

    @cached_property
    def arrangement(self):
        """The `holomorph.arrangement.Arrangement`."""
        lengths = self.density, self.rotation, self.margin, self.per_length
        return holomorph.arrangement.Arrangement(*lengths, self.tiling.quarters)


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

    @cached_property
    def tiled(self):
        """The parts whose main map is a tiling, or has tilings of pieces."""
        return [part for part in self.parts if part.map and part.map.is_tiled]

    @property
    def is_astray(self):
        """Whether other poles were moved than those that were dragged: with other dials, others are placed."""
        poles = [part.vertices(part.tiling.poles) for part in self.tiled if part.tiling]
        return not set(self.options.tiling.points) <= set(np.concatenate([*poles, ()]).tolist())

    @property
    def part_maps(self):
        """The `holomorph.Map`s of the parts that have one."""
        return [part.map for part in self.done]

    @cached_property
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
        arrangement, corners = self.options.arrangement, len(self.solved.polygons.corner_vertices)
        main = self.packed
        if main is None:
            main = holomorph.arrangement.arranged(self.part_maps, corners, arrangement).astype(np.float32)
        yield MAIN_MAP, main
        count = 0 if self.packed is not None else min(self.solved.form_count, self.options.forms)
        parts = [(one.surface, one.structure) for one in self.solved.done]
        for index in range(count):
            uv = holomorph.arrangement.arranged_form(parts, index, corners, arrangement)
            yield f"{MAIN_MAP} {index + 1}", uv.astype(np.float32)

    def squares_that_fit(self, across):
        """Squares of a texture per UV unit so that about `across` of them lie along the diagonal of the bounding box of
        the largest part where the density is the median one, at density 1; an even number."""
        package = holomorph.arrangement
        size = max(package.diagonal(made.surface) for made in self.part_maps)
        unit = package.unit_length(self.part_maps, replace(self.options.arrangement, density=1.0))
        return min(max(2 * round(across * unit / size / 2), 2), SQUARES_LIMIT) if unit > 0 else across


def shape_points(solved):
    """(#V,3) conformal images in space of the parts that have one, zeros elsewhere; None if no part has one."""
    found = [(holomorph.conformal_image(part.structure), part.surface.vertex_index) for part in solved.done]
    points = np.zeros((len(solved.polygons.vertices), 3))
    for image, own in found:
        if image is not None:
            points[own] = image[own]
    return points if any(image is not None for image, _ in found) else None


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
    count = len(solved)
    if is_equal or count == 1:
        made = _mapped_together(solved, options, progress)
        return _of_one_length(made) if count > 1 else made
    sizes, done, made = [one.polygons.face_count for one in solved], 0.0, []
    for one, own, size in zip(solved, options, sizes):
        share = size / (sum(sizes) or 1)
        made += _mapped_together([one], [own], holomorph.core.progress.scaled(progress, done, done + share))
        done += share
    return made


def _mapped_together(solved, options, progress):
    """With squares of one size. Maps are kept with each solve, which equal objects share, under what was asked of it
    and of all of them."""
    together = tuple(_asked(*each) for each in zip(solved, options))
    if not all((asked, together) in one.maps for one, asked in zip(solved, together)):
        for one, asked, kept in zip(solved, together, _made(solved, options, progress)):
            one.keep_maps((asked, together), kept)
    made = [_object(one, own, *one.maps[asked, together]) for one, own, asked in zip(solved, options, together)]
    if not any(one.is_astray for one in made):
        return made
    anew = [_with_poles(one, own) if one.is_astray else own for one, own in zip(made, options)]
    return _mapped_together(solved, anew, progress)


def _with_poles(made, options):
    """The options for poles that went astray: all of them are chosen first. A choice leaves out those that these dials
    do not need, so of what was dragged, the nearest of the others is dragged there then."""
    asked = options.tiling
    if asked.moved or asked.poles == asked.points:
        dragged = tuple(vertex for _, vertex in asked.moved)
        return replace(options, tiling=replace(asked, poles=asked.points, moved=(), points=dragged))
    moves = [move for part in made.tiled if part.tiling for move in _drags(part, asked.points)]
    return replace(options, tiling=replace(asked, moved=tuple(moves), points=()))


def _drags(part, dragged):
    """(index of a pole, vertex) of the vertices of this part that should be poles of it and are not."""
    poles, surface = part.vertices(part.tiling.poles), part.component.surface
    places, free = surface.vertices[part.tiling.poles], ~np.isin(poles, dragged)
    for vertex in np.setdiff1d(np.intersect1d(dragged, surface.vertex_index), poles)[: free.sum()]:
        here = surface.vertices[surface.vertex_index == vertex][0]
        nearest = np.where(free, np.linalg.norm(places - here, axis=1), np.inf).argmin()
        free[nearest] = False
        yield int(nearest), int(vertex)


def _asked(solved, options):
    """What decides how the parts of a solve are mapped, before they are laid out."""
    return solved.number, options.package_main, options.tiling.made


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


def _made(solved, options, progress):
    """[(the `MappedPart`s of the `done` components, the size with which they are the same alone)] of each solve.
    Refusals are told. What no tiling fits gets another map, if what is chosen fits anywhere."""
    wanted, maps = options[0].tiling, holomorph.maps
    requests = [_requests(one.done, own) for one, own in zip(solved, options)]
    size = wanted.size and maps.size.SizePolicy(*wanted.size)
    if not size:
        surfaces = [part.surface for one in solved for part in one.done]
        tiles = None if wanted.density else wanted.tiles or None
        size = maps.size.SizePolicy.of(surfaces, tiles, wanted.density or None)
    found = maps.map_objects.map_objects(requests, size, progress=progress)
    each = zip(solved, requests, options, found)
    return [(_parts(one.done, asked, own, made), astuple(size)) for one, asked, own, (made, size) in each]


def _requests(components, options):
    """The `holomorph.maps.request.Request`s for parts."""
    wanted = options.tiling
    asked = holomorph.maps.request.MeshRequest(
        main=options.package_main,
        poles=wanted.poles,
        allowed=None if wanted.allowed is None else np.frombuffer(wanted.allowed, bool),
        moves=wanted.moved,
        cones=dict(wanted.cones),
        marked=None if wanted.marked is None else np.frombuffer(wanted.marked, np.int64).reshape(-1, 2),
        direction=wanted.direction,
        evenness=wanted.evenness,
        options={name: getattr(wanted, name) for name in ("lattice", "boundary", "turns", "lines")}
        | {"turn": wanted.turn or None},
    )
    return [_with_points(asked.of_structure(part)) for part in components]


def _with_points(request):
    """The request for a part: a tiling where points are chosen on it. One with poles does not turn."""
    options = request.options
    has_cones, is_open = bool(options["cones"]), isinstance(request.poles, (str, numbers.Real))
    if request.main == "balanced" or (is_open and not options["moves"] and not has_cones):
        return request
    if has_cones:
        return replace(request, main="seamless", poles="auto", options={**options, "moves": {}})
    return replace(request, main="seamless", options={**options, "turns": 1})


def _parts(components, requests, options, made):
    """The `MappedPart`s of one object."""
    reasons = [native.sentence(one) if isinstance(one, Exception) else "" for one in made]
    if options.main == SEAMLESS and options.tiling.is_chosen and all(reasons):
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
