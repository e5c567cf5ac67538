"""Errors raised at the lines of the add-on that run while a step is written.

Each check raises errors before every line that no earlier check has had, where it is run first and last, and before
some of the others.
"""

import ast
import functools
import sys
from collections import defaultdict

import bpy
from file_state import differences, file_state
from loaded_addon import module
from repository import ROOT

PUT_BACK = module("writing.transaction").PUT_BACK
ADDON = str(ROOT / "addon")
ERRORS = (RuntimeError, MemoryError, KeyboardInterrupt)
STEP = "one_step"  # the function in which everything is written
INJECTED = "injected by the test"
SAMPLE = 25  # one in so many of the lines that earlier checks have had
ASKED = {"_changed", "are_quiet"}  # what Blender alone calls, printing what is raised: nothing is changed meanwhile
_had = set()


class Lines:
    """The lines of the add-on that run from the first call of the function `begin` on, one after the other.

    stop : (file, line, how often it was met before) where `error` is raised, before the line is run
    guards : names of functions whose own lines are left out: Blender calls them, and they put everything back where
        what they call raises an error
    """

    def __init__(self, stop=None, error=None, begin=STEP, guards=()):
        self.met = defaultdict(int)  # (file, line): times
        self.is_raised = False
        self._stop, self._error, self._begin, self._guards = stop, error, begin, guards
        self._is_writing = False

    def __enter__(self):
        sys.settrace(self._call)
        return self

    def __exit__(self, *_error):
        sys.settrace(None)

    def _call(self, frame, _event, _argument):
        code = frame.f_code
        if self.is_raised or not code.co_filename.startswith(ADDON):
            return None
        self._is_writing |= code.co_name == self._begin
        is_elsewhere = self._stop is not None and not code.co_filename.endswith(self._stop[0])
        owner = frame.f_back.f_code if code.co_name.startswith("<") else code  # of a comprehension
        return None if is_elsewhere or owner.co_name in (*ASKED, *self._guards) else self._line

    def _line(self, frame, event, _argument):
        if event == "line" and self._is_writing and not self.is_raised:
            place = frame.f_code.co_filename[len(ADDON) + 1 :], frame.f_lineno
            count = self.met[place]
            self.met[place] += 1
            if self._stop == (*place, count):
                self.is_raised = True
                raise self._error(INJECTED)
        return self._line


any_of = functools.partial(Lines, begin="execute", guards=("clear", "remove"))  # all lines of an operator


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


class Trial:
    """What `press` does to the scene as it is, where errors are raised meanwhile.

    press : a call that writes to the scene
    lines : makes the `Lines` of a stop and an error, or of none
    """

    def __init__(self, press, lines=Lines):
        self._press, self._lines = press, lines
        self._path = bpy.app.tempdir + "before.blend"
        bpy.ops.wm.save_as_mainfile(filepath=self._path)
        for _ in range(3):  # what is kept of a run changes the lines of the next one
            bpy.ops.wm.open_mainfile(filepath=self._path)
            with lines() as run:
                self.result = _result(press)
        self._after = file_state()
        bpy.ops.wm.open_mainfile(filepath=self._path)
        self._before = file_state()
        self.changes, self.met = differences(self._before, self._after), run.met
        # Whether the last error was raised where it is heard: how often a hand that drags is asked depends on the
        # clock, and Python closes a generator that nobody needs any more.
        self.was_met = False

    def left_by(self, stop, error):
        """(what is another afterwards, what was raised) where this error is raised at this stop; nothing is another
        either if all was done already, as where a line that tells of progress is met less often than before."""
        raised, unheard, hook = None, [], sys.unraisablehook
        sys.unraisablehook = unheard.append
        with self._lines(stop, error) as traced:
            try:
                self._press()
            except BaseException as problem:  # noqa: BLE001  whatever comes of it is told
                raised = problem
            finally:
                sys.unraisablehook = hook
        self.was_met = traced.is_raised and not unheard
        found = file_state()
        is_done = found == self._after and PUT_BACK not in str(raised)  # what is run when all is done
        if is_done or not traced.is_raised:
            left = [] if is_done else differences(self._after, found)
            bpy.ops.wm.open_mainfile(filepath=self._path)
            return left, raised
        left = differences(self._before, found)
        if left:
            bpy.ops.wm.open_mainfile(filepath=self._path)
        return left, raised


def _result(press):
    """What it returns; where its operator says that it cannot run here, the sentence."""
    try:
        return press()
    except RuntimeError as error:
        if "poll()" not in str(error):
            raise
        return str(error)


def is_refused(result):
    return isinstance(result, str)


def check(press, lines=Lines, raises=RuntimeError, then=lambda: None):
    """Raises errors while `press` writes to the scene as it is: the file is as before, or all was done already.

    press : returns {"FINISHED"}
    lines : makes the `Lines` of a stop and an error, or of none
    raises : what comes of an error, as `pytest.raises` takes it
    then : called after each error, when the scene was compared
    """
    trial = Trial(press, lines)
    assert trial.result == {"FINISHED"} and trial.changes
    for index, stop in enumerate(_chosen(trial.met)):
        error = ERRORS[index % len(ERRORS)]
        left, raised = trial.left_by(stop, error)
        assert not left, (stop, error)
        assert isinstance(raised, raises) or not trial.was_met, (stop, error)
        then()


def _chosen(met):
    """The stops of this check."""
    found = []
    for index, (file, line, count) in enumerate(stops(met)):
        stop = file, line, count > 0
        if stop not in _had or index % SAMPLE == 0:
            found.append((file, line, count))
        _had.add(stop)
    return found
