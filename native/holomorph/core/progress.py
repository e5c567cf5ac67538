"""Progress functions of parts of the work, one that is looked at, and work in a thread."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from .array_types import Progress

if TYPE_CHECKING:
    from concurrent.futures import Future


def scaled(progress: Progress | None, begin: float, end: float) -> Progress | None:
    """A progress function for the part [begin, end] of the work; None for none."""
    if progress is None:
        return None
    return lambda fraction, stage: progress(begin + (end - begin) * fraction, stage)


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
