# SPDX-License-Identifier: GPL-3.0-or-later
"""Solves in a worker thread, on copies of the arrays: no bpy in here, so Blender's window stays alive.

A thread, for a call of the library takes seconds or minutes, while Blender's timers run between calls alone. It ends
with the job.
"""

import threading

from .. import native
from ..native import holomorph
from . import solve


class Work:
    """Work that runs in a worker thread and can be cancelled: after `cancel()` the thread ends at the library's next
    call of `watch`, and nothing more is solved or kept. Subclasses define `work`; one of `native.refusals` that ends it
    is the `error`.

    progress : is told the fraction that is done
    """

    def __init__(self, progress=None):
        self.watch = holomorph.core.progress.Watch(progress)
        self.error = None
        self.failure = None  # anything but holomorph.Error is a bug of ours
        self._thread = threading.Thread(target=self._guarded_run, name="holomorph")

    def start(self):
        self._thread.start()

    def cancel(self):
        self.watch.cancel()

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


class Job(Work):
    """Solves a list of `solve.Task` one after the other, and then goes on with all solves as the function `then` does,
    if there is one: from {i: SolvedObject} of `tasks[i]`, and a progress function, it makes {i: result}.

    `results[i]` is that, or the `SolvedObject`; or the error that refused the mesh, one of `native.refusals`.
    """

    SOLVE_SHARE = 0.3  # part of the work where something follows

    def __init__(self, tasks, progress=None, then=None):
        super().__init__(progress)
        self.results = [None] * len(tasks)
        self._tasks, self._then = tasks, then

    def work(self):
        share = self.SOLVE_SHARE if self._then else 1.0
        made = self._solved(share)
        if self._then and made and not self.watch.is_cancelled:
            made = self._followed(made, share)
        for index, result in made.items():
            self.results[index] = result

    def _followed(self, solved, share):
        try:
            return self._then(solved, self.watch.part(share, 1.0))
        except native.refusals() as error:
            return dict.fromkeys(solved, error)
        finally:
            solve.KEPT.trim()  # tilers and maps are part of the solves

    def _solved(self, share):
        """{i: SolvedObject}, until the job is cancelled; refusals become results."""
        refusals, count, made = native.refusals(), len(self._tasks), {}
        for index, task in enumerate(self._tasks):
            if self.watch.is_cancelled:
                break
            try:
                made[index] = solve.solve(task, self.watch.part(share * index / count, share * (index + 1) / count))
            except refusals as error:
                self.results[index] = error
        return made
