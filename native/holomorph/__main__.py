"""python -m holomorph MESHFILE --output out.glb --report report.json; ... batch SOURCE... --out DIR; ... compare A B;
... relief MESHFILE IMAGE --depth 1mm --output out.3mf; ... quads MESHFILE --faces 2000 --output out.obj"""

import argparse
import contextlib
import json
import sys

from . import Error, Surface, Verdict
from .batch import mapping
from .batch.recipe import Maps, Output, Recipe, Tiles
from .commands.compare_command import compare
from .commands.console import Parser, ended, failed, shown, tell, warn
from .commands.quads_command import quads
from .commands.relief_command import relief
from .core.value import quoted
from .files import formats, whole_file
from .maps.report import part_count
from .mesh.checks import SOLVERS, check_options, check_thresholds
from .tiling.request import AUTO, AUTOMATIC, EVENNESS, LINES, MAIN_MAPS, TURNS, checked_lines

EXIT_REFUSED, EXIT_USAGE, EXIT_STRICT = 1, 2, 3
STANDARD_OUTPUT = "-"


def command():
    """Ends this process, as the program that a user starts."""
    sys.exit(ended(main))


def main(arguments=None):
    """Computes every component; the exit status, other than 0 with one sentence: 1 if no component was done, 2 for
    options that cannot be, 3 with --strict if some component was not done or its map is not fit."""
    arguments = sys.argv[1:] if arguments is None else arguments
    if arguments[:1] == ["batch"]:
        from .batch.command import main as batch

        return batch(arguments[1:])
    if arguments[:1] == ["compare"]:
        return compare(arguments[1:])
    if arguments[:1] == ["relief"]:
        return relief(arguments[1:])
    if arguments[:1] == ["quads"]:
        return quads(arguments[1:])
    options = _parser().parse_args(arguments)
    try:
        report = None if options.report == STANDARD_OUTPUT else options.report
        formats.check_mesh(options.mesh)
        whole_file.check_places([options.mesh], options.output, [report], options.overwrite)
        _check_output(options.output, options.texture)
        recipe, found = mapping.turned(_recipe(options))
        check_options(options.solver, options.threads)
        check_thresholds(options.thresholds, options.solver)
    except (Error, ValueError, OSError) as error:
        return failed(EXIT_USAGE, error)
    try:
        report = mapped(options, recipe, found)
    except (Error, OSError) as error:
        return failed(EXIT_REFUSED, error)
    return _status(report, options.strict)


def _parser():
    parser = Parser(
        description="Compute the conformal structure of a mesh file. See also holomorph batch --help (map a library "
        "of meshes), holomorph compare --help (compare two surfaces), holomorph relief --help (raise a picture on "
        "a mesh for printing) and holomorph quads --help (a mesh of quads).",
    )
    parser.add_argument("mesh", help=f"{formats.KINDS} file")
    parser.add_argument("--output", metavar="FILE", help="write the mesh with its main map: .obj, .ply or .glb")
    text = "with --output FILE.glb: a PNG or JPEG image on the mesh, or checker"
    parser.add_argument("--texture", metavar="IMAGE", help=text)
    parser.add_argument("--overwrite", action="store_true", help="allow --output to replace the input")
    text = "write the report as JSON; - prints it, as without --output and --report"
    parser.add_argument("--report", metavar="FILE", help=text)
    parser.add_argument("--quiet", action="store_true", help="do not print the verdict, which is one line")
    text = "automatic (default with --output, or where tiles are asked for): the best looking map; else balanced"
    parser.add_argument("--main", choices=MAIN_MAPS, help=text)
    parser.add_argument("--tiles", **_of_recipe("tiles"), help="number over the whole mesh (default: 0, chosen)")
    text = f"from 0, which keeps angles, to 1, which makes all squares of one size (default: {EVENNESS})"
    parser.add_argument("--evenness", **_of_recipe("evenness"), help=text)
    text = "2, 4 or 6: sides of a cut may turn by a half, a quarter or a sixth, where the texture looks the same; "
    text += "auto: as the image of --texture does, 1 without one"
    parser.add_argument("--turns", type=_turns, choices=(*TURNS, AUTO), default=1, help=text)
    text = "with --turns 2 or 4: let rows run along hard edges and smooth boundaries (free), or end there (whole)"
    parser.add_argument("--lines", choices=(AUTOMATIC, *LINES), default=AUTOMATIC, help=text)
    parser.add_argument("--solver", default="auto", help=f"{', '.join(SOLVERS)}: as in holomorph.conformal_structure")
    text = "for --solver paper: numbers of faces at which to refine the forms, such as 1000,5000, or none"
    parser.add_argument("--thresholds", type=_thresholds, metavar="FACES", help=text)
    parser.add_argument("--threads", type=int, help="number of threads (default: one per core)")
    parser.add_argument("--strict", action="store_true", help="exit with 3 unless every map is good or fair")
    return parser


