# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole job from the command line, without a window:

blender -b [file.blend] --python-exit-code 1 --python addon/headless.py -- [mesh file] --output out.blend ...

Ends with 0 if some component got its maps, otherwise with 1 and one sentence on the error stream.
"""

import argparse
import importlib.util
import math
import sys
import time
from functools import partial
from pathlib import Path

import bpy

PACKAGE = "holomorph_headless"  # the name under which this script loads the add-on that it lies in
SHARP_ANGLE = 0.7  # radians, 40 degrees: sharper edges of an imported mesh stay sharp
Z_UP_FROM_Y_UP = math.pi / 2  # radians about the x axis, as Blender's own importers rotate OBJ files


class UsageError(Exception):
    """What the user asked for cannot be done; the text is one sentence."""


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise UsageError(message)


def module(name):
    """One of the add-on's modules, whether or not the add-on is installed and enabled in this Blender."""
    if PACKAGE not in sys.modules:
        folder = Path(__file__).resolve().parent
        spec = importlib.util.spec_from_file_location(
            PACKAGE, folder / "__init__.py", submodule_search_locations=[str(folder)]
        )
        sys.modules[PACKAGE] = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(sys.modules[PACKAGE])
    return importlib.import_module(f"{PACKAGE}.{name}")


def _add_choices(parser):
    group = parser.add_argument_group("choices on one object (vertices counted from 0)")
    group.add_argument("--puncture", type=int, action="append", default=[], metavar="V", help="may be repeated")
    group.add_argument("--residues", default="", metavar='"R R ..."', help="one for each puncture, may be complex")
    group.add_argument("--rectangle", type=int, nargs=4, metavar="V", help="corners on the boundary of a disk")
    group.add_argument("--selection", choices=("automatic", "punctures", "rectangle", "none"), default="none")
    group.add_argument("--cut-at-seams", action="store_true", help="cut along the seams of the .blend")
    group.add_argument(
        "--boundary",
        choices=("natural", "double_cover", "straight", "free"),
        default="natural",
        help="how holes are solved; with --seamless straight (default) or free",
    )
    group.add_argument("--solver", default="auto", help="as in holomorph.conformal_structure")


def parse(arguments):
    textures = [name.lower() for name, *_ in module("properties").TEXTURES]
    parser = Parser(
        prog="blender -b [file.blend] --python-exit-code 1 --python headless.py --",
        description="Conformal UV maps for the surfaces in a mesh file or a .blend file.",
    )
    parser.add_argument("mesh", nargs="?", type=Path, help="OBJ, OFF, PLY or STL; else the meshes of the .blend")
    parser.add_argument("--output", type=Path, help="where to save the .blend with the maps")
    parser.add_argument("--render", type=Path, help="where to save a picture (PNG)")
    parser.add_argument("--report", type=Path, help="where to save the report (JSON)")
    parser.add_argument("--object", action="append", default=[], help="only this object (may be repeated)")
    parser.add_argument("--forms", type=int, default=8, help="at most so many maps of single forms")
    parser.add_argument("--shown", type=int, default=0, help="the active map: 0 is the main one")
    parser.add_argument("--density", type=float, default=1.0, help="factor of all UV lengths")
    parser.add_argument("--margin", type=float, default=0.02, help="between parts, as a share of the UV square")
    parser.add_argument("--rotation", type=float, default=0.0, help="rotation of all maps in degrees")
    parser.add_argument("--seams", action="store_true", help="mark the cuts as seams")
    parser.add_argument("--shape", action="store_true", help="store maps to the sphere and the disk as an attribute")
    parser.add_argument("--no-checker", dest="checker", action="store_false", help="leave materials alone")
    parser.add_argument("--checker-scale", type=float, default=0.0, help="squares per UV unit; 0 chooses")
    parser.add_argument("--texture", choices=textures, default="checker", help="what the material shows")
    parser.add_argument("--up", choices=("Y", "Z"), help="the mesh file's up axis (OBJ: Y, others: Z)")
    parser.add_argument("--resolution", type=int, default=800, help="pixels of the picture's sides")
    parser.add_argument("--samples", type=int, default=24, help="samples per pixel")
    parser.add_argument("--levels", type=int, default=0, help="make so many levels of detail of each object")
    parser.add_argument("--ratio", type=float, default=0.25, help="triangles of a level over those of the one before")
    parser.add_argument("--side-by-side", action="store_true", help="the levels in a row, not in one place")
    parser.add_argument("--main", choices=("automatic", "seamless", "balanced"), default="automatic", help="main map")
    _add_choices(parser)
    module("headless_tile").add_options(parser)
    options = parser.parse_args(arguments)
    check_folders(options.output, options.render, options.report)
    check_values(options)
    return options


