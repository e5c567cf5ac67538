"""How much work is spent on the search for the best map of a part."""

from __future__ import annotations

from typing import Any

from .. import _native

# Operations, of about a nanosecond each: for any part, and for each triangle of up to so many.
ANY, EACH, MANY = 1e9, 2e5, 100_000


class Budget:
    """The work that the search for the map of one part may take, as the native core counts it: not by the clock, and
    the same at any number of threads. What is found first is kept, however long it took.

    Counts within `with`, which may be nested, on one thread at a time.

    triangles : of the part
    effort : times the usual, which is some 5 s of one processor at 20,000 triangles
    """

    def __init__(self, triangles: int, effort: float = 1.0) -> None:
        self._most = effort * (ANY + EACH * min(triangles, MANY))
        self._spent, self._begin, self._depth = 0, 0, 0
        self.was_short = False  # whether something was left out

    def __enter__(self) -> Budget:
        if self._depth == 0:
            self._begin = _native.work()
        self._depth += 1
        return self

    def __exit__(self, *_: Any) -> None:
        self._depth -= 1
        if self._depth == 0:
            self._spent += _native.work() - self._begin

    def allows(self, work: float = 0.0, times: float = 1.0) -> bool:
        """Whether there is so much left, of so many times the budget."""
        now = _native.work() - self._begin if self._depth else 0
        return self._spent + now + work < times * self._most

    def goes_on(self, work: float = 0.0, times: float = 1.0) -> bool:
        """The same, asked where something is left out otherwise."""
        is_left = self.allows(work, times)
        self.was_short |= not is_left
        return is_left
