# SPDX-License-Identifier: GPL-3.0-or-later
"""The headless command: makes maps and levels of detail, writes files and the report."""

import signal
import sys
import time
from itertools import chain
from pathlib import Path

import bpy

from .. import native
from ..levels import level_objects
from ..levels.levels import LevelOptions
from ..materials import user_texture
from ..native import holomorph
from ..operators import dials
from ..operators.request import Run
from ..results import report, stored
from ..scene import stored_dials
from ..writing import transaction
from . import baked, exchange, preview_scene, sources
from .options import PROGRAM, Refused, UsageError, parse

EXIT_REFUSED, EXIT_USAGE, EXIT_STRICT, EXIT_FAULT, EXIT_INTERRUPTED = 1, 2, 3, 70, 130


class NotFit(Exception):
    """What --strict does not let pass, though everything was written; the text is one sentence."""


def main(arguments, program=PROGRAM):
    """Ends the process with another status than 0 where the job is not done."""
    signal.signal(signal.SIGINT, signal.default_int_handler)  # Blender's own waits for a second Ctrl-C
    try:
        for sentence in process(parse(arguments, program)):
            print(f"Holomorph: {_shown(sentence)}", file=sys.stderr)
    except UsageError as error:
        _fail(EXIT_USAGE, error)
    except (Refused, OSError, RuntimeError) as error:
        # RuntimeError is how Blender's own operators report a file that cannot be written.
        _fail(EXIT_REFUSED, error)
    except NotFit as error:
        _fail(EXIT_STRICT, error)
    except KeyboardInterrupt:
        _fail(EXIT_INTERRUPTED, "interrupted; files already written are complete")
    except MemoryError:
        _fail(EXIT_REFUSED, "there is not enough memory")
    except Exception as error:  # noqa: BLE001  the outer door: nobody is left to raise it to
        _fail(EXIT_FAULT, native.fault(error))


def _shown(sentence):
    """Without what a terminal acts on, such as in names."""
    if native.problem():
        return sentence
    return native.module("commands.console").shown(sentence)


def _fail(status, error):
    print(f"Holomorph: {_shown(native.sentence(error))}", file=sys.stderr)
    sys.stderr.flush()
    sys.exit(status)


def process(options):
    """Does the job; returns the sentences about what was not done."""
    if native.problem():
        raise Refused(native.problem())
    if not hasattr(bpy.types.Object, stored_dials.NAME):  # the add-on is not enabled
        dials.register()
    _check_places(options)
    start = time.perf_counter()
    try:
        outcome = _make_maps(options)
    except Refused as error:
        source = options.mesh.stem if options.mesh is not None else Path(bpy.data.filepath).stem
        _write_report(options, report.run_report([report.refusal_report(source, str(error))]))
        raise
    if options.bake is not None and outcome.done:
        baked.add(options, outcome)
    levels = _add_levels(options, outcome)
    content = report.run_report(outcome.entries)
    content["seconds"] = time.perf_counter() - start
    if outcome.done:
        _write_files(options, [bpy.data.objects[name] for name in outcome.done] + levels)
    _write_report(options, content)  # last: what it tells of is in the files
    if not outcome.done:
        raise Refused("no maps were made: " + "; ".join(outcome.problems))
    told = f"maps written to {', '.join(outcome.done)} in {content['seconds']:.2f} s"
    print(f"Holomorph: {_shown(told)}", flush=True)
    if options.strict:
        _check_strictly(outcome.entries)
    return options.warnings + outcome.problems + outcome.notes


def _check_places(options):
    sources = [options.mesh or bpy.data.filepath] if options.mesh or bpy.data.filepath else []
    written = [options.render, options.report]
    try:
        holomorph.files.whole_file.check_places(sources, options.output, written, options.overwrite)
    except ValueError as error:
        raise UsageError(str(error)) from error


def _make_maps(options):
    """The `report.Outcome`. @throws Refused"""
    try:
        runs = [Run(own, found, _own_texture(own)) for own, found in sources.collect(options)]
    except ValueError as error:
        raise UsageError(str(error)) from error
    jobs = [run.job() for run in runs]
    for job in jobs:
        job.run()
    with transaction.one_step(bpy.context, list(chain(*(run.objects for run in runs)))) as step:
        return report.together([run.write(step, job) for run, job in zip(runs, jobs)])


def _own_texture(options):
    """The `user_texture.Own`, of the file where its name is that of no image. @throws ValueError"""
    if (
        options.texture == user_texture.IMAGE
        and options.source not in bpy.data.images
        and Path(options.source).is_file()
    ):
        options.source = bpy.data.images.load(str(Path(options.source).resolve()), check_existing=True).name
    return user_texture.chosen(options)


def _add_levels(options, outcome):
    """Levels of detail of every object that got maps; they are added to the report's entries."""
    wanted, made = LevelOptions(options.levels, options.ratio), []
    presentation = level_objects.Presentation(side_by_side=options.side_by_side, finest=options.lod0)
    for entry in [entry for entry in outcome.entries if entry["done"]] if options.levels else ():
        obj = bpy.data.objects[entry["object"]]
        found, told = level_objects.make(bpy.context, obj, wanted, presentation)
        entry["levels"] = [{"object": o.name, "triangles": len(o.data.polygons)} for o in found]
        outcome.problems += [] if found else [f"{obj.name}: no levels of detail: {told[0]}"]
        made += found
    return made


def _write_report(options, content):
    if options.report is not None:
        holomorph.files.whole_file.write(options.report, report.as_json(content, indent=1).encode() + b"\n")


def _write_files(options, objects):
    """The scene, with its own materials in a format of exchange, and a picture of the objects."""
    is_blend = options.output is not None and options.output.suffix.lower() == ".blend"
    if is_blend:
        _save(options.output)
    own = set(bpy.data.objects)
    if options.render is not None:
        with holomorph.files.whole_file.folder_beside(options.render) as folder:
            picture = folder / options.render.name
            preview_scene.render(objects, str(picture), options.resolution, options.samples)
            if not picture.is_file():
                raise Refused(f"{options.render}: the picture could not be written")
    if options.output is not None and not is_blend:
        bpy.data.batch_remove(set(bpy.data.objects) - own)
        try:
            exchange.write(options.output, options.export_forms, options.export_texture)
        except exchange.ExchangeError as error:
            raise Refused(str(error)) from error


def _save(path):
    """As a copy that is moved: in between, Blender's own way leaves no file of the name."""
    with holomorph.files.whole_file.file_beside(path) as place:
        try:
            bpy.ops.wm.save_as_mainfile(filepath=str(place), check_existing=False, compress=True, copy=True)
        except RuntimeError as error:
            raise Refused(f"{path}: Blender cannot write it: {error}") from error


def _check_strictly(entries):
    """@throws NotFit"""
    for entry in entries:
        skipped = [part["reason"] for part in entry.get("components", []) if not part["done"]]
        for reason in [entry["refused"]] if "refused" in entry else skipped:
            raise NotFit(f"{entry['object']}: a part has no map: {reason}")
        found = stored.verdicts(entry)[0]
        if not found.is_fit:
            raise NotFit(f"{entry['object']}: {found.sentence}")
