"""Whether two sets of renders show the same thing: a z-test for each block of pixels and channel."""

from statistics import NormalDist
from typing import NamedTuple

import numpy as np

BLOCK = 16  # pixels along a side
FAMILY_ERROR = 1e-3  # chance of any false alarm in all comparisons of a run of the tests
MOST_COMPARISONS = 20_000  # of such a run: some 70 scenes of 48 blocks and 4 channels
Z_LIMIT = NormalDist().inv_cdf(1 - FAMILY_ERROR / MOST_COMPARISONS / 2)
ROUNDING = 1e-5  # of the picture's mean: what float32 leaves of a block's mean, as a standard error


class Verdict(NamedTuple):
    z: float  # largest of any block and channel, in standard errors of the normal distribution
    percent: float  # largest difference of two blocks, of the second picture's mean
    block: tuple  # column, row and channel of the largest z
    rms: float  # of z over all blocks that vary: 1 where both are the same picture

    @property
    def agrees(self):
        return self.z <= Z_LIMIT


def judge(first, second):
    """`first`, `second`: [seeds x height x width x channels], each seed an independent render.

    The variance of a pixel's mean is estimated from its seeds, that of a block's from its pixels, which are
    independent. Blocks where few pixels vary have few degrees of freedom [Welch-Satterthwaite].
    """
    count = _blocks(np.ones(first.shape[1:]))
    difference = np.abs(_blocks(first.mean(axis=0) - second.mean(axis=0))) / count
    mean = np.abs(second).mean() or 1.0
    noise, squares = sum(np.array(_variance(pictures, count)) for pictures in (first, second))
    variance = noise + (ROUNDING * mean) ** 2
    z = normal_score(difference / np.sqrt(variance), variance**2 / np.maximum(squares, 1e-9 * variance**2))
    worst = np.unravel_index(np.argmax(z), z.shape)
    noisy = noise > 0
    return Verdict(
        float(z.max()),
        float(100 * difference.max() / mean),
        (int(worst[1]), int(worst[0]), int(worst[2])),
        float(np.sqrt((z[noisy] ** 2).mean())) if noisy.any() else 0.0,
    )


def _variance(pictures, count):
    """Of the means of blocks of `count` pixels, and the square that its degrees of freedom go by."""
    pixel = pictures.var(axis=0, ddof=1, dtype=np.float64) / len(pictures)
    return _blocks(pixel) / count**2, _blocks(pixel**2 / (len(pictures) - 1)) / count**4


def normal_score(t, freedom):
    """The normal deviate of the same tail as Student's `t`, to two digits or better [Wallace 1959]."""
    return np.sqrt(freedom * np.log1p(t**2 / freedom)) * (8 * freedom + 1) / (8 * freedom + 3)


def _blocks(values):
    """Sums of [height x width x channels] over blocks; the last of a row or column is what is left."""
    rows, columns = (np.arange(0, size, BLOCK) for size in values.shape[:2])
    return np.add.reduceat(np.add.reduceat(values.astype(np.float64), rows, axis=0), columns, axis=1)
