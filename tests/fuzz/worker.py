"""worker.py TARGET FIRST SECONDS STATE: tries inputs one after the other, and dies of the first that breaks something.

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

sys.path[:0] = [str(Path(__file__).resolve().parent), str(Path(__file__).resolve().parents[1] / "core")]

TARGETS = ("readers", "progressive", "pipeline", "gluings")
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


def main(name, first, seconds, state):
    import oracle

    target, answers = target_named(name), collections.Counter()
    end = time.monotonic() + seconds
    with open(state, "wb", buffering=0) as file:
        number = first
        while time.monotonic() < end:
            file.seek(0)
            file.write(json.dumps({"number": number, "answers": answers}).encode().ljust(400))
            begin_watch()
            answers[oracle.answer(target.execute, numbered(target, number))] += 1
            number += 1
        file.seek(0)
        file.write(json.dumps({"number": number, "answers": answers}).encode().ljust(400))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), float(sys.argv[3]), sys.argv[4])
