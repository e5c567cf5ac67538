"""Raises an error at each line of the add-on that one operator runs in one mode; a program for Blender.

    blender -b --factory-startup --python tests/injection/every_line.py -- NOTES PRESS MODE FIRST

Appends what happens to the file NOTES, a JSON value a line: the number of stops; then of each stop from the number
FIRST on, which one comes, and what was left. So who started it knows at which stop Blender ended.
"""

import json
import os
import sys
from pathlib import Path

sys.path[:0] = [path for path in os.environ.get("HOLOMORPH_TEST_PYTHONPATH", "").split(os.pathsep) if path]
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "support"))

import bpy  # noqa: E402  (found on the path above)
from injection import ERRORS, Trial, any_of, is_refused, stops  # noqa: E402
from loaded_addon import ADDON, module  # noqa: E402
from presses import prepared  # noqa: E402


def main(notes, press, mode, first):
    ADDON.register()
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.app.handlers.load_pre.remove(module("operators.mapping")._forget_solves)  # their times are in the reports
    with open(notes, "a", encoding="utf-8") as file:

        def note(value):
            file.write(json.dumps(value) + "\n")
            file.flush()

        trial = Trial(prepared(press, mode).call, any_of)
        if is_refused(trial.result):
            assert not trial.changes
            note({"refused": trial.result})
            return
        found = stops(trial.met)
        note({"stops": len(found), "lines": len(trial.met)})
        for index in range(int(first), len(found)):
            error = ERRORS[index % len(ERRORS)]
            note({"stop": [*found[index], error.__name__]})
            if os.environ.get("HOLOMORPH_TEST_CRASH_AT") == str(index):
                os.abort()
            left, raised = trial.left_by(found[index], error)
            if raised is None and error is MemoryError:  # a part for which there is no room is skipped
                left, _ = trial.left_by(found[index], KeyboardInterrupt)
            note({"left": left[:10]})


main(*sys.argv[sys.argv.index("--") + 1 :])
sys.stdout.flush()
os._exit(0)  # no exit handlers: some Blenders crash in them
