"""How far a batch is, on the error stream: a bar with an estimate by tqdm; a line at times without it or a terminal."""

import importlib.util
import sys
import time

from ..commands.console import say

EVERY = 10.0  # seconds between lines


def bar(total, noun):
    """With `update()`, one more of `total` is done, `write(line)` beside it, and `close()`."""
    if importlib.util.find_spec("tqdm") is None or sys.stderr is None or not sys.stderr.isatty():
        return Lines(total, noun)
    import tqdm

    class Bar(tqdm.tqdm):
        def write(self, line):
            super().write(line, file=sys.stderr)

    return Bar(total=total, unit=noun, smoothing=0.05)


class Lines:
    """Prints lines in place of tqdm's bar, with the same methods."""

    def __init__(self, total, noun):
        self._total, self._noun, self._done, self._said = total, noun, 0, time.monotonic()

    def update(self):
        self._done += 1
        if time.monotonic() - self._said > EVERY:
            self._said = time.monotonic()
            say(f"holomorph: {self._done} of {self._total} {self._noun}s")

    def write(self, line):
        say(line)

    def close(self):
        pass
