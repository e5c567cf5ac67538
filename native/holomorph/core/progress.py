"""Progress functions of parts of the work, one that is looked at, work in a thread, and parts in several threads.

What makes threads is imported when they are made, as it takes long.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from .._native import Cancelled
from .array_types import Progress

if TYPE_CHECKING:
    from concurrent.futures import Future


def scaled(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """A progress function for the part [begin, end] of the work; None for none."""
    if progress is None:
        return None
    return lambda fraction, stage: progress(begin + (end - begin) * fraction, stage)


def tell(progress: Progress | None, fraction: float, stage: str) -> None:
    """Calls the function, if there is one. Raises Cancelled where it returns False."""
    if progress is not None and progress(fraction, stage) is False:
        raise Cancelled("cancelled by the progress function")


class Watch:
    """A progress function that keeps what it was told, for a thread that looks at the work and may cancel it.

    tell : is told the fraction, in the thread that works
    """

    def __init__(self, tell: Callable[[float], object] | None = None) -> None:
        self.fraction, self.stage, self.is_cancelled = 0.0, "", False
        self._tell = tell

    def cancel(self) -> None:
        """The work ends at the next call."""
        self.is_cancelled = True

    def __call__(self, fraction: float, stage: str) -> bool:
        self.fraction, self.stage = fraction, stage
        if self._tell is not None:
            self._tell(fraction)
        return not self.is_cancelled

    def part(self, begin: float, end: float) -> Progress | None:
        """The progress function for a part of the work, as `scaled`."""
        return scaled(self, begin, end)


def in_background(work: Callable[[], object]) -> Future:
    """Starts the work in a thread of its own, which ends with it. The future tells when, and raises what was raised."""
    from concurrent.futures import ThreadPoolExecutor

    pool = ThreadPoolExecutor(1, "holomorph")
    future = pool.submit(work)
    pool.shutdown(wait=False)
    return future


LARGE = 20_000  # triangles from which on a part keeps all threads busy by itself
TICK = 0.02  # seconds between two calls of the progress function


def side_by_side(
    work: Callable[[int, int | None, Progress | None], Any],
    sizes: Sequence[int],
    threads: int | None = None,
    progress: Progress | None = None,
) -> list[Any]:
    """[work(k, threads, progress) for each part k]; of several errors the first one by k is raised.

    Parts of at least `LARGE` triangles have all threads in turn. Then the others are done side by side, the largest
    first, each with one thread. Results may depend neither on the order nor on the number of threads.

    Parameters
    ----------
    work : asks the progress function that it is given whether to go on
    sizes : (n,) triangles of the parts
    threads : None for one per core
    progress : called in the calling thread alone; returning False cancels
    """
    order = sorted(range(len(sizes)), key=lambda k: -sizes[k])
    large = [k for k in order if sizes[k] >= LARGE or len(order) == 1]
    small, total = order[len(large) :], sum(sizes) or 1
    results, done = dict.fromkeys(order), 0.0
    for k in large:
        share = sizes[k] / total
        results[k] = work(k, threads, scaled(progress, done, done + share))
        done += share
    if small:
        crew = _Crew({k: sizes[k] / total for k in small}, done, progress)
        results |= crew.results(work, threads or os.cpu_count() or 1)
    return [results[k] for k in range(len(sizes))]


class _Crew:
    """The threads that do the small parts. They write how far they have come, and the calling thread reads it."""

    def __init__(self, shares, done, progress):
        self._shares, self._progress = shares, progress
        self._before, self._done, self._stage = done, dict.fromkeys(shares, 0.0), ""
        self._goes_on = True

    def results(self, work, threads):
        """{k: result}."""
        from concurrent.futures import ThreadPoolExecutor

        left, found = iter(self._shares), {}
        begun = [[] for _ in range(min(threads, len(self._shares)))]  # parts that each thread has begun
        with ThreadPoolExecutor(len(begun)) as pool:
            try:
                crew = [pool.submit(self._several, work, left, found, own) for own in begun]
                if not self._watch(crew):
                    raise Cancelled("cancelled by the progress function")
            finally:
                self._goes_on = False  # for those that still work when another has failed
        failed = sorted((own[-1], k) for k, own in enumerate(begun) if crew[k].exception() is not None)
        stopped = [each for each in failed if not isinstance(crew[each[1]].exception(), Cancelled)]
        for _, k in [*stopped, *failed]:
            crew[k].result()  # raises
        return found

    def _watch(self, pending: Sequence[Future]):
        """Waits until all are done or one has failed; False if the progress function cancels."""
        from concurrent.futures import FIRST_EXCEPTION, wait

        while pending:
            finished, pending = wait(pending, TICK, FIRST_EXCEPTION)
            if any(one.exception() is not None for one in finished):
                break
            if not self._is_wanted():
                return False
        return True

    def _is_wanted(self):
        if self._progress is None:
            return True
        done = self._before + sum(self._done.values())
        return self._progress(min(done, 1.0), self._stage) is not False

    def _several(self, work, left, found, begun):
        """Takes one part after the other: thousands of tasks would take long to wait for."""
        for k in left:
            if not self._goes_on:
                return
            begun.append(k)
            ask = self._asked_by(k)
            found[k] = work(k, 1, ask)
            ask(1.0, self._stage)

    def _asked_by(self, k):
        def ask(fraction, stage):
            self._done[k], self._stage = fraction * self._shares[k], stage
            return self._goes_on

        return ask
