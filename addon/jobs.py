# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves in a worker thread, on copies of the arrays: no bpy in here, so Blender's window stays alive."""

import threading

from . import cache, native, solve


class Job:
    """Solves a list of `solve.Task` one after the other.

    `results[i]` is a `SolvedObject`, or the `holomorph.Error` that refused the mesh. After `cancel()` the
    thread ends at the library's next question, and nothing more is solved or kept.
    """

    def __init__(self, tasks, progress=None):
        self.results = [None] * len(tasks)
        self.fraction = 0.0
        self.stage = ""
        self.failure = None  # anything but holomorph.Error is our bug: raised again in the main thread
        self._tasks = tasks
        self._progress = progress
        self._cancelled = threading.Event()
        self._thread = threading.Thread(target=self._guarded_run, name="holomorph")

    def start(self):
        self._thread.start()

    def run(self):
        """Solves here and now, in the calling thread."""
        error_type = native.load().Error
        for index, task in enumerate(self._tasks):
            if self._cancelled.is_set():
                return
            solved = cache.find(task.key)
            if solved is None:
                try:
                    solved = solve.solve(task, lambda f, s, i=index: self._ask(i, f, s))
                except error_type as error:
                    solved = error
                else:
                    cache.keep(task.key, solved)
            self.results[index] = solved

    def cancel(self):
        self._cancelled.set()

    def is_running(self):
        return self._thread.is_alive()

    def wait(self):
        """Waits for the thread, and raises what went wrong in it unexpectedly."""
        if self._thread.ident is not None:
            self._thread.join()
        if self.failure is not None:
            raise self.failure

    def _guarded_run(self):
        try:
            self.run()
        except BaseException as error:  # noqa: BLE001  carried to the main thread, not swallowed
            self.failure = error

    def _ask(self, index, fraction, stage):
        self.fraction = (index + fraction) / len(self._tasks)
        self.stage = stage
        if self._progress is not None:
            self._progress(self.fraction, stage)
        return not self._cancelled.is_set()
