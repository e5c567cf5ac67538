"""The translations and turns that leave an image as it is, found in its pixels, for tilings that show it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction

import numpy as np
from numpy.typing import ArrayLike

from ..core import arrays
from ..core.array_types import Reals
from ..core.value import Value
from ..quality.verdicts import TURNED

LEAST_CONTINUED = 16  # lines of a reduced image, from which on borders are compared: fewer say nothing
JUMP = 1.5  # most that an image jumps across its border, over the largest jump inside: equal in the mean where it tiles
OFF_LATTICE = 5e-4  # part of an image's variance that a translation may change: noise of a compressed file
MOST_PIXELS = 1024  # a side, for translations: finer differences between cells are not seen
PRIMES = (2, 3, 5, 7, 11, 13, 17, 19, 23, 29, 31)  # of which the number of cells in an image is a product
LIKE_HEXAGONS = 0.02  # relative difference of a cell's height from that of regular hexagons
IDENTITY = np.array([[Fraction(1), Fraction(0)], [Fraction(0), Fraction(1)]])  # exact, as are the lattices made of it
BORDERS = ("left and right", "lower and upper")
ALIKE = 0.9  # least correlation with itself turned: what differs then is seen as grain, not as a seam
SIDE = 256  # pixels, at most, of what is turned: finer differences are grain


@dataclass(frozen=True, eq=False, repr=False)
class ImageLattice(Value):
    """What `image_lattice` found.

    tiles : whether opposite borders continue each other
    jumps : across the left and right, and the lower and upper border, over the largest jumps inside
    translations : (2, 2), whose columns leave the image as it is, in its width and height; the first lies along u
    lattice : (2, 2) the same in its width, for `Structure.tile`: an image is then one UV unit wide
    text : a sentence
    """

    tiles: bool
    jumps: tuple[float, float]
    translations: Reals
    lattice: Reals
    text: str

    @property
    def cells(self) -> int:
        """How many cells of the lattice an image has."""
        return round(1 / float(np.linalg.det(self.translations)))

    def _facts(self) -> list[str]:
        return [self.text]


def image_lattice(pixels: ArrayLike) -> ImageLattice:
    """The finest lattice of translations that leave an image as it is; that of whole images where its cells differ, or
    where it does not tile.

    It tiles if in no direction the root mean square jump across the border is more than `JUMP` times the largest
    between two neighbouring lines inside, in the image and in ones reduced to half its size again and again, which
    show a slow change of light. A translation is taken if the parts of the Fourier series that it changes have no more
    than `OFF_LATTICE` of the variance: by the Wiener-Khinchin theorem that is 1 less the mean autocorrelation over the
    multiples of the translation.

    Parameters
    ----------
    pixels : (h, w) or (h, w, 1 to 4), numbers of any kind, the lowest row first; the fourth channel is opacity

    Raises ValueError for another shape, and for numbers that are not finite. Cost: an FFT of `MOST_PIXELS` squared
    Source: the Wiener-Khinchin theorem; the limits are ours.

    Examples
    --------
    >>> pixels = np.tile(np.eye(4), (4, 4))
    >>> print(holomorph.image_lattice(pixels))
    <ImageLattice: Tiles; rows shifted by 1/4, 64 cells in the image>
    """
    values = checked(pixels)
    height, width = values.shape[:2]
    jumps = (_jump(values.transpose(1, 0, 2)), _jump(values))
    differing = [name for name, jump in zip(BORDERS, jumps) if jump > JUMP]
    found = IDENTITY
    if differing:
        text = f"Does not tile: its {' and its '.join(f'{name} borders' for name in differing)} differ"
    elif np.ptp(values, axis=(0, 1)).max() == 0:
        text = "Tiles: it has one colour"
    else:
        found = _translations(values)
        text = "Tiles" + _cells_text(found, height / width)
    translations = np.array(found, float)
    return ImageLattice(
        tiles=not differing,
        jumps=jumps,
        translations=arrays.frozen(translations),
        lattice=arrays.frozen(np.array([[1.0], [height / width]]) * translations),
        text=text,
    )


def checked(pixels):
    """(h, w, c) reals from -1 to 1, colours times opacity."""
    values = np.asarray(pixels)
    values = values[:, :, None] if values.ndim == 2 else values
    if values.ndim != 3 or not all(values.shape) or values.shape[2] > 4 or values.dtype.kind not in "buif":
        raise ValueError(f"pixels have the shape {np.shape(pixels)}; numbers (h, w) or (h, w, 1 to 4) are needed")
    values = values.astype(np.float64)
    if not np.isfinite(values).all():
        raise ValueError("pixels must be finite numbers")
    values /= np.abs(values).max(axis=(0, 1)).clip(np.finfo(float).tiny)
    if values.shape[2] == 4:
        values[..., :3] *= values[..., 3:]
    return values


def _jump(values):
    """The jump from the last line to the first, over the largest between two neighbouring ones: the worst of an image,
    (n, m, c), and of smaller ones."""
    worst, count = 0.0, len(values)
    while count > 1:
        inside = np.sqrt(np.square(np.diff(values, axis=0)).mean(axis=(1, 2))).max()
        border = np.sqrt(np.square(values[-1] - values[0]).mean())
        worst = max(worst, border / inside if inside > 0 else 0.0)
        if count < 2 * LEAST_CONTINUED:
            break
        count //= 2
        values = reduced(reduced(values, count).swapaxes(0, 1), max(1, values.shape[1] // 2)).swapaxes(0, 1)
    return float(worst)


def reduced(values, count):
    """Means of this number of bands of lines, as equal as they can be."""
    begins = np.arange(count) * len(values) // count
    sizes = np.diff(np.append(begins, len(values)))
    return np.add.reduceat(values, begins, axis=0) / sizes[:, None, None]


def _translations(values):
    """(2, 2) fractions of the image's sides, the first column along u."""
    for _ in range(2):
        values = reduced(values, min(len(values), MOST_PIXELS)).swapaxes(0, 1)
    frequencies, power = _spectrum(values)
    basis, allowed = IDENTITY, OFF_LATTICE * power.sum()
    while len(power):
        found = _finer(frequencies, power, allowed)
        if found is None:
            break
        step, is_kept = found
        allowed -= power[~is_kept].sum()
        frequencies, power = frequencies[is_kept], power[is_kept]
        basis = basis @ step
        # In the vectors of the finer lattice frequencies are whole numbers again.
        scale = math.lcm(*(entry.denominator for entry in step.flat))
        frequencies = frequencies @ (scale * step).astype(np.int64) // scale
    return _along_rows(basis)


