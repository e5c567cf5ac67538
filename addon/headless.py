# SPDX-License-Identifier: GPL-3.0-or-later
"""The whole job from the command line, without a window:

blender -b [file.blend] --python-exit-code 1 --python addon/headless.py -- [mesh file] --output out.blend ...

Ends with 0 if some component got its maps, otherwise with 1 and one sentence on the error stream; with --strict also
with 3 and one sentence, everything written, where a part was left out or the verdict on a map is poor or unusable.
"""

import importlib.util
import math
import sys
import time
from pathlib import Path

import bpy

PACKAGE = "holomorph_headless"  # the name under which this script loads the add-on that it lies in
EXIT_REFUSED, EXIT_STRICT = 1, 3
SHARP_ANGLE = 0.7  # radians, 40 degrees: sharper edges of an imported mesh stay sharp
Z_UP_FROM_Y_UP = math.pi / 2  # radians about the x axis, as Blender's own importers rotate OBJ files


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


command_line = module("command_line.command_line")
UsageError = command_line.UsageError


class NotFit(Exception):
    """What --strict does not let pass, though everything was written; the text is one sentence."""


def import_mesh(options, holomorph):
    """The mesh file as an object, in an otherwise empty scene unless a .blend was opened; and the file's positions."""
    surface = holomorph.Surface.read(str(options.mesh))
    empty_scene()
    mesh_io = module("scene.mesh_io")
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


def empty_scene():
    if not bpy.data.filepath:
        for obj in list(bpy.data.objects):
            bpy.data.objects.remove(obj)


def import_objects(options):
    """The objects of a file that Blender's importers read."""
    empty_scene()
    try:
        return module("command_line.exchange").read(options.mesh, options.up or "Y")
    except module("command_line.exchange").ExchangeError as error:
        raise UsageError(str(error)) from error


def objects_in_file(options):
    if options.mesh is not None:
        return named(options, import_objects(options))
    if not bpy.data.filepath:
        raise UsageError("name a mesh file after --, or a .blend file before --python")
    return named(options, [o for o in bpy.context.view_layer.objects if o.type == "MESH"])


def named(options, meshes):
    """Those of the mesh objects that --object names, or all."""
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
    choices, targets = module("solving.choices"), module("scene.targets")
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
    faces = targets.use_of_faces(use) if use == choices.FACES else module("scene.faces").WHOLE
    are_islands = options.main == "islands"
    cut, boundary = options.cut_at_seams or are_islands, choices.ISLANDS if are_islands else options.boundary
    how = cut, boundary, options.solver, faces, options.modifiers, options.hard_edges, options.most_stretch
    return targets.Request(targets.use_of_vertices(use), vertices, residues, *how)


def collect(options, holomorph):
    """The targets: the mesh file, or the objects of the .blend."""
    asked, targets = request(options, holomorph), module("scene.targets")
    if options.mesh is not None and not options.mesh.is_file():
        raise UsageError(f"{options.mesh}: no such file")
    if options.mesh is None or module("command_line.exchange").is_read_here(options.mesh):
        objects = objects_in_file(options)
        if asked.vertices is not None and len(objects) > 1:
            raise UsageError("vertices are chosen on one object: name it with --object")
        bpy.context.view_layer.update()  # the objects' matrices
        try:
            return targets.collect(objects, asked)
        except module("scene.faces").NoFaces as error:
            raise UsageError(f"--selection faces: {error}") from error
    try:
        obj, positions = import_mesh(options, holomorph)
    except holomorph.Error as error:
        raise UsageError(str(error)) from error
    return [targets.with_positions(target, positions) for target in targets.collect([obj], asked)]


def write_options(options):
    show = options.checker, options.texture.upper(), options.checker_scale
    return module("results.run").WriteOptions(options.shown, *show, options.seams, options.shape)


def make_maps(options, found):
    """Solves the targets and writes their maps; returns the `run.Outcome`."""
    if options.seamless:
        try:
            return module("command_line.headless_tile").make(bpy.context, options, found)
        except ValueError as error:
            raise UsageError(str(error)) from error
    rotation, main = math.radians(options.rotation), options.main.upper()
    asked = module("maps.maps").MapOptions(options.forms, options.density, rotation, margin=options.margin, main=main)
    targets, tasks = module("scene.targets"), module("scene.targets").tasks(found)
    mapper = module("maps.seamless").Mapper(asked, options.equal)
    job = module("solving.jobs").Job(tasks, then=[mapper] * len(tasks))
    job.run()
    results = targets.align(found, job.results)
    return module("results.run").write(bpy.context, found, results, mapper.options(results), write_options(options))


