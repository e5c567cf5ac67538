"""What all results have in common: they are values, which never change."""

import math
from abc import ABC, abstractmethod
from functools import cached_property
from typing import Any, ClassVar

import numpy as np

LONGEST_QUOTATION = 60  # characters


class Value(ABC):
    """Base of results, for people and for other processes. A repr is one short line without arrays. As nothing changes
    a result, a copy of it is the result itself. From a pickle it has the same bits, and arrays are read-only again."""

    _unpickled: ClassVar[tuple[str, ...]] = ()
    """Attributes that a pickle leaves out, because they are computed again when needed."""

    @abstractmethod
    def _facts(self) -> list[str]:
        """The facts that a repr shows."""

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {', '.join(self._facts())}>"

    def __copy__(self):
        return self

    def __deepcopy__(self, memo: object):
        return self

    def __getstate__(self) -> dict[str, Any]:
        return {name: value for name, value in vars(self).items() if name not in self._unpickled}

    def __setstate__(self, state: dict[str, Any]) -> None:
        freeze(state)
        vars(self).update(state)


def counted(count: int, noun: str) -> str:
    """A number with its noun, such as "1 pole" and "2 poles"."""
    return f"{count} {noun}{'' if count == 1 else 's'}"


def rounded(value: float) -> str:
    """A number in two digits, without an exponent up to a million."""
    return f"{float(f'{value:.2g}'):g}"


def percent(part: float) -> str:
    """A part of a whole, such as "38 %"."""
    return "less than 0.01 %" if 0 < part < 1e-4 else f"{rounded(100 * part)} %"


def quoted(value: object) -> str:
    """A wrong value as messages repeat it, on one line, in at most `LONGEST_QUOTATION` characters."""
    try:
        text = " ".join(repr(value).split())
    except (ValueError, RecursionError):  # integers of thousands of digits, lists as deep
        return f"of type {type(value).__name__} and beyond printing"
    return shortened(text)


def shortened(text: str) -> str:
    """A text with at most `LONGEST_QUOTATION` characters."""
    return text if len(text) <= LONGEST_QUOTATION else text[: LONGEST_QUOTATION - 3] + "..."


def freeze(value: object) -> None:
    """Makes the arrays in dictionaries and tuples read-only, as they were before a pickle."""
    if isinstance(value, np.ndarray):
        value.setflags(write=False)
    elif isinstance(value, (dict, tuple)):
        for entry in value.values() if isinstance(value, dict) else value:
            freeze(entry)


class Solution:
    """What the native core computed for a structure. A pickle has the call instead that computes the structure: it is
    made where more is asked for than the pickle has, and gives the same bits."""

    def __init__(self, native):
        self.native, self.compute = native, None

    @cached_property
    def native(self):
        return self.compute()._native

    def __getstate__(self):
        return {"compute": self.compute}


def plain(value: object) -> Any:
    """Dictionaries, sequences, arrays and numbers as JSON has them: complex ones are [real, imaginary], and what is not
    finite is None."""
    if isinstance(value, dict):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist())
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    return None if isinstance(value, float) and not math.isfinite(value) else value
