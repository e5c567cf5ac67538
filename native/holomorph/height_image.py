"""Pictures of heights from files."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from .array_types import FilePath, Reals
from .arrays import frozen

WHITE = {"I;16": 2**16 - 1, "I;16B": 2**16 - 1, "I;16L": 2**16 - 1, "I": 2**16 - 1, "F": 1}  # others: 8 bits of grey


def height_image(path: FilePath) -> Reals:
    """(rows, columns) heights of a picture file, from 0 for black to 1 for white, the top row first: PNG with 8 or 16
    bits, and whatever else Pillow reads. Of colours it is the brightness; transparency is not looked at.

    Raises ValueError where it is not a picture, or Pillow is not installed; OSError.
    """
    try:
        from PIL import Image, UnidentifiedImageError
    except ImportError as error:
        raise ValueError(
            "reading pictures needs Pillow, which is not installed: pip install holomorph[relief]"
        ) from error
    with open(path, "rb") as file:
        try:
            with Image.open(file) as picture:
                grey = picture if picture.mode in WHITE else picture.convert("L")
                values = np.asarray(grey, dtype=np.float64)
        except (UnidentifiedImageError, Image.DecompressionBombError, SyntaxError, ValueError, OSError) as error:
            raise ValueError(f"{Path(path).name} is not a readable picture") from error
    return frozen(values / WHITE.get(grey.mode, 255))
