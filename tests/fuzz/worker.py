"""Tries inputs one after the other, and dies of the first that breaks something.

worker.py TARGET try FIRST SECONDS STATE
worker.py TARGET save NUMBER STEM: the input of this number as a file
worker.py TARGET replay FILE: tries what is in a file

The number of the input at hand and the answers so far stand in the file STATE, whatever happens. An input that takes
more than LIMIT seconds of the processor's time, or waits for long, ends the process with a traceback.
"""

import collections
import faulthandler
import importlib
import json
import os
import random
import signal
import sys
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Blender does not look at PYTHONPATH by itself.
PATHS = os.environ.get("PYTHONPATH", "").split(os.pathsep)
sys.path[:0] = [str(HERE), str(HERE.parent / "support"), *filter(None, PATHS)]

TARGETS = ("readers", "pipeline", "gluings")
LIMIT = float(os.environ.get("HOLOMORPH_FUZZ_LIMIT", 60))  # seconds of the processor: far more than any input takes
WAIT = 900  # seconds: for threads that wait for each other, on a machine that does other things besides


def target_named(name):
    return importlib.import_module(f"target_{name}")


def numbered(target, number):
    """The input of this number: the same on every machine."""
    return target.make(random.Random(number))


def begin_watch():
    """From now on, the process has so much time, and no more."""
    faulthandler.register(signal.SIGPROF, chain=True)
    signal.setitimer(signal.ITIMER_PROF, LIMIT)
    faulthandler.dump_traceback_later(WAIT, exit=True)


def command(name, *arguments):
    """What runs this file for a target: Python, or Blender."""
    arguments = [name, *map(str, arguments)]
    if name != "operator":
        return [sys.executable, __file__, *arguments]
    blender = os.environ.get("HOLOMORPH_BLENDER") or "blender"
    return [blender, "-b", "--factory-startup", "--python-exit-code", "9", "--python", __file__, "--", *arguments]


def try_numbers(target, first, seconds, state):
    """From `first` on, for some seconds."""
    import oracle

    answers, number = collections.Counter(), first
    end = time.monotonic() + seconds
    with open(state, "wb", buffering=0) as file:
        while True:
            file.seek(0)
            file.write(json.dumps({"number": number, "answers": answers}).encode().ljust(400))
            if time.monotonic() > end:
                return
            begin_watch()
            answers[oracle.answer(target.execute, numbered(target, number))] += 1
            number += 1


def main(name, task, *rest):
    target = target_named(name)
    if task == "try":
        try_numbers(target, int(rest[0]), float(rest[1]), rest[2])
    elif task == "save":
        print(target.save(numbered(target, int(rest[0])), Path(rest[1])))
    else:
        import oracle

        begin_watch()
        print(oracle.answer(target.execute, target.load(Path(rest[0]))))


if __name__ == "__main__":
    main(*sys.argv[sys.argv.index("--") + 1 if "--" in sys.argv else 1 :])
    sys.stdout.flush()
    os._exit(0)  # no exit handlers: those of Blender take seconds