def check_folders(*files):
    """Raises `UsageError` for a file whose folder does not exist; None is no file."""
    for path in files:
        if path is not None and not path.resolve().parent.is_dir():
            raise UsageError(f"{path}: the folder {path.resolve().parent} does not exist")


def check_values(options):
    """Raises `UsageError` for values that cannot be."""
    if options.forms < 0 or options.density <= 0 or options.checker_scale < 0 or options.shown < 0:
        raise UsageError("--forms, --shown and --checker-scale cannot be negative, and --density must be positive")
    if not 0 <= options.margin < 1:
        raise UsageError("--margin must be at least 0 and less than 1")
    if options.levels < 0 or not 0 < options.ratio < 1:
        raise UsageError("--levels cannot be negative, and --ratio must be between 0 and 1")
    if options.puncture and options.rectangle:
        raise UsageError("--puncture and --rectangle exclude each other")
    if options.seamless != (options.boundary in ("straight", "free")) and options.boundary != "natural":
        raise UsageError("--boundary is straight or free with --seamless, natural or double_cover without")
    if options.resolution < 1 or options.samples < 1:
        raise UsageError("--resolution and --samples must be at least 1")


def import_mesh(options, holomorph):
    """The mesh file as an object, in an otherwise empty scene unless a .blend was opened; and the file's positions."""
    if not options.mesh.is_file():
        raise UsageError(f"{options.mesh}: no such file")
    surface = holomorph.Surface.read(str(options.mesh))
    if not bpy.data.filepath:
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)
    mesh_io = module("mesh_io")
    mesh = mesh_io.new_mesh(options.mesh.stem, surface.vertices, surface.corner_vertices, surface.face_offsets)
    mesh_io.shade_smooth(mesh, SHARP_ANGLE)
    obj = bpy.data.objects.new(mesh.name, mesh)
    up = options.up or ("Y" if options.mesh.suffix.lower() == ".obj" else "Z")
    if up == "Y":
        obj.rotation_euler.x = Z_UP_FROM_Y_UP
    bpy.context.scene.collection.objects.link(obj)
    bpy.context.view_layer.objects.active = obj
    obj.select_set(True)
    return obj, surface.vertices


def objects_in_file(options):
    if not bpy.data.filepath:
        raise UsageError("name a mesh file after --, or a .blend file before --python")
    meshes = [o for o in bpy.context.view_layer.objects if o.type == "MESH"]
    missing = set(options.object) - {o.name for o in meshes}
    if missing:
        raise UsageError(f"there is no mesh object named {sorted(missing)[0]!r} in the scene")
    if options.object:
        meshes = [o for o in meshes if o.name in options.object]
    if not meshes:
        raise UsageError("there is no mesh object in the scene")
    return meshes


def request(options, holomorph):
    """What is asked of every object; vertices are named for a single one."""
    choices = module("choices")
    if options.solver not in holomorph.SOLVERS:
        raise UsageError(f"--solver: {options.solver!r} is none of {', '.join(holomorph.SOLVERS)}")
    try:
        residues = choices.numbers(options.residues)
    except ValueError as error:
        raise UsageError(f"--residues: {error}") from error
    use, vertices = options.selection.upper(), None
    if options.puncture:
        use, vertices = choices.PUNCTURES, tuple(options.puncture)
    elif options.rectangle:
        use, vertices = choices.RECTANGLE, tuple(options.rectangle)
    return module("targets").Request(use, vertices, residues, options.cut_at_seams, options.boundary, options.solver)


