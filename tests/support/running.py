"""Runs the steps of a script one after the other, writes down what they saw, and ends Blender."""

import json
import os
import sys
import traceback

import bpy
from screen import FOLDER, SCRIPT


def run(steps, seen):
    """`steps` is a generator: each `yield` is a wait in seconds, while Blender handles events and draws. The dictionary
    `seen` at the end, with the traceback of an error, is left in the folder, in a file of the script's name."""

    def finish():
        (FOLDER / SCRIPT.with_suffix(".json").name).write_text(json.dumps(seen, indent=1))
        sys.stdout.flush()
        os._exit(0)

    def tick():
        try:
            return next(steps)
        except StopIteration:
            return finish()
        except BaseException:  # noqa: BLE001  Blender would only drop the timer: the traceback goes to the test
            seen["traceback"] = traceback.format_exc()
            return finish()

    bpy.app.timers.register(tick, first_interval=3, persistent=True)
