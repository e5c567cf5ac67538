"""python -m holomorph relief MESH HEIGHTS --tiles 200 --depth 1.2mm --output part.3mf"""

import re

import numpy as np

from .. import Error, InvalidMesh, Map, Surface, TopologyError, automatic_maps
from ..core.value import rounded
from ..files import formats, printing, whole_file
from ..mesh.checks import check_options, real_number
from ..tiles.height_image import height_image
from ..tiles.relief import LEAST_PART, check_choices, checked_depth, checked_heights, joined, plain, stretched_sentence
from ..tiles.shells import outward, turned_sentence, with_room
from .console import Parser, failed, tell, warn

EXIT_REFUSED, EXIT_USAGE, EXIT_STRICT = 1, 2, 3
UNITS = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "in": 25.4, "um": 0.001}  # millimetres
LENGTH = re.compile(r"\s*([-+]?[0-9.]+(?:e[-+]?[0-9]+)?|[-+]?(?:nan|inf\w*))\s*([a-zµ\"']*)\s*", re.IGNORECASE)


def relief(arguments):
    """Writes the mesh with a picture raised in every tile, and tells what it is; the exit status, other than 0 with one
    sentence: 1 if nothing was done, 2 for options that cannot be, 3 with --strict where the result crosses itself or is
    open."""
    options = _parser().parse_args(arguments)
    try:
        depth = _millimetres(options.depth)
        check_choices(options.repeats, options.level, options.tolerance, options.most_triangles)
        if options.tiles is not None:
            real_number(options.tiles, "tiles", positive=True)
        printing.of_path(options.output)
        formats.check_mesh(options.mesh)
        whole_file.require_file(options.heights)
        whole_file.check_places([options.mesh], options.output, [], options.overwrite)
        check_options("auto", options.threads)
    except (Error, ValueError, OSError) as error:
        return failed(EXIT_USAGE, error)
    try:
        made, told, faults = _made(options, depth)
        whole_file.write(options.output, printing.content(options.output, made))
    except (Error, OSError) as error:
        return failed(EXIT_REFUSED, error)
    tell("".join(f"{sentence}\n" for sentence in told + faults))
    return failed(EXIT_STRICT, faults[0]) if options.strict and faults else 0


def _parser():
    parser = Parser(
        "relief",
        description="Raise a picture of heights on a mesh, once in every tile of a seamless tiling, for printing: "
        "the pattern closes up around every limb, and a closed mesh stays closed.",
        epilog="Exit status: 1 if nothing was done (a message says why), 2 for a mistake in the command, 3 with "
        "--strict.",
    )
    parser.add_argument("mesh", help=f"{formats.KINDS} file")
    parser.add_argument("heights", metavar="image", help="picture whose white is raised; it repeats in every tile")
    parser.add_argument("--output", metavar="FILE", required=True, help="file to write: .3mf, .stl or .obj")
    parser.add_argument(
        "--depth", required=True, help=f"height of white over black, such as 1.2mm; units: {', '.join(UNITS)}"
    )
    parser.add_argument("--tiles", type=float, help="number over the whole mesh (default: chosen to suit the map)")
    parser.add_argument("--repeats", type=int, default=1, help="number of pictures across a tile (default 1)")
    parser.add_argument("--unit", choices=UNITS, default="mm", help="unit of the coordinates; the output is in mm")
    parser.add_argument(
        "--level", type=float, default=0.0, help="grey that stays on the surface: 0 raises (default), 1 engraves"
    )
    text = "largest error of the triangles, from 0 to 1 of the depth (default 0.02)"
    parser.add_argument("--tolerance", type=float, default=0.02, help=text)
    parser.add_argument(
        "--most-triangles", type=int, default=1_000_000, help="limit on the triangles (default 1000000)"
    )
    parser.add_argument("--overwrite", action="store_true", help="allow --output to replace the input")
    parser.add_argument("--threads", type=int, help="number of threads (default: one per core)")
    parser.add_argument("--strict", action="store_true", help="exit with 3 if the result crosses itself or is open")
    return parser