def collect(options, holomorph):
    """The targets: the mesh file, or the objects of the .blend."""
    asked, targets = request(options, holomorph), module("targets")
    if options.mesh is None:
        objects = objects_in_file(options)
        if asked.vertices is not None and len(objects) > 1:
            raise UsageError("vertices are chosen on one object: name it with --object")
        bpy.context.view_layer.update()  # the objects' matrices
        return targets.collect(objects, asked)
    try:
        obj, positions = import_mesh(options, holomorph)
    except holomorph.Error as error:
        raise UsageError(str(error)) from error
    return [targets.with_positions(target, positions) for target in targets.collect([obj], asked)]


def write_options(options):
    show = options.checker, options.texture.upper(), options.checker_scale
    return module("run").WriteOptions(options.shown, *show, options.seams, options.shape)


def make_maps(options, found):
    """Solves the targets and writes their maps; returns the `run.Outcome`."""
    if options.seamless:
        try:
            return module("headless_tile").make(bpy.context, options, found)
        except ValueError as error:
            raise UsageError(str(error)) from error
    rotation, main = math.radians(options.rotation), options.main.upper()
    asked = module("maps").MapOptions(options.forms, options.density, rotation, margin=options.margin, main=main)
    targets, tasks = module("targets"), module("targets").tasks(found)
    job = module("jobs").Job(tasks, then=[partial(module("seamless").make, options=asked)] * len(tasks))
    job.run()
    return module("run").write(bpy.context, found, targets.align(found, job.results), asked, write_options(options))


def add_levels(options, outcome):
    """Levels of detail of every object that got maps; they are added to the report's entries."""
    if not options.levels:
        return []
    wanted, made = module("levels").LevelOptions(options.levels, options.ratio), []
    for entry in outcome.entries:
        if not entry["done"]:
            continue
        obj = bpy.data.objects[entry["object"]]
        found, problem = module("lod").make_levels(bpy.context, obj, wanted, options.side_by_side)
        entry["levels"] = [{"object": o.name, "triangles": len(o.data.polygons)} for o in found]
        outcome.problems += [f"{obj.name}: no levels of detail: {problem}"] if problem else []
        made += found
    return made


def render(options, objects):
    module("studio").render(objects, str(options.render.resolve()), options.resolution, options.samples)
    if not options.render.is_file():
        raise UsageError(f"{options.render}: the picture could not be written")


def process(options):
    """Does the job; returns the sentences about what was not done."""
    native, report = module("native"), module("report")
    if native.problem():
        raise UsageError(native.problem())
    start = time.perf_counter()
    outcome = make_maps(options, collect(options, native.load()))
    levels = add_levels(options, outcome)
    content = report.run_report(outcome.entries)
    content["seconds"] = time.perf_counter() - start
    if options.report is not None:
        options.report.write_text(report.as_json(content, indent=1) + "\n", encoding="utf-8")
    if not outcome.done:
        raise UsageError("no maps were made: " + "; ".join(outcome.problems))
    print(f"Holomorph: maps written to {', '.join(outcome.done)} in {content['seconds']:.2f} s")
    if options.output is not None:
        path = str(options.output.resolve())
        bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False, compress=True)
    if options.render is not None:
        render(options, [bpy.data.objects[name] for name in outcome.done] + levels)
    return outcome.problems + outcome.notes


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    try:
        for sentence in process(parse(arguments)):
            print(f"Holomorph: {sentence}", file=sys.stderr)
    except (UsageError, OSError, RuntimeError) as error:
        # RuntimeError is how Blender's own operators report a file that cannot be written.
        print(f"Holomorph: {' '.join(str(error).split())}", file=sys.stderr)
        sys.stderr.flush()
        sys.exit(1)


if __name__ == "__main__":
    main()
