# SPDX-License-Identifier: GPL-3.0-or-later
"""The options of the headless command, and which values of them cannot be.

They have the names and the values of the operators' properties, for `operators.request.Run`.
"""

import argparse
import math
import os
from pathlib import Path

from bpy.props import BoolProperty, EnumProperty, FloatProperty, IntProperty, StringProperty

from .. import addresses
from ..baking.channels import CHANNELS, EACH, ONE, UDIM, USUAL_CHANNELS, BakeOptions
from ..operators.properties import FORMS, MOST_POLES, Dials, OfOneRun
from ..scene import stored_dials
from . import exchange

# Suffixes of the files that are written.
SUFFIXES = {"output": (".blend", *exchange.SUFFIXES), "render": (".png",), "report": (".json",)}
PROGRAM = "blender -b --disable-autoexec [file.blend] --python-exit-code 1 --python headless.py --"
DIALS = {"seamless": ("main",), "poles": ("poles", "pole_count")}  # of options that are not named after theirs
KINDS = {FloatProperty: float, IntProperty: int, StringProperty: str}


class Refused(Exception):
    """What was asked for cannot be done; the text is one sentence."""


class UsageError(Refused):
    """The command itself is a mistake: what is named is not there, or options cannot be."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise UsageError(message)


def parse(arguments, program=PROGRAM):
    """The options. @throws UsageError"""
    parser = Parser(
        prog=program,
        epilog=addresses.DOCUMENTATION,
        description="Conformal UV maps for the surfaces in a mesh file or a .blend file.",
    )
    parser.add_argument("mesh", nargs="?", type=Path, help="OBJ, OFF, PLY, STL, glTF, FBX or USD; else the .blend")
    parser.add_argument("--output", type=Path, help="where to save the result: .blend, .glb, .gltf, .fbx, .usd, .obj")
    parser.add_argument(
        "--export-forms", action="store_true", help="keep maps of single forms in files other than .blend"
    )
    text = "put the texture on the objects in files other than .blend, in place of their materials"
    parser.add_argument("--export-texture", action="store_true", help=text)
    parser.add_argument("--overwrite", action="store_true", help="allow --output to replace the input")
    parser.add_argument("--render", type=Path, help="where to save a picture (PNG)")
    parser.add_argument("--report", type=Path, help="where to save the report (JSON)")
    parser.add_argument("--object", action="append", default=[], help="only this object (may be repeated)")
    _add_properties(parser, Dials, "evenness", "turns", "rows", "texture", "source", "size", "seams")
    _add_properties(parser, Dials, "main", "forms", "shown", "density", "margin", "rotation")
    _add_properties(parser, Dials, "checker_scale", "shape")
    text = "each object fills the UV square, instead of equal texels per metre"
    parser.add_argument("--fill-each", dest="equal", action="store_false", help=text)
    parser.add_argument("--no-checker", dest="checker", action="store_false", help="leave materials alone")
    parser.add_argument("--up", choices=("Y", "Z"), help="the mesh file's up axis (OBJ: Y, others: Z)")
    parser.add_argument("--resolution", type=int, default=800, help="width and height of the picture, in pixels")
    parser.add_argument("--samples", type=int, default=24, help="samples per pixel")
    parser.add_argument("--levels", type=int, default=0, help="number of levels of detail to make of each object")
    parser.add_argument(
        "--ratio", type=float, default=0.25, help="triangles of a level, as a share of the level before"
    )
    parser.add_argument(
        "--side-by-side", action="store_true", help="place the levels in a row, not at the object's location"
    )
    parser.add_argument("--strict", action="store_true", help="exit with 3 unless every part has a good or fair map")
    parser.add_argument("--lod0", action="store_true", help="add a copy of the object as the finest level")
    _add_choices(parser)
    _add_tilings(parser)
    _add_bake(parser)
    options = parser.parse_args(arguments)
    given = parser.parse_args(arguments, argparse.Namespace(**dict.fromkeys(vars(options))))  # None, and no defaults
    names = [name for name, value in vars(given).items() if value is not None]
    options.given = {dial for name in names for dial in DIALS.get(name, (name,))}
    options.warnings = []  # sentences about what was read all the same
    _check_suffixes(options)
    _check_values(options)
    _take_over(options)
    return options


def _add_properties(group, owner, *names):
    """Options for properties of operators: under their names, with their defaults, ranges, values and texts."""
    for name in names:
        kind, about = owner.__annotations__[name].function, owner.__annotations__[name].keywords
        if kind is BoolProperty:
            settings = {"action": "store_true"}
        elif kind is EnumProperty:
            settings = {"choices": [item.lower() for item, *_ in about["items"]], "default": about["default"].lower()}
        else:
            settings = {"type": _parsed(KINDS[kind], about), "default": about.get("default", KINDS[kind]())}
        group.add_argument(f"--{name.replace('_', '-')}", help=about["description"], **settings)


def _parsed(kind, about):
    """A function that reads a property's value, angles in degrees."""
    if kind is str:
        return kind
    least, most = about.get("min", -math.inf), about.get("max", math.inf)
    unit = math.pi / 180 if about.get("subtype") == "ANGLE" else 1

    def parsed(text):
        value = unit * kind(text)
        if not least <= value <= most:
            raise argparse.ArgumentTypeError(f"{text} is not from {least / unit:g} to {most / unit:g}")
        return value

    parsed.__name__ = kind.__name__  # in the sentence about what is not a number
    return parsed


