# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves in a worker thread, on copies of the arrays: no bpy in here, so Blender's window stays alive."""

import threading

from .. import native
from . import cache, solve


class Work:
    """Work that runs in a worker thread and can be cancelled: after `cancel()` the thread ends at the library's next
    call of `ask`, and nothing more is solved or cached. Subclasses define `work`; one of `native.refusals` that ends it
    is the `error`."""

    def __init__(self, progress=None):
        self.fraction = 0.0
        self.stage = ""
        self.error = None
        self.failure = None  # anything but holomorph.Error is a bug of ours
        self._progress = progress
        self._cancelled = threading.Event()
        self._thread = threading.Thread(target=self._guarded_run, name="holomorph")

    def start(self):
        self._thread.start()

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

    def run(self):
        """Works here and now, in the calling thread."""
        try:
            self.work()
        except native.refusals() as error:
            self.error = error

    def _guarded_run(self):
        try:
            self.run()
        except BaseException as error:  # noqa: BLE001  raised again by `wait` in the main thread
            self.failure = error

    def ask(self, fraction, stage):
        """The library's progress callback: takes the fraction that is done, returns whether to go on."""
        self.fraction = fraction
        self.stage = stage
        if self._progress is not None:
            self._progress(fraction, stage)
        return not self._cancelled.is_set()

    def part(self, begin, end):
        """`ask` for a part of the work."""
        return native.load().core.progress.scaled(self.ask, begin, end)


def solved(task, ask):
    """The cached solve of a `solve.Task`, or a new one, which is cached. Raises `holomorph.Error`."""
    found = cache.find(task)
    if found is None:
        found = solve.solve(task, ask)
        cache.keep(task, found)
    return found


class Job(Work):
    """Solves a list of `solve.Task` one after the other, and then goes on with the solve of `tasks[i]` as the function
    `then[i](solved, progress=...)` does, if there is one.

    `results[i]` is what that gives, or the `SolvedObject`; or the error that refused the mesh, one of
    `native.refusals`.

    plan(solved) : the indices of `{i: SolvedObject}` in the order in which to go on; by default as they are
    """

    SOLVE_SHARE = 0.3  # part of the work where something follows

    def __init__(self, tasks, progress=None, then=(), plan=list):
        super().__init__(progress)
        self.results = [None] * len(tasks)
        self._tasks, self._then, self._plan = tasks, then, plan

    def work(self):
        count, share = len(self._tasks), self.SOLVE_SHARE if self._then else 1.0
        found = self._each(range(count), 0.0, share, lambda index, ask: solved(self._tasks[index], ask))
        if not self._then:
            for index, result in found.items():
                self.results[index] = result
            return
        followed = self._each(self._plan(found), share, 1.0, lambda index, ask: self._follow(index, found[index], ask))
        for index, result in followed.items():
            self.results[index] = result

    def _follow(self, index, found, ask):
        result = self._then[index](found, progress=ask)
        cache.trim()
        return result

    def _each(self, indices, begin, end, make):
        """{index: what is made}, until the job is cancelled; refusals become results."""
        refusals, indices, made = native.refusals(), list(indices), {}
        for place, index in enumerate(indices):
            if self._cancelled.is_set():
                break
            step = (end - begin) / len(indices)
            try:
                made[index] = make(index, self.part(begin + place * step, begin + (place + 1) * step))
            except refusals as error:
                self.results[index] = error
        return made
