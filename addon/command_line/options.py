# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the headless command, and which values of them cannot be.

They have the names and the values of the operators' properties, for `operators.run.Run`.
"""

import argparse
import math
from pathlib import Path

from ..operators import map_choices, properties, tile_choices, tile_properties
from . import exchange

# Of the files that are written.
SUFFIXES = {"output": (".blend", *exchange.SUFFIXES), "render": (".png",), "report": (".json",)}


class UsageError(Exception):
    """What the user asked for cannot be done; the text is one sentence."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise UsageError(message)


def parse(arguments):
    """The options. @throws UsageError"""
    parser = Parser(
        prog="blender -b [file.blend] --python-exit-code 1 --python headless.py --",
        description="Conformal UV maps for the surfaces in a mesh file or a .blend file.",
    )
    parser.add_argument("mesh", nargs="?", type=Path, help="OBJ, OFF, PLY, STL, glTF, FBX or USD; else the .blend")
    parser.add_argument("--output", type=Path, help="where to save the result: .blend, .glb, .gltf, .fbx, .usd, .obj")
    parser.add_argument("--render", type=Path, help="where to save a picture (PNG)")
    parser.add_argument("--report", type=Path, help="where to save the report (JSON)")
    parser.add_argument("--object", action="append", default=[], help="only this object (may be repeated)")
    parser.add_argument("--forms", type=int, default=8, help="at most so many maps of single forms")
    parser.add_argument("--shown", type=int, default=0, help="the active map: 0 is the main one")
    parser.add_argument("--density", type=float, default=1.0, help="factor of all UV lengths")
    text = "each object fills the UV square, instead of equal texels per metre"
    parser.add_argument("--fill-each", dest="equal", action="store_false", help=text)
    parser.add_argument("--margin", type=float, default=0.02, help="between parts, as a share of the UV square")
    text = "of tilings: 0 keeps angles, 1 makes squares of one size"
    parser.add_argument("--evenness", type=float, default=0.5, help=text)
    parser.add_argument("--rotation", type=_degrees, default=0.0, help="rotation of all maps in degrees")
    parser.add_argument("--seams", action="store_true", help="mark the cuts as seams")
    parser.add_argument("--shape", action="store_true", help="store maps to the sphere and the disk as an attribute")
    parser.add_argument("--no-checker", dest="checker", action="store_false", help="leave materials alone")
    parser.add_argument("--checker-scale", type=float, default=0.0, help="squares per UV unit; 0 chooses")
    parser.add_argument(
        "--texture", choices=_names(properties.TEXTURES), default="checker", help="what the material shows"
    )
    parser.add_argument("--up", choices=("Y", "Z"), help="the mesh file's up axis (OBJ: Y, others: Z)")
    parser.add_argument("--resolution", type=int, default=800, help="pixels of the picture's sides")
    parser.add_argument("--samples", type=int, default=24, help="samples per pixel")
    parser.add_argument("--levels", type=int, default=0, help="make so many levels of detail of each object")
    parser.add_argument("--ratio", type=float, default=0.25, help="triangles of a level over those of the one before")
    parser.add_argument("--side-by-side", action="store_true", help="the levels in a row, not in one place")
    parser.add_argument("--strict", action="store_true", help="end with 3 unless every part has a map that is fit")
    parser.add_argument("--lod0", action="store_true", help="a copy of the object as the finest level")
    parser.add_argument("--main", choices=_names(properties.MAIN_MAPS), default="automatic", help="main map")
    _add_choices(parser)
    _add_tilings(parser)
    options = parser.parse_args(arguments)
    _check_suffixes(options)
    _check_folders(options.output, options.render, options.report)
    _check_values(options)
    _take_over(options)
    return options


def _names(items):
    return [name.lower() for name, *_ in items]


def _degrees(text):
    return math.radians(float(text))


def _take_over(options):
    """Adds what the operators' properties have besides, under their names."""
    for name in ("main", "texture", "direction", "poles"):
        setattr(options, name, getattr(options, name).upper())
    options.use_selection, options.amounts, options.turns = options.selection.upper(), (), ()
    if options.seamless:
        options.turn, options.quarters, options.repeats, options.empties = options.rotation, 0, 1, False
        if options.boundary == "natural":
            options.boundary = "straight"
        if options.poles.isdecimal():
            options.poles, options.pole_count = "COUNT", int(options.poles)
    chosen = tile_choices if options.seamless else map_choices
    options.choices = lambda: chosen


