"""Images that are drawn by a formula, whose symmetries are known: (rows, columns) of grey."""

import math

import numpy as np


def middles(height, width, rows, columns):
    """y and x of the pixels' middles, in rows and columns."""
    y, x = np.indices((height, width)) + 0.5
    return y * rows / height, x * columns / width


def bricks(height, width, rows, columns, shift):
    y, x = middles(height, width, rows, columns)
    x = x + np.floor(y) * shift
    edge = np.minimum(2 * np.minimum(x % 1, 1 - x % 1), np.minimum(y % 1, 1 - y % 1))
    return 0.2 + 0.6 * np.clip((edge - 0.05) / 0.1, 0, 1)


def hexagons(height, width, rows, columns):
    y, x = middles(height, width, rows, columns)
    distances = [
        np.hypot((x - row / 2 + 0.5) % 1 - 0.5, (y - row) * math.sqrt(0.75))
        for row in (np.round(y) + k for k in (-1, 0, 1))
    ]
    return np.min(distances, axis=0)


def checker(size, squares):
    y, x = np.indices((size, size)) * squares // size
    return ((x + y) % 2).astype(float)


def periodic_noise(height, width, fall, seed):
    """Noise whose spectrum falls with this power of the frequency; of deviation 1."""
    waves = np.fft.rfft2(np.random.default_rng(seed).standard_normal((height, width)))
    u, v = np.fft.rfftfreq(width, 1 / width)[None], np.fft.fftfreq(height, 1 / height)[:, None]
    waves *= np.maximum(np.hypot(u, v), 1) ** -fall
    waves[0, 0] = 0
    noise = np.fft.irfft2(waves, (height, width))
    return noise / noise.std()


def cut_noise(height, width, fall, seed):
    """A part of a larger one, as a photo is."""
    return periodic_noise(2 * height, 2 * width, fall, seed)[:height, :width]
