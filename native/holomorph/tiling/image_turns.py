"""The turns that leave an image as it is, found in its pixels: `turns` of tilings that show it."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from ..core.value import Value
from ..quality.verdicts import TURNED
from .image_lattice import LIKE_HEXAGONS, checked, reduced

ALIKE = 0.9  # least correlation with itself turned: what differs then is seen as grain, not as a seam
SIDE = 256  # pixels, at most, of what is turned: finer differences are grain


@dataclass(frozen=True, repr=False)
class ImageTurns(Value):
    """What `image_turns` found.

    turns : 1, 2, 4 or 6, as in `Structure.tile`
    score : the correlation of the image with itself after that turn; where `turns` is 1, the best of any
    centre : (u, v) about which it is turned, from 0 to 1 in its width and height
    text : a sentence
    """

    turns: int
    score: float
    centre: tuple[float, float]
    text: str

    def _facts(self) -> list[str]:
        return [self.text]


def image_turns(pixels: ArrayLike) -> ImageTurns:
    """The smallest turn that leaves an image, repeated in rows and columns, as it is: a half of any image, a quarter of
    a square one, a sixth of one that is the square root of 3 as high as it is wide, whose middle is then like its
    corners.

    A turn is taken if the correlation with the turned image about some centre is `ALIKE` at least, of all centres at
    once: by the convolution theorem the sums over f(x) f(R x + d) are one Fourier transform, and d = c - R c.

    Parameters
    ----------
    pixels : as in `image_lattice`

    Raises ValueError as that does. Cost: a few FFTs of `SIDE` squared
    Source: the convolution theorem; the limits are ours.

    Examples
    --------
    >>> y, x = np.mgrid[:64, :64] // 32
    >>> print(holomorph.image_turns(x ^ y))
    <ImageTurns: Looks the same after quarter turns (100 %)>
    """
    values, aspect = _turned_values(pixels)
    found = [_after(values, aspect, turns) for turns in (6, 4, 2) if _is_possible(aspect, turns)]
    taken = next((one for one in found if one[1] >= ALIKE), None)
    if taken is None:
        best = max(found, key=lambda one: one[1])
        text = f"Looks the same after no turn (the most like it are {TURNED[best[0]]}, {100 * max(best[1], 0.0):.0f} %)"
        return ImageTurns(1, best[1], (0.0, 0.0), text)
    return ImageTurns(*taken, f"Looks the same after {TURNED[taken[0]]} ({100 * taken[1]:.0f} %)")


def most_like(pixels: ArrayLike, turns: int) -> tuple[float, tuple[float, float]]:
    """The greatest correlation of an image with itself after a turn, and the centre of that, as in `ImageTurns`."""
    _, score, centre = _after(*_turned_values(pixels), turns)
    return score, centre


def _turned_values(pixels):
    """((h, w, c) values of mean 0 that are turned, height over width)."""
    values = checked(pixels)
    aspect = values.shape[0] / values.shape[1]
    for _ in range(2):
        values = reduced(values, min(len(values), SIDE)).swapaxes(0, 1)
    return values - values.mean(axis=(0, 1)), aspect


def _is_possible(aspect, turns):
    like = {2: aspect, 4: 1.0, 6: math.sqrt(3)}[turns]
    return abs(aspect / like - 1) < (LIKE_HEXAGONS if turns == 6 else 1e-9)


def _after(values, aspect, turns):
    """(turns, the greatest correlation with the image after a turn, its centre)."""
    height, width = values.shape[:2]
    power = np.square(values).sum()
    angle = 2 * math.pi / turns
    turn = np.array([[math.cos(angle), -math.sin(angle)], [math.sin(angle), math.cos(angle)]])
    turn = np.rint(turn) if turns != 6 else turn
    size = np.array([1.0, aspect])  # in widths
    pixel = size / (width, height)
    y, x = np.indices((height, width))
    before = np.stack([x * pixel[0], y * pixel[1]], axis=-1) @ turn / pixel  # R^-1 x, as rows
    turned = _at(values, before)
    waves = [np.fft.fft2(each, axes=(0, 1)) for each in (values, turned)]
    sums = np.fft.ifft2((np.conj(waves[1]) * waves[0]).sum(axis=2)).real
    row, column = np.unravel_index(np.argmax(sums), sums.shape)
    shift = np.array([column, row]) * pixel
    centre = (np.linalg.solve(np.eye(2) - turn, shift) + pixel / 2) / size % 1
    return turns, float(sums[row, column] / power) if power > 0 else 1.0, tuple(centre.tolist())


def _at(values, places):
    """The periodic image at (h, w, 2) places in pixels, columns first; linear between them."""
    height, width = values.shape[:2]
    low = np.floor(np.round(places, 9)).astype(np.int64)
    share = np.round(places, 9) - low
    result = np.zeros(values.shape)
    for over in (0, 1):
        for right in (0, 1):
            weight = np.abs(1 - over - share[..., 1]) * np.abs(1 - right - share[..., 0])
            result += weight[..., None] * values[(low[..., 1] + over) % height, (low[..., 0] + right) % width]
    return result