def _take_over(options):
    """Adds what the operators' properties have besides, under their names."""
    for name in ("main", "texture", "turns", "rows", "direction", "poles"):
        setattr(options, name, getattr(options, name).upper())
    options.use_selection, options.amounts, options.phases = options.selection.upper(), (1.0,) * FORMS, (0.0,) * FORMS
    options.quarters, options.repeats, options.empties, options.moved = 0, 1, False, ""
    if options.poles.isdecimal():
        options.poles, options.pole_count = "COUNT", int(options.poles)
    if options.seamless:
        options.main = "SEAMLESS"


def for_object(options, stored):
    """The options with the dials that an object stores, beside those that are given."""
    return argparse.Namespace(**vars(options) | stored_dials.beside(options.given, stored))


def _add_choices(parser):
    group = parser.add_argument_group("choices on one object (vertices counted from 0)")
    group.add_argument("--pole", type=int, action="append", default=[], metavar="V", help="may be repeated")
    group.add_argument("--rectangle", type=int, nargs=4, metavar="V", help="corners on the boundary of a disk")
    group.add_argument("--selection", choices=("automatic", "faces", "poles", "rectangle", "none"), default="none")
    _add_properties(group, Dials, "modifiers")
    _add_properties(group, Dials, "cut_at_seams", "hard_edges", "most_stretch")
    _add_properties(group, OfOneRun, "residues")
    group.add_argument("--solver", default="auto", help="as in holomorph.conformal_structure")


def _add_tilings(parser):
    group = parser.add_argument_group("seamless tilings, only with --seamless")
    group.add_argument("--seamless", action="store_true", help="one map, cut by whole tiles of a texture")
    group.add_argument("--poles", default="automatic", help="automatic, selected (in the .blend), or a number per part")
    _add_properties(group, Dials, "tiles", "pole_group", "lattice", "direction", "boundary")


def _add_bake(parser):
    group = parser.add_argument_group("baking the texture of tilings into an atlas")
    group.add_argument("--bake", type=Path, metavar="FOLDER", help="bake, and save the images in this folder")
    text = "texels per metre of the surface; 0: images of 2,048 texels a side"
    group.add_argument("--texels", type=float, default=BakeOptions.texels, help=text)
    names, usual = [name.lower() for name in CHANNELS], [name.lower() for name in CHANNELS if name in USUAL_CHANNELS]
    group.add_argument("--bake-channels", nargs="+", choices=names, default=usual, help="channels to bake")
    images = [name.lower() for name in (EACH, ONE, UDIM)]
    text = "images for each object, one atlas for all, or one with a UDIM tile for each"
    group.add_argument("--bake-images", choices=images, default=BakeOptions.images.lower(), help=text)
    text = "texels around islands, filled with the colours of their border"
    group.add_argument("--bake-margin", type=int, default=BakeOptions.margin, help=text)


def _check_suffixes(options):
    for name, suffixes in SUFFIXES.items():
        path = getattr(options, name)
        wrong = path is not None and path.suffix.lower() not in suffixes
        _refuse_if(wrong, f"--{name}: {path} must end with {' or '.join(suffixes)}")


def _check_values(options):
    is_ratio = 0 < options.ratio < 1
    _refuse_if(options.levels < 0 or not is_ratio, "--levels cannot be negative, and --ratio must be between 0 and 1")
    is_shown = options.checker or not options.export_texture
    _refuse_if(not is_shown, "--export-texture and --no-checker cannot be combined")
    _refuse_if(options.pole and options.rectangle, "--pole and --rectangle cannot be combined")
    is_factor = options.most_stretch == 0 or 1 < options.most_stretch < math.inf
    _refuse_if(not is_factor, "--most-stretch must be above 1, or 0 for no cuts")
    is_used = options.main == "islands"
    _refuse_if(options.hard_edges and not is_used, "--hard-edges cuts islands: it needs --main islands")
    _refuse_if(options.most_stretch and not is_used, "--most-stretch cuts islands: it needs --main islands")
    is_other = options.boundary != "automatic"
    _refuse_if(is_other and not options.seamless, "--boundary is about tilings: it needs --seamless")
    poles = options.poles
    is_number = poles.isdecimal() and int(poles) <= MOST_POLES
    sentence = f"--poles: {poles!r} is not automatic, selected, or a number from 0 to {MOST_POLES}"
    _refuse_if(poles not in ("automatic", "selected") and not is_number, sentence)
    chosen = options.pole or options.rectangle
    _refuse_if(options.seamless and chosen, "--pole and --rectangle cannot be combined with --seamless: use --poles")
    if options.bake is not None:
        place = Path(os.path.realpath(options.bake))
        _refuse_if(not place.parent.is_dir(), f"{options.bake}: the folder {place.parent} does not exist")
        _refuse_if(place.exists() and not place.is_dir(), f"--bake: {options.bake} is not a folder")
    is_number = 0 <= options.texels < math.inf and options.bake_margin >= 0
    _refuse_if(not is_number, "--texels and --bake-margin cannot be negative")
    _refuse_if(min(options.resolution, options.samples) < 1, "--resolution and --samples must be at least 1")


def _refuse_if(is_wrong, sentence):
    if is_wrong:
        raise UsageError(sentence)
