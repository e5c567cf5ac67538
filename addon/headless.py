# SPDX-License-Identifier: GPL-3.0-or-later
"""The add-on without a window: opens a file, presses buttons with the properties that are named, saves, reports.

blender -b --disable-autoexec [file.blend] --python-exit-code 1 --python addon/headless.py -- [file] --press ...

An enabled extension has it as a command of Blender, since 4.2: `blender --command holomorph`. The exit status is that
of the other commands: 2 for a mistake in the command, before any work. Scripts in a .blend file do not run with
--disable-autoexec.
"""

import argparse
import ast
import importlib
import runpy
import sys
import time
from pathlib import Path

import bpy

PRESSES = {name: f"uv.holomorphic_{name}" for name in ("maps", "islands", "tile")}
PRESSES |= {name: f"object.holomorphic_{name}" for name in ("bake", "levels")}
_commands = []  # that Blender knows


class Parser(argparse.ArgumentParser):
    def error(self, message):
        raise ValueError(f"{message} (--press is for buttons, --set NAME=VALUE for their properties)")


def main(arguments):
    """The exit status, after one sentence on the error stream where it is not 0."""
    from . import native

    if native.problem():
        print(f"holomorph: {native.problem()}", file=sys.stderr)
        return 1
    console = native.module("commands.console")

    def run():
        try:
            options = parse(arguments)
        except (ValueError, OSError) as error:
            return console.failed(2, error)
        try:
            process(options)
        except RuntimeError as error:  # also of Blender's operators
            return console.failed(1, _told(error))
        return 0

    return console.ended(run)


def parse(arguments):
    """The options; `presses` are (name, {property: value}). @throws ValueError, OSError"""
    from . import addresses, bl_info, compatibility
    from .native import holomorph

    if not hasattr(bpy.types, "HOLOMORPH_PT_view3d"):  # the add-on is not enabled
        importlib.import_module(__package__).register()
    parser = Parser("holomorph", description="Presses buttons of Holomorph.", epilog=addresses.DOCUMENTATION)
    parser.add_argument("file", nargs="?", type=Path, default=bpy.data.filepath or "no file", help=".blend or a model")
    text = "a button, by default maps; may be repeated, each followed by its properties"
    parser.add_argument("--press", dest="steps", action="append", choices=PRESSES, help=text)
    text = "a property of the button, by the name and with the value that Python has for it"
    parser.add_argument("--set", dest="steps", action="append", metavar="NAME=VALUE", help=text)
    parser.add_argument("--object", action="append", default=[], help="only this object (may be repeated)")
    parser.add_argument("--output", type=Path, help="the result: .blend")
    parser.add_argument("--report", type=Path, help="the report: .json")
    parser.add_argument("--version", action="version", version=".".join(map(str, bl_info["version"])))
    options = parser.parse_args(arguments)
    results = (options.output, ".blend"), (options.report, ".json")
    for path, *known in ((options.file, *compatibility.openers()), *results):
        if path is not None and path.suffix.lower() not in known:
            raise ValueError(f"{path} must end with {' or '.join(known)}")
    holomorph.files.whole_file.require_file(options.file)
    holomorph.files.whole_file.check_places([options.file], options.output, [options.report], overwrite=True)
    steps, options.presses = options.steps or ["maps"], []
    for step in steps if steps[0] in PRESSES else ["maps", *steps]:
        name, _, text = step.partition("=")
        if step in PRESSES:
            options.presses.append((step, {}))
        else:
            options.presses[-1][1][name] = _value(options.presses[-1][0], name, text)
    return options


def _value(button, name, text):
    """The value of an operator's property: as Python has it, or a word. @throws ValueError"""
    properties = bpy.context.window_manager.operator_properties_last(PRESSES[button])
    try:
        value = ast.literal_eval(text)
    except (ValueError, SyntaxError):
        value = text
    try:
        setattr(properties, name, value)
        about = properties.bl_rna.properties[name]
        if about.type in ("INT", "FLOAT") and not about.hard_min <= value <= about.hard_max:
            raise TypeError(f"it is not from {about.hard_min:g} to {about.hard_max:g}")
        if about.subtype == "DIR_PATH" and not Path(text).is_dir():
            raise TypeError("there is no such folder")
    except (AttributeError, TypeError, ValueError) as error:
        raise ValueError(f"--set {name}={text}: {_told(error)}") from error
    return value