def _spectrum(values):
    """((n, 2) frequencies along u and v, (n,) power), but for the mean; those that are rounding alone are left out."""
    height, width, count = values.shape
    values = values - values.mean(axis=(0, 1))
    padded = np.concatenate([values, np.zeros((height, width, count % 2))], axis=2)
    waves = np.fft.fft2(padded[..., ::2] + 1j * padded[..., 1::2], axes=(0, 1))  # two channels at once
    power = np.square(np.abs(waves)).sum(axis=2)
    rows, columns = np.nonzero(power > np.finfo(float).eps * power.max())
    along, up = np.fft.fftfreq(width, 1 / width)[columns], np.fft.fftfreq(height, 1 / height)[rows]
    return np.rint(np.stack([along, up], axis=1)).astype(np.int64), power[rows, columns]


def _finer(frequencies, power, allowed):
    """(step to the basis of a finer lattice, (n,) whether a frequency is kept), the one that loses least; None where
    all lose too much. Translations along which an image does not change at all are no reason for finer lattices."""
    line = _common_line(frequencies, power, allowed)
    best, least = None, allowed
    for prime in PRIMES:
        rest = frequencies % prime
        table = np.bincount(prime * rest[:, 0] + rest[:, 1], power, prime * prime).reshape(prime, prime)
        k, m = np.indices(table.shape)
        for x, y in [(1, 0), (0, 1)] + [(1, y) for y in range(1, prime)]:
            lost = table[(x * k + y * m) % prime != 0].sum()
            if lost <= least and (best is None or lost < least) and (line is None or line @ (x, y) % prime):
                best, least = (prime, x, y), lost
    if best is None:
        return None
    prime, x, y = best
    step = IDENTITY.copy()
    step[:, 0 if x else 1] = np.array([x, y]) * Fraction(1, prime)
    return step, (frequencies @ (x, y)) % prime == 0


def _common_line(frequencies, power, allowed):
    """The shortest whole vector along which all frequencies lie, but for weak ones; None where they do not."""
    strong = frequencies[np.argmax(power)]
    is_off = frequencies[:, 0] * strong[1] != frequencies[:, 1] * strong[0]
    return None if power[is_off].sum() > allowed else strong // math.gcd(*strong.tolist())


def _along_rows(basis):
    """The same lattice by one vector along u, and one whose part along u is least."""
    (a, b), (c, d) = basis
    while c:  # Euclid's algorithm on the parts along v
        times = d // c
        a, b, c, d = b - times * a, a, d - times * c, c
    a, d, b = abs(a), abs(d), b if d > 0 else -b
    shift = b % a
    return [[a, shift - a if 2 * shift > a else shift], [Fraction(0), d]]


def _cells_text(basis, aspect):
    """The part of the sentence that follows "Tiles"."""
    (width, shift), (_, height) = basis
    count = 1 / (width * height)
    if count == 1:
        return ""
    if not shift:
        return f"; it repeats {1 / width} by {1 / height} times within itself"
    part = abs(shift / width)
    if part != Fraction(1, 2):
        return f"; rows shifted by {part}, {count} cells in the image"
    ratio = aspect * float(height / width)
    is_hexagonal = any(abs(ratio / regular - 1) < LIKE_HEXAGONS for regular in (math.sqrt(0.75), math.sqrt(1 / 12)))
    return f"; {'hexagons' if is_hexagonal else 'bricks'}, rows shifted by half, {count} cells in the image"


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
