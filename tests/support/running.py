"""Runs the steps of a script one after the other, writes down what they saw, and ends Blender."""

import itertools
import json
import os
import sys
import time
import traceback

import bpy
from screen import FOLDER, SCRIPT

PATIENCE = 120  # seconds


def wait_until(is_so):
    start = time.monotonic()
    while not is_so() and time.monotonic() - start < PATIENCE:
        yield 0.05


def run(parts, seen):
    """Each part is a function that yields waits in seconds. In each, Blender handles and draws what there is, however
    long that takes, so that waits are short; `wait_until` waits for another thread. The dictionary `seen` at the end,
    with the traceback of an error, is left in the folder, in a file of the script's name."""
    bpy.context.preferences.system.viewport_aa = "OFF"  # it draws views eight times, a second each without a GPU
    steps = itertools.chain.from_iterable(part() for part in parts)

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

    bpy.app.timers.register(tick, first_interval=1, persistent=True)