def process(options):
    """Does the job. @throws RuntimeError"""
    from .native import holomorph
    from .results import report

    start, entries, whole_file = time.perf_counter(), {}, holomorph.files.whole_file
    try:
        objects = _opened(options.file, options.object)
        for name, values in options.presses:
            objects = _press(name, values, objects, entries)
        if options.output is not None:
            with whole_file.file_beside(options.output) as place:
                bpy.ops.wm.save_as_mainfile(filepath=str(place), check_existing=False, compress=True, copy=True)
    except RuntimeError as error:
        entries = entries or {"": report.refusal_report(options.file.stem, _told(error))}
        raise
    finally:
        if options.report is not None:  # last: what it tells of is in the files
            content = report.run_report(list(entries.values())) | {"seconds": time.perf_counter() - start}
            whole_file.write(options.report, report.as_json(content, indent=1).encode() + b"\n")


def _told(error):
    """What tells of an error in one of Blender's operators, which may be a whole traceback."""
    lines = map(str.strip, str(error).splitlines())
    last = [line for line in lines if line and not line.startswith(("Location:", "File "))][-1]
    return last.removeprefix("Error: ").removeprefix("bpy_struct: item.attr = val:").strip(": ")


def _opened(path, names):
    """The mesh objects of a file that are seen, or those of these names. @throws RuntimeError"""
    from . import compatibility
    from .scene import gathering

    if path != Path(bpy.data.filepath):
        bpy.ops.wm.read_homefile(use_empty=True)
        with compatibility.old_numpy_names():
            compatibility.openers()[path.suffix.lower()](filepath=str(path.absolute()))
    if bpy.context.mode != "OBJECT":
        bpy.ops.object.mode_set(mode="OBJECT")
    bpy.context.view_layer.update()
    found = {o.name: o for o in bpy.context.visible_objects if o.type == "MESH" and not gathering.is_helper(o)}
    for name in {f" {name}" for name in set(names) - found.keys()} if found else [""]:
        raise RuntimeError(f"{path}: no mesh object{name} is seen in it")
    return [found[name] for name in names or sorted(found)]


def _press(name, values, objects, entries):
    """Presses a button, and adds what is reported of each object. The objects for which the next one is pressed.
    @throws RuntimeError nothing was done"""
    from . import compatibility
    from .results import write
    from .scene import stored_dials

    if values.get("texture") == "IMAGE" and Path(values.get("source", "")).is_file():
        values["source"] = bpy.data.images.load(str(Path(values["source"]).absolute())).name
    operator, done, problems = compatibility.operator([PRESSES[name]]), [], []
    kind = getattr(bpy.types, operator.idname())
    # At once are pressed maps with the same dials beside those that are given, and the levels of one object.
    groups = {"bake": [objects], "levels": [[obj] for obj in objects]}.get(name) or stored_dials.alike(objects, values)
    for group in groups:
        for obj in compatibility.objects_in(bpy.context.view_layer):
            obj.select_set(obj in group)
        bpy.context.view_layer.objects.active = group[0]
        outcome = kind.outcome = write.Outcome([obj.name for obj in group])  # of a button that tells of none
        try:
            operator(**values)
        except RuntimeError:
            if kind.outcome is outcome:
                raise
        done += kind.outcome.done
        problems += kind.outcome.problems
        for entry in kind.outcome.entries:
            own = entries.setdefault(entry["object"], {})
            own |= {"baked": entry} if name == "bake" else entry
    if not done:
        raise RuntimeError("; ".join(problems))
    return [bpy.data.objects[name] for name in done]


def register():
    if bpy.app.version >= (4, 2, 0):
        _commands.append(bpy.utils.register_cli_command("holomorph", main))


def unregister():
    while _commands:
        bpy.utils.unregister_cli_command(_commands.pop())


if __name__ == "__main__":
    program = runpy.run_path(str(Path(__file__).with_name("folders.py")))["module"]("headless")
    if status := program.main(sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []):
        sys.exit(status)
