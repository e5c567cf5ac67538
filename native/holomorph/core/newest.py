"""The results that were asked for last, by what they were made of."""

from collections.abc import Hashable
from typing import Any


class Kept:
    """The values that were asked for last, `limit` bytes at most by their `nbytes`, but always the last one."""

    def __init__(self, limit: int) -> None:
        self.limit, self._values = limit, {}

    def get(self, key: Hashable) -> Any:
        """The value of a key; None where it is not kept."""
        value = self._values.pop(key, None)
        if value is not None:
            self._values[key] = value
        return value

    def keep(self, key: Hashable, value: Any) -> Any:
        """Keeps the value, and returns it."""
        self._values[key] = value
        self.trim()
        return value

    def trim(self) -> None:
        """Drops values beyond the limit. For the caller where values have grown."""
        while len(self._values) > 1 and sum(value.nbytes for value in self._values.values()) > self.limit:
            del self._values[next(iter(self._values))]

    def values(self) -> list[Any]:
        """The values, that which was asked for last at the end."""
        return list(self._values.values())

    def clear(self) -> None:
        self._values.clear()
