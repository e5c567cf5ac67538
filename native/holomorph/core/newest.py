"""The results that were made last, by what they were made of."""

from collections.abc import Hashable
from typing import Any


class Newest:
    """The values that were kept last, `count` at most. Several threads may use one: a value that was dropped is made
    again.
    """

    def __init__(self, count: int) -> None:
        self._count, self._values = count, {}

    def get(self, key: Hashable) -> Any:
        """The value of a key; None where it is not kept."""
        return self._values.get(key)

    def keep(self, key: Hashable, value: Any) -> Any:
        """Keeps the value as the newest one, and returns it."""
        self._values.pop(key, None)
        self._values[key] = value
        for oldest in list(self._values)[: -self._count]:
            self._values.pop(oldest, None)
        return value
