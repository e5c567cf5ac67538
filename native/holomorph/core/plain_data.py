"""Values as JSON has them: complex numbers are pairs [real, imaginary], and there is no infinity."""

import math
from typing import Any

import numpy as np


def plain(value: object) -> Any:
    """Dictionaries, sequences, arrays and numbers as JSON has them: None for what is not finite."""
    if isinstance(value, dict):
        return {str(name): plain(entry) for name, entry in value.items()}
    if isinstance(value, (list, tuple)):
        return [plain(entry) for entry in value]
    if isinstance(value, (np.ndarray, np.generic)):
        return plain(value.tolist())
    if isinstance(value, complex):
        return [plain(value.real), plain(value.imag)]
    return None if isinstance(value, float) and not math.isfinite(value) else value