def _millimetres(text):
    """A length in millimetres, which are meant where no unit stands. @throws ValueError"""
    match = LENGTH.fullmatch(text)
    if match is None:
        raise ValueError(f"--depth is {text}: a length such as 1.2mm is needed")
    number, unit = match.groups()
    if unit and unit.lower() not in UNITS:
        raise ValueError(f"--depth is {text}: the units are {', '.join(UNITS)}")
    try:
        depth = float(number) * UNITS[unit.lower() or "mm"]
    except ValueError as error:
        raise ValueError(f"--depth is {text}: {number} is not a number") from error
    if not 0 < depth < np.inf:
        raise ValueError(f"--depth is {text}: it must be positive and finite; --level 1 engraves")
    return depth


def _made(options, depth):
    """(the `Relief`, what is told of it, what is wrong with it)."""
    heights = _heights(options.heights)
    surface = Surface.read(options.mesh)
    warn(options.mesh, surface.repairs.notes)
    surface, turned = outward(_scaled(surface, UNITS[options.unit]))
    depth = _of_mesh(checked_depth, depth, surface.vertices)
    parts = [with_room(part) for part in surface.components]
    maps = automatic_maps(parts, main="seamless", tiles=options.tiles, threads=options.threads)
    reasons = [f"{found.why}" if isinstance(found, Map) else str(found) for found in maps]
    choices = {name: getattr(options, name) for name in ("repeats", "level", "tolerance", "most_triangles")}
    reliefs, refused = [], []
    for part, found, reason in zip(parts, maps, reasons):
        is_tiled = isinstance(found, Map) and found.tiling
        reliefs.append(found.tiled.relief(heights, depth, **choices) if is_tiled else plain(part))
        if not np.ptp(reliefs[-1].heights):
            refused.append("the picture fades out at its poles" if is_tiled else reason)
    if len(refused) == len(parts):
        raise TopologyError(f"{options.mesh}: it has no seamless tiling: {refused[0]}")
    if refused and options.tiles is not None:
        raise TopologyError(
            f"{options.mesh}: {len(refused)} of {len(parts)} parts would stay flat with --tiles {options.tiles:g}: "
            f"{refused[0]}; choose another number, or leave it out"
        )
    made = joined(reliefs)
    told = _told(options, made, refused, parts, depth) + [turned_sentence(turned)] * (turned > 0) + _aspect(heights)
    return made, told, _faults(made, parts, depth)


def _heights(path):
    """@throws Error, OSError"""
    return _of_mesh(checked_heights, _of_mesh(height_image, path))


def _of_mesh(check, *given):
    """What a function gives. @throws Error for what it says of data, as a ValueError"""
    try:
        return check(*given)
    except ValueError as error:
        raise InvalidMesh(str(error)) from error


def _aspect(heights):
    """What is to be said of a picture that a tile stretches."""
    rows, columns = heights.shape
    return [stretched_sentence(columns, rows)] * (rows != columns)


def _scaled(surface, factor):
    if factor == 1 or surface.vertices is None:
        return surface
    arrays = surface.vertices * factor, surface.corner_vertices, surface.face_offsets
    return Surface.from_polygons(*arrays, strict=False)._standing_as(surface)


def _told(options, made, refused, parts, depth):
    sentences = [f"{len(made.triangles):,} triangles, {depth:.4g} mm deep, {made.volume / 1000:.4g} cm3"]
    if refused:
        sentences.append(f"{len(refused)} of {len(parts)} parts stay flat: {refused[0]}")
    if off := printing.rounding(options.output, made):
        sentences.append(
            f"STL is in single precision, which moves points so far from the origin by up to {rounded(off)} mm: write "
            ".3mf, or move the mesh to the origin"
        )
    if made.is_full:
        off = made.error * depth
        sentences.append(
            f"the limit on the triangles was reached: they are up to {rounded(off)} mm off; see --most-triangles"
        )
    return sentences


def _faults(made, parts, depth):
    sentences = []
    if any(part.boundary_count for part in parts):
        sentences.append("the mesh is open, and so is the relief: it has no volume")
    if len(made.crossings):
        at = made.vertices[made.triangles[made.crossings[0, 0]]].mean(axis=0)
        safe, least = made.safe_depth, rounded(LEAST_PART * depth)
        tried = f"up to {rounded(safe)} mm deep it does not" if safe > 0 else f"at {least} mm it still does"
        place = ", ".join(f"{x:.4g}" for x in at)
        count = len(np.unique(made.crossings))
        sentences.append(f"it crosses itself in {count:,} triangles, the first near ({place}): {tried}")
    return sentences
