"""The map of a part made of the maps of its pieces."""

import math
from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from ..core import arrays
from ..core.value import counted
from ..cutting.hard_edges import bends, seen
from ..mesh.edges import boundary_edges, edge_keys
from ..mesh.surface import Surface
from ..quality.quality import Quality
from .arrangement import arranged, unit_length
from .automatic_structure import AnyStructure
from .map import Map
from .mixed import Mixed


def mixed_map(surface: Surface, structure: AnyStructure, pieces: Sequence[Map], evenness: float) -> Map:
    """The `Map` of a connected part from those of its pieces, of which one at least is a tiling.

    pieces : of `pieces.cut_apart`, whose surfaces count vertices and corners as the part does
    """
    tiled, unit = [made for made in pieces if made.tiling], unit_length(pieces)
    quality = Quality.joined([m.quality for m in pieces], [m.density if m.tiling else unit**-2 for m in pieces])
    uv = arrays.frozen(arranged(pieces, len(surface.corner_vertices)))
    tilings = tuple(_of_part(made.tiling, made.surface.vertex_index) for made in tiled)
    is_border, seams = _seams(surface, pieces)
    mixed = Mixed(uv, tilings, seams, quality, evenness, *_seen_lengths(surface, is_border))
    has = f"{counted(len(tiled), 'piece')} between hard edges {'has' if len(tiled) == 1 else 'have'} whole tiles"
    rest = ", the rest flattens" if len(tiled) < len(pieces) else ""
    why = f"{has}{rest}: size range {quality.size_range:.3g}"
    return Map(surface, structure, uv, quality, np.empty(0), why, mixed=mixed)


def _of_part(tiling, vertex_index):
    zeros, orders = tiling.zeros
    poles, zeros, seams = (arrays.frozen(vertex_index[own]) for own in (tiling.poles, zeros, tiling.seams))
    return replace(tiling, poles=poles, zeros=(zeros, orders), seams=seams)


def _seams(surface, pieces):
    """((#E,) whether a texture breaks off at an edge, (#S, 2) vertices of the edges where the UVs jump)."""
    edges, count = np.asarray(surface._native.edges), len(surface.vertices)
    keys = edge_keys(edges, count)
    is_inner = np.bincount(surface._native.triangle_edges.ravel(), minlength=len(edges)) == 2

    def are(ends):
        return is_inner & np.isin(keys, np.concatenate([edge_keys(own, count) for own in ends]))

    borders = [made.surface.vertex_index[boundary_edges(made.surface)] for made in pieces]
    own = [(made.surface.vertex_index[made.seams], bool(made.tiling)) for made in pieces]
    is_border = are(borders + [ends for ends, is_tiling in own if not is_tiling])
    return is_border, arrays.frozen(edges[is_border | are([ends for ends, _ in own])])


def _seen_lengths(surface, is_border):
    """(length of seams across the smooth, and of hidden ones) over the square root of the area."""
    lengths, part = surface._native.edge_lengths[is_border], seen(bends(surface)[is_border])
    size = math.sqrt(surface.area)
    return float((lengths * part).sum()) / size, float((lengths * (1 - part)).sum()) / size