def add_levels(options, outcome):
    """Levels of detail of every object that got maps; they are added to the report's entries."""
    if not options.levels:
        return []
    wanted, made = module("levels.levels").LevelOptions(options.levels, options.ratio), []
    for entry in outcome.entries:
        if not entry["done"]:
            continue
        obj = bpy.data.objects[entry["object"]]
        arrangement = {"side_by_side": options.side_by_side, "finest": options.lod0}
        found, problem = module("operators.lod").make_levels(bpy.context, obj, wanted, **arrangement)
        entry["levels"] = [{"object": o.name, "triangles": len(o.data.polygons)} for o in found]
        outcome.problems += [f"{obj.name}: no levels of detail: {problem}"] if problem else []
        made += found
    return made


def render(options, objects):
    module("command_line.studio").render(objects, str(options.render.resolve()), options.resolution, options.samples)
    if not options.render.is_file():
        raise UsageError(f"{options.render}: the picture could not be written")


def write_files(options, objects):
    """The scene, with its own materials in a format of exchange, and a picture of the objects."""
    is_blend = options.output is not None and options.output.suffix.lower() == ".blend"
    if is_blend:
        path = str(options.output.resolve())
        bpy.ops.wm.save_as_mainfile(filepath=path, check_existing=False, compress=True)
    own = set(bpy.data.objects)
    if options.render is not None:
        render(options, objects)
    if options.output is not None and not is_blend:
        for studio in set(bpy.data.objects) - own:
            bpy.data.objects.remove(studio)
        try:
            module("command_line.exchange").write(options.output)
        except module("command_line.exchange").ExchangeError as error:
            raise UsageError(str(error)) from error


def write_report(options, content):
    if options.report is not None:
        text = module("results.report").as_json(content, indent=1)
        options.report.write_text(text + "\n", encoding="utf-8")


def source_name(options):
    """What is read, for the report of its refusal."""
    return options.mesh.stem if options.mesh is not None else Path(bpy.data.filepath).stem


def process(options):
    """Does the job; returns the sentences about what was not done."""
    native, report = module("native"), module("results.report")
    if native.problem():
        raise UsageError(native.problem())
    start = time.perf_counter()
    try:
        outcome = make_maps(options, collect(options, native.load()))
    except UsageError as error:
        write_report(options, report.run_report([report.refusal_report(source_name(options), str(error))]))
        raise
    levels = add_levels(options, outcome)
    content = report.run_report(outcome.entries)
    content["seconds"] = time.perf_counter() - start
    write_report(options, content)
    if not outcome.done:
        raise UsageError("no maps were made: " + "; ".join(outcome.problems))
    print(f"Holomorph: maps written to {', '.join(outcome.done)} in {content['seconds']:.2f} s")
    write_files(options, [bpy.data.objects[name] for name in outcome.done] + levels)
    if options.strict:
        check_strictly(outcome.entries)
    return outcome.problems + outcome.notes


def check_strictly(entries):
    """@throws NotFit"""
    report = module("results.report")
    for entry in entries:
        skipped = [part["reason"] for part in entry.get("components", []) if not part["done"]]
        for reason in [entry["refused"]] if "refused" in entry else skipped:
            raise NotFit(f"{entry['object']}: a part has no map: {reason}")
        found = report.verdict(entry)
        if not found.is_fit:
            raise NotFit(f"{entry['object']}: {found.text}")


def main():
    arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
    try:
        for sentence in process(command_line.parse(arguments)):
            print(f"Holomorph: {sentence}", file=sys.stderr)
    except (UsageError, OSError, RuntimeError) as error:
        # RuntimeError is how Blender's own operators report a file that cannot be written.
        fail(EXIT_REFUSED, error)
    except NotFit as error:
        fail(EXIT_STRICT, error)


def fail(status, error):
    print(f"Holomorph: {' '.join(str(error).split())}", file=sys.stderr)
    sys.stderr.flush()
    sys.exit(status)


if __name__ == "__main__":
    main()
