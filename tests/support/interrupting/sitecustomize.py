"""Interrupts the process, as Ctrl-C does, when a module is imported for the first time, or as the interpreter ends.
Python imports this at its start where the folder is on its path."""

import os
import signal
import sys

WHEN = os.environ["HOLOMORPH_TEST_INTERRUPT"]
_left = [1]


def interrupt(event, arguments):
    is_there = arguments[0] == WHEN if event == "import" else event == WHEN
    if is_there and _left:
        _left.pop()
        os.kill(os.getpid(), signal.SIGINT)


sys.addaudithook(interrupt)
