"""Reports on surfaces, structures and maps, as plain data, ready for JSON; the verdict on a whole mesh.

What a report consists of is gathered as it is, and made plain once."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from ..core.value import plain, rounded
from ..forms.form_structure import CertifiedStructure
from ..mesh.hard_edges import cuts, next_sides
from ..quality.quality import Quality
from ..quality.verdicts import Seen, Verdict, baking, total_cost, verdict
from .arrangement import Arrangement, square
from .automatic_structure import LateStructure

if TYPE_CHECKING:
    from ..mesh.origin import Refused, Repairs
    from ..mesh.surface import Surface
    from .automatic_structure import AnyStructure
    from .map import Map

SMALL_PART = 0.01  # part of the area of all parts: the size of squares on less is not told
SAME_SIZE = 1.049  # largest over smallest side of squares of parts that is not seen: 10 % in area
TORN = 0.01  # of the length of a side in the map: less of a jump across it is not seen
NO_AREA = "area"  # in the reasons why faces are left out: of these nobody needs to know
LISTED = 20  # elements of a repair that a report names
MOST_ALIKE = 100  # parts that are alike, of which each has an entry of its own
WORDS = {
    "tiling": "seamless",
    "islands": "in islands",
    "flat": "flat",
    "mixed": "partly seamless",
    "strip": "as a strip",
    "log": "around poles",
    "forms": "cut open",
    "disk": "round",
    "rectangle": "rectangular",
}
PLAIN_ARRANGEMENT = Arrangement()
PLAIN = ("tiling", "forms")  # kinds that need no word where the mesh is one part: the verdict says the rest


def component_report(
    surface: Surface, structure: AnyStructure, main_map: dict[str, Any] | None = None
) -> dict[str, Any]:
    """What is known about the connected `surface` and its `structure`.

    main_map : `map_report` of the map that is shown first; by default that of the balanced coefficients
    """
    if main_map is None:
        coefficients = structure.balanced_coefficients()
        main_map = map_report(coefficients, structure.quality(structure.uv(coefficients)))
    return plain(_component(surface, structure, main_map))


def _component(surface, structure, main_map):
    return {
        "done": True,
        **_topology(surface),
        "description": structure.description,
        "forms": len(main_map["coefficients"]),
        **structure.invariants(),
        **({"certificate": structure.certificate.as_plain()} if isinstance(structure, CertifiedStructure) else {}),
        "residuals": vars(structure.residuals) | {"solver": structure.solver.residual},
        "solver": vars(structure.solver),
        "timings": structure.timings,
        "intrinsic_flips": structure.flip_count,
        "seam_edges": len(structure.seams),
        "main_map": main_map,
    }


def part_report(made: Map) -> dict[str, Any]:
    """The `component_report` of the part of a `Map`, with what kind of map it is, and of a tiling, or of the
    tilings of its pieces, poles and certificates; vertices are those of the mesh as given."""
    return plain(_part(made))


def _part(made):
    about = {"kind": made.kind, "why": made.why, "evenness": made.evenness}
    about["worst_places"] = {name: place._asdict() for name, place in made.worst_places.items()}
    main_map = _main_map(made.coefficients, made.quality, made.verdict) | about
    if isinstance(made.structure, LateStructure) and "made" not in vars(made.structure):
        description = made.structure.description if made.structure.is_large else made.why
        about = {"done": True, **_topology(made.surface), "description": description}
        return about | {"forms": 0, "main_map": main_map}
    entry = _component(made.surface, made.structure, main_map)
    entry["forms"] = made.structure.form_count
    if made.kind == "mixed":
        entry["tilings"] = [_tiling(tiling, made.surface.vertex_index) for tiling in made.tilings]
    return entry | ({"tiling": _tiling(made.tiling, made.surface.vertex_index)} if made.tiling else {})


def _tiling(made, vertex_index):
    zeros, orders = made.zeros
    return {
        "added_distortion": float(made.added_distortion),
        "size_range": float(made.size_range),
        "beltrami_rms": float(made.beltrami_rms),
        "tiles": float(made.tiles),
        "poles": vertex_index[made.poles],
        "residues": made.residues,
        "zeros": vertex_index[zeros],
        "orders": np.asarray(orders),
        "periods": np.asarray(made.periods),
        "turns": made.turns,
        "cones": vertex_index[made.cones],
        "cone_angles": made.cone_angles,
        "lines": made.lines,
    }


def skipped_report(surface: Surface, reason: object) -> dict[str, Any]:
    """Why the connected `surface` was not done."""
    return {"done": False, **_topology(surface), "reason": str(reason)}


def refused_report(refused: Refused) -> dict[str, Any]:
    """Faces that were left out of a surface, a `Refused`."""
    return {"done": False, "faces": len(refused.faces), "reason": refused.reason}


def map_report(coefficients: ArrayLike, quality: Quality, found: Verdict | None = None) -> dict[str, Any]:
    """A UV map: its coefficients, its `Quality` and the `Verdict` on it, by default that of the quality."""
    return plain(_main_map(coefficients, quality, found or quality.verdict))


def _main_map(coefficients, quality, found):
    return {
        "coefficients": coefficients,
        "verdict": vars(found),
        "mean_angle": quality.mean_angle,
        "size_range": quality.size_range,
        "flipped_part": quality.flipped_part,
        "flipped_triangles": np.count_nonzero(quality.flipped),
        "collapsed_triangles": np.count_nonzero(quality.collapsed),
        "overlapping_part": quality.overlapping_part,
    }


def whole_report(
    maps: Sequence[Map],
    parts: Sequence[dict[str, Any]],
    repairs: Repairs,
    arrangement: Arrangement = PLAIN_ARRANGEMENT,
) -> dict[str, Any]:
    """`verdict`, `bake` and `whole` of a mesh, as `whole` takes what it is made of; all are None without a map."""
    return plain(_whole(maps, parts, repairs, arrangement))


def _whole(maps, parts, repairs, arrangement):
    found = whole(maps, parts, repairs, arrangement)
    if found is None:
        return dict.fromkeys(("verdict", "bake", "whole"))
    figures = {name: value for name, value in vars(found).items() if name not in ("verdict", "bake")}
    return {"verdict": vars(found.verdict), "bake": vars(found.bake), "whole": figures}


def parts_report(
    parts: Sequence[tuple[Surface, Map | None, str, str]],
    refused: Sequence[Refused],
    repairs: Repairs,
    arrangement: Arrangement = PLAIN_ARRANGEMENT,
) -> dict[str, Any]:
    """What is known of a mesh: `components`, the reports of its parts and of what was left out, its `repairs`, and the
    `whole_report`.

    parts : surface, map or None, why there is none, and why a choice was not followed
    """
    left_out = [skipped_report(surface, reason) for surface, made, reason, _ in parts if not made]
    left_out += [refused_report(one) for one in refused]
    about = _whole([made for _, made, *_ in parts if made], left_out, repairs, arrangement)
    entries = [*_part_reports(parts), *map(refused_report, refused)]
    return plain({**about, "repairs": _repairs(repairs), "components": entries})


def part_count(entries: Sequence[dict[str, Any]]) -> int:
    """How many parts these `components` of a report are."""
    return sum(entry.get("parts", 1) for entry in entries)


def _part_reports(parts):
    """The report of each part. Where more than `MOST_ALIKE` are alike, the others share the report of the one whose
    squares differ most, with their number as `parts` and the sums of what adds up. Tilings have points of their own:
    none is like another."""
    alike, entries = {}, {}
    for number, (surface, made, *why) in enumerate(parts):
        key = number if made and made.is_tiled else (surface.genus, surface.boundary_count, made and made.kind, *why)
        alike.setdefault(key, []).append(number)
    for numbers in alike.values():
        entries |= {number: _entry(*parts[number]) for number in numbers[:MOST_ALIKE]}
        if others := [parts[number] for number in numbers[MOST_ALIKE:]]:
            entries[numbers[MOST_ALIKE]] = _shared(others)
    return [entries[number] for number in sorted(entries)]


def _entry(surface, made, reason, note):
    entry = _part(made) if made else skipped_report(surface, reason)
    return entry | ({"not_followed": note} if note else {})


def _shared(parts):
    surfaces, maps = [part[0] for part in parts], [part[1] for part in parts if part[1]]
    worst = max(parts, key=lambda part: part[1].quality.density_ratio if part[1] else 0.0)
    every = list(map(_topology, surfaces))
    sums = {name: sum(one[name] for one in every) for name in ("faces", "vertices", "area")}
    entry = _entry(*worst) | {"parts": len(parts)} | sums
    for name in ("flipped", "collapsed") if maps else ():
        entry["main_map"][f"{name}_triangles"] = sum(int(getattr(made.quality, name).sum()) for made in maps)
    return entry


def repairs_report(repairs: Repairs) -> dict[str, Any]:
    """`Repairs`, with the number and the first of the elements of each kind."""
    return plain(_repairs(repairs))


def _repairs(repairs):
    arrays = {name: value for name, value in vars(repairs).items() if isinstance(value, np.ndarray)}
    return (
        {name: _listed(value) for name, value in arrays.items()}
        | {"cuts": [_cut_report(cut) for cut in repairs.cuts], "mollification": repairs.mollification}
        | {"notes": repairs.notes}
    )


def _listed(elements):
    return {"count": len(elements), "first": elements[:LISTED]}


def _cut_report(cut):
    elements = next(of for of in (cut.vertices, cut.edges, cut.faces) if len(of))
    return {"reason": cut.reason, "text": cut.sentence, **_listed(elements)}


def _topology(surface):
    return {
        "faces": len(surface.face_index),
        "vertices": len(surface.vertex_index),
        "genus": surface.genus,
        "boundary_count": surface.boundary_count,
        "area": surface.area,
    }


@dataclass(frozen=True)
class Whole:
    """text : kinds of the parts, what was left out, cut and joined; "" for one part of which nothing is to be said
    mean_angle, size_range : as those of `Quality`, over all parts as they are arranged
    sizes : how many times as long squares of one part are as those of another at most
    unmapped_faces : number of faces without a map
    seams : length of those in view over the root of the area: the mean over the parts, and those between parts
    cost : of the maps of all parts together, see `appearance.cost`
    verdict, bake : the `Verdict`s on the maps of all parts together, see `verdict` and `baking`
    """

    text: str
    mean_angle: float
    size_range: float
    sizes: float
    unmapped_faces: int
    seams: float | None
    cost: float
    verdict: Verdict
    bake: Verdict


def whole(
    maps: Sequence[Map],
    parts: Sequence[dict[str, Any]],
    repairs: Repairs,
    arrangement: Arrangement = PLAIN_ARRANGEMENT,
) -> Whole | None:
    """The `Whole` of a mesh; None where no part has a map.

    maps : of the parts that have one
    parts : the reports of those that have none, and of the faces that were left out; others do not count
    repairs : of the mesh
    """
    if not maps:
        return None
    areas, sizes = np.array([made.surface.area for made in maps]), _sizes(maps)
    tiled = float(areas[[made.is_tiled for made in maps]].sum() / (areas.sum() or 1.0))
    shown = sizes[(areas >= SMALL_PART * areas.sum()) & (sizes > 0)]
    spread = math.sqrt(shown.max() / shown.min()) if len(shown) else 1.0
    left_out = [part for part in parts if not part["done"]]
    blank, unmapped = sum(part.get("area", 0.0) for part in left_out), sum(part["faces"] for part in left_out)
    text = "; ".join(_words(maps, spread, left_out, repairs))
    quality = Quality.joined([made.quality for made in maps], sizes)
    seen = Seen.joined([made.seen for made in maps], areas, blank / (areas.sum() + blank or 1.0))
    if areas.sum() > 0:
        seen = seen.cut(*_cut_lengths(maps, math.sqrt(areas.sum())))
    used = 0.0 if tiled else square(maps, arrangement).used
    bake = baking(quality.overlapping_part or 0.0, tiled, used)
    figures = quality.mean_angle, quality.size_range, spread, unmapped, seen.seams, total_cost(quality, seen)
    return Whole(text, *figures, verdict(quality, seen), bake)


def _cut_lengths(maps, unit):
    """(length in view, length that hard edges hide) of the edges at which the maps of parts that were cut break off, in
    units of this length."""
    maps = [made for made in maps if made.surface.vertices is not None]
    if not maps:
        return 0.0, 0.0
    parts, sides, lengths, in_view = cuts([made.surface for made in maps])
    is_torn = parts[0] != parts[1]
    for part in np.unique(parts[0, ~is_torn]):
        both = np.flatnonzero(~is_torn & (parts[0] == part))
        is_torn[both] = _are_torn(maps[part], *sides[:, both])
    lengths = np.where(is_torn, lengths, 0.0)
    return float(lengths @ in_view) / unit, float(lengths @ (1 - in_view)) / unit


def _are_torn(made, one, other):
    """(n,) whether UVs at sides of triangles differ from those at others, which run the other way."""
    corners, uv = made.surface.triangle_corners.ravel(), made.uv @ [1, 1j]
    start, end = uv[corners[one]], uv[corners[next_sides(one)]]
    jumps = np.abs([uv[corners[next_sides(other)]] - start, uv[corners[other]] - end])
    return jumps.max(axis=0) > TORN * np.abs(end - start)


def _sizes(maps):
    """(n,) median densities as arranged: all but tilings are scaled to one."""
    tiled = [made.density for made in maps if made.is_tiled]
    unit = np.median(tiled) if tiled else 1.0
    return np.array([made.density / unit if made.is_tiled and unit > 0 else float(made.density > 0) for made in maps])


def _words(maps, spread, left_out, repairs):
    kinds = Counter(made.kind for made in maps)
    if len(maps) > 1:
        yield f"{len(maps):,} parts: " + ", ".join(f"{count:,} {WORDS[kind]}" for kind, count in kinds.most_common())
    elif maps[0].kind not in PLAIN:
        yield WORDS[maps[0].kind]
    if spread > SAME_SIZE:
        yield f"squares differ in size between parts by a factor of {rounded(spread)}"
    told = sum(part["faces"] for part in left_out if NO_AREA not in part["reason"])
    if told:
        yield f"{told:,} faces left out" if told > 1 else "1 face left out"
    yield from (cut.sentence for cut in repairs.cuts)
    yield from repairs.notes
    if len(repairs.joined_vertices):
        yield f"{len(repairs.joined_vertices):,} vertices joined"
