# SPDX-License-Identifier: GPL-3.0-or-later
"""Seamless tilings from the command line: the options of the tile operator under the same names."""

import math
from functools import partial
from types import SimpleNamespace

from ..maps import tiling
from ..operators import tile_choices, tile_properties
from ..results import tile_run
from ..scene import targets
from ..solving import jobs


def _names(items):
    return [name.lower() for name, *_ in items]


def add_options(parser):
    group = parser.add_argument_group("seamless tilings, with --seamless alone")
    group.add_argument("--seamless", action="store_true", help="one map, cut by whole tiles of a texture")
    group.add_argument("--tiles", type=int, default=0, help="over each object, about; 0 chooses")
    group.add_argument("--poles", default="automatic", help="automatic, selected (in the .blend), or a number per part")
    group.add_argument("--pole-group", default="", help="the vertex group in which poles may be")
    group.add_argument("--lattice", choices=_names(tile_properties.LATTICES), default="square")
    group.add_argument("--direction", choices=_names(tile_properties.DIRECTIONS), default="upright", help="of the rows")


def make(context, options, found):
    """Tiles the targets and writes their maps; returns the `run.Outcome`. @throws ValueError an option that cannot be
    followed"""
    asked = _properties(options)
    chosen = [tile_choices.options(asked, target) for target in found if not target.refused]
    tile = tiling.Evenly() if options.equal else tiling.tile
    job = jobs.Job(targets.tasks(found), then=[partial(tile, options=one) for one in chosen])
    job.run()
    written = tile_run.TileWriteOptions(checker=options.checker, texture=options.texture.upper(), seams=options.seams)
    return tile_run.write(context, found, targets.align(found, job.results), written)


def _properties(options):
    """What `tile_choices` reads of the operator's properties."""
    poles, count = options.poles.upper(), 0
    if poles not in ("AUTOMATIC", "SELECTED"):
        if not (poles.isdecimal() and int(poles) <= tile_properties.MOST_POLES):
            most = tile_properties.MOST_POLES
            raise ValueError(f"--poles: {options.poles!r} is none of automatic, selected, and 0 to {most}")
        poles, count = "COUNT", int(poles)
    if options.tiles < 0:
        raise ValueError("--tiles cannot be negative")
    return SimpleNamespace(
        tiles=options.tiles,
        poles=poles,
        pole_count=count,
        pole_group=options.pole_group,
        lattice=options.lattice,
        direction=options.direction.upper(),
        turn=math.radians(options.rotation),
        quarters=0,
        boundary=options.boundary if options.boundary in _names(tile_properties.BOUNDARIES) else "straight",
    )