def _of_recipe(name):
    """Type and default of an option that is a number of [tiling] in recipes."""

    def read(text):
        value, about = float(text), Tiles.__dataclass_fields__[name].metadata
        if not about["is_valid"](value):
            raise argparse.ArgumentTypeError(f"{text} is given; {about['wanted']} is needed")
        return value

    read.__name__ = "number"  # in the sentence about other words
    return {"type": read, "default": getattr(Tiles(), name), "metavar": "NUMBER"}


def _turns(text):
    return int(text) if text.isdecimal() else text


def _thresholds(text):
    """The numbers of faces, [] for "none"."""
    try:
        return [] if text == "none" else [int(number) for number in text.split(",")]
    except ValueError as error:
        raise argparse.ArgumentTypeError(
            f"{quoted(text)} is not a list of numbers of faces such as 1000,5000"
        ) from error


def _check_output(path, texture):
    """Raises ValueError or OSError, before any work."""
    if path is None:
        if texture is not None:
            raise ValueError("--texture needs --output FILE.glb")
        return
    name = formats.of_path(path)
    if texture is not None:
        formats.check_texture(name, texture)


def _recipe(options):
    """Raises ValueError for lines that maps with these turns cannot have."""
    if options.turns != AUTO:
        checked_lines(options.lines, options.turns, AUTOMATIC)
    tiling = Tiles(**{name: getattr(options, name) for name in ("tiles", "evenness", "turns", "lines")})
    main = options.main or ("automatic" if options.output or tiling != Tiles() else "balanced")
    maps = Maps(main=main, solver=options.solver, thresholds=options.thresholds)
    return Recipe(maps, tiling, output=Output(texture=options.texture))


def mapped(options, recipe, found):
    """The report of all components of the mesh file, as plain data; it and the mesh are written as the options say.
    found : the `ImageTurns` of the texture"""
    surface = Surface.read(options.mesh)
    warn(options.mesh, surface.repairs.notes)
    parts = mapping.map_parts(surface, recipe, threads=options.threads)
    report = mapping.report(surface, parts, recipe, found, mesh=str(options.mesh))
    if options.output and report["verdict"]:
        uv = mapping.main_uv(surface, parts, recipe.maps)
        surface.write(options.output, mapping.moved(uv, surface, parts, recipe, found), options.texture)
    _write(report, options)  # last: what it tells of is in the file
    return report


def _write(report, options):
    if options.report or not options.output:
        text = json.dumps(report, indent=1, allow_nan=False) + "\n"
        if options.report in (None, STANDARD_OUTPUT):
            tell(text)
            return
        whole_file.write(options.report, text.encode())
    if report["verdict"] and not options.quiet:
        with contextlib.suppress(OSError):  # the files are there, whether or not somebody hears of it
            tell(f"{shown(str(options.mesh))}: {report['verdict']['sentence']}\n")


def _status(report, is_strict):
    not_done = [part for part in report["components"] if not part["done"]]
    if report["verdict"] is None:
        return failed(EXIT_REFUSED, not_done[0]["reason"])
    found = Verdict(**report["verdict"])
    if is_strict and not_done:
        count = part_count(report["components"])
        return failed(EXIT_STRICT, f"{part_count(not_done)} of {count} parts have no map: {not_done[0]['reason']}")
    return failed(EXIT_STRICT, found.sentence) if is_strict and not found.is_fit else 0


if __name__ == "__main__":
    command()
