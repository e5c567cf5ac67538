"""Errors raised at the lines of the add-on that run while a step is written."""

import ast
import functools
import sys
from collections import defaultdict

from conftest import ROOT

ADDON = str(ROOT / "addon")
ERRORS = (RuntimeError, MemoryError, KeyboardInterrupt)
STEP = "one_step"  # the function in which everything is written
INJECTED = "injected by the test"


class Lines:
    """The lines of the add-on that run from the first call of `one_step` on, one after the other.

    stop : (file, line, how often it was met before) where `error` is raised, before the line is run
    """

    def __init__(self, stop=None, error=None):
        self.met = defaultdict(int)  # (file, line): times
        self.is_raised = False
        self._stop, self._error, self._is_writing = stop, error, False

    def __enter__(self):
        sys.settrace(self._call)
        return self

    def __exit__(self, *_error):
        sys.settrace(None)

    def _call(self, frame, _event, _argument):
        code = frame.f_code
        if self.is_raised or not code.co_filename.startswith(ADDON):
            return None
        self._is_writing |= code.co_name == STEP
        is_elsewhere = self._stop is not None and not code.co_filename.endswith(self._stop[0])
        return None if is_elsewhere else self._line

    def _line(self, frame, event, _argument):
        if event == "line" and self._is_writing and not self.is_raised:
            place = frame.f_code.co_filename[len(ADDON) + 1 :], frame.f_lineno
            count = self.met[place]
            self.met[place] += 1
            if self._stop == (*place, count):
                self.is_raised = True
                raise self._error(INJECTED)
        return self._line


def stops(met):
    """The first and the last time that each line was met. At the end of a `with` its line is met again, where an error
    would keep Python from leaving it: those times are left out."""
    found = set()
    for (file, line), times in met.items():
        last = times - 1 if line not in _with_lines(file) else (times - 1) // 2 * 2
        found |= {(file, line, 0), (file, line, last)}
    return sorted(found)


@functools.cache
def _with_lines(file):
    nodes = ast.walk(ast.parse(ROOT.joinpath("addon", file).read_text(encoding="utf-8")))
    return {node.lineno for node in nodes if isinstance(node, ast.With)}