def _add_choices(parser):
    group = parser.add_argument_group("choices on one object (vertices counted from 0)")
    group.add_argument("--pole", type=int, action="append", default=[], metavar="V", help="may be repeated")
    group.add_argument("--residues", default="", metavar='"R R ..."', help="one for each pole, may be complex")
    group.add_argument("--rectangle", type=int, nargs=4, metavar="V", help="corners on the boundary of a disk")
    group.add_argument("--selection", choices=("automatic", "faces", "poles", "rectangle", "none"), default="none")
    group.add_argument("--modifiers", action="store_true", help="map what the modifiers make")
    group.add_argument("--cut-at-seams", action="store_true", help="cut along the seams of the .blend")
    text = "with --main islands: cut along edges sharper than so many degrees, too, and those marked sharp"
    group.add_argument("--hard-edges", type=_degrees, default=0.0, metavar="DEGREES", help=text)
    text = "with --main islands: cut them open where lengths change by more than this factor"
    group.add_argument("--most-stretch", type=float, default=0.0, metavar="FACTOR", help=text)
    group.add_argument(
        "--boundary",
        choices=("natural", "double_cover", "straight", "free"),
        default="natural",
        help="how holes are solved; with --seamless straight (default) or free",
    )
    group.add_argument("--solver", default="auto", help="as in holomorph.conformal_structure")


def _add_tilings(parser):
    group = parser.add_argument_group("seamless tilings, with --seamless alone")
    group.add_argument("--seamless", action="store_true", help="one map, cut by whole tiles of a texture")
    group.add_argument("--tiles", type=int, default=0, help="over each object, about; 0 chooses")
    group.add_argument("--poles", default="automatic", help="automatic, selected (in the .blend), or a number per part")
    group.add_argument("--pole-group", default="", help="the vertex group in which poles may be")
    lattices, directions = _names(tile_properties.LATTICES), _names(tile_properties.DIRECTIONS)
    group.add_argument("--lattice", choices=lattices, default="square")
    group.add_argument("--direction", choices=directions, default="upright", help="of the rows")


def _check_suffixes(options):
    for name, suffixes in SUFFIXES.items():
        path = getattr(options, name)
        wrong = path is not None and path.suffix.lower() not in suffixes
        _refuse_if(wrong, f"--{name}: {path} must end with {' or '.join(suffixes)}, for that is what is written")


def _check_folders(*files):
    for path in files:
        if path is not None and not path.resolve().parent.is_dir():
            raise UsageError(f"{path}: the folder {path.resolve().parent} does not exist")


def _check_values(options):
    _refuse_if(
        min(options.forms, options.checker_scale, options.shown) < 0 or options.density <= 0,
        "--forms, --shown and --checker-scale cannot be negative, and --density must be positive",
    )
    _refuse_if(not 0 <= options.margin < 1, "--margin must be at least 0 and less than 1")
    _refuse_if(not 0 <= options.evenness <= 1, "--evenness must be from 0 to 1")
    is_ratio = 0 < options.ratio < 1
    _refuse_if(options.levels < 0 or not is_ratio, "--levels cannot be negative, and --ratio must be between 0 and 1")
    _refuse_if(options.pole and options.rectangle, "--pole and --rectangle exclude each other")
    _refuse_if(not 0 <= options.hard_edges < math.pi, "--hard-edges must be at least 0 and less than 180")
    is_factor = options.most_stretch == 0 or 1 < options.most_stretch < math.inf
    _refuse_if(not is_factor, "--most-stretch must be above 1, or 0 for no cuts")
    is_used = options.main == "islands"
    _refuse_if(options.hard_edges and not is_used, "--hard-edges cuts islands: it goes with --main islands")
    _refuse_if(options.most_stretch and not is_used, "--most-stretch cuts islands: it goes with --main islands")
    boundaries = ("natural", "straight", "free") if options.seamless else ("natural", "double_cover")
    sentence = "--boundary is straight or free with --seamless, natural or double_cover without"
    _refuse_if(options.boundary not in boundaries, sentence)
    _refuse_if(options.tiles < 0, "--tiles cannot be negative")
    most, poles = tile_properties.MOST_POLES, options.poles
    is_number = poles.isdecimal() and int(poles) <= most
    sentence = f"--poles: {poles!r} is none of automatic, selected, and 0 to {most}"
    _refuse_if(poles not in ("automatic", "selected") and not is_number, sentence)
    chosen = options.pole or options.rectangle
    _refuse_if(options.seamless and chosen, "--pole and --rectangle go without --seamless: it has --poles")
    _refuse_if(min(options.resolution, options.samples) < 1, "--resolution and --samples must be at least 1")


def _refuse_if(is_wrong, sentence):
    if is_wrong:
        raise UsageError(sentence)
