"""Whether two estimates of a picture show the same thing: a z-test for each block of pixels and channel."""

from statistics import NormalDist
from typing import NamedTuple

import numpy as np

BLOCK = 16  # pixels along a side
WHOLE = 1 << 30  # a block that holds any picture
FAMILY_ERROR = 1e-3  # chance of any false alarm in all comparisons of a run of the tests
MOST_COMPARISONS = 20_000  # of such a run: some 70 scenes of 48 blocks and 4 channels
POWER = 2.326  # standard errors beyond the limit for 99 of 100 cases
ROUNDING = 1e-5  # of the picture's mean: what float32 leaves of a block's mean, as a standard error
HALF_ROUNDING = 2**-11 / np.sqrt(3)  # relative standard error of a half float


def z_limit(comparisons, level=FAMILY_ERROR):
    """Limit of z: any of so many comparisons exceeds it by chance with probability `level`."""
    return NormalDist().inv_cdf(1 - level / max(comparisons, 1) / 2)


Z_LIMIT = z_limit(MOST_COMPARISONS)


class Estimate(NamedTuple):
    """A picture known from independent renders."""

    mean: np.ndarray  # [height x width x channels] float64
    variance: np.ndarray  # of the mean, alike
    seeds: int  # that the variance is estimated from
    rounding: float = 0.0  # relative standard error of values that were stored

    def channels(self, which):
        """The same of some channels."""
        return self._replace(mean=self.mean[..., which], variance=self.variance[..., which])


class Verdict(NamedTuple):
    z: float  # largest of any block and channel, in standard errors of the normal distribution
    percent: float  # largest difference of two blocks, of the second picture's mean
    block: tuple  # column, row and channel of the largest z
    rms: float  # of z over all blocks that vary: 1 where both are the same picture
    sees: float  # factor, in per cent, that is seen in 99 of 100 cases in half of the blocks that vary
    limit: float = Z_LIMIT  # that z may not exceed

    @property
    def agrees(self):
        return self.z <= self.limit


def estimate(pictures):
    """Estimate from [seeds x height x width x channels]. Seeds are independent renders, read one by one."""
    mean = squares = np.float64(0)
    for count, picture in enumerate(pictures, 1):
        step = picture - mean
        mean = mean + step / count
        squares = squares + step * (picture - mean)
    return Estimate(mean, squares / (count - 1) / count, count)


def estimate_single(picture, renders):
    """Estimate from one picture whose errors are unknown, given the Estimate of renders of the same scene.

    The picture is assumed to be noisy where the renders are. The noise of each block is found from the
    median of (picture - renders)^2 / variance, and is at least that of one render. For independent normal
    noise, this ratio is distributed as a multiple of the square of Student's t. A difference beyond noise
    widens the error bars of its own block, but one that all n pixels share is still sqrt(n) error bars.
    """
    picture = np.asarray(picture, np.float64)
    varies = renders.variance > 0
    ratio = np.full(picture.shape, np.nan)
    np.divide((picture - renders.mean) ** 2, renders.variance, out=ratio, where=varies)
    variance = np.zeros(picture.shape)
    for rows, columns in _slices(picture.shape):
        if varies[rows, columns].any():
            factor = np.nanmedian(ratio[rows, columns]) / student_median_sq(renders.seeds - 1) - 1
            variance[rows, columns] = max(factor, renders.seeds) * renders.variance[rows, columns]
    half = np.array_equal(picture, picture.astype(np.float16).astype(np.float64))
    return Estimate(picture, variance, renders.seeds, HALF_ROUNDING if half else 0.0)


def student_median_sq(freedom):
    """The median of the square of Student's t: Cornish and Fisher's first term, to 4 % for any freedom."""
    return (0.67449 * (1 + 0.36374 / (freedom - 0.28))) ** 2


def judge(first, second, limit=Z_LIMIT, block=BLOCK):
    """`first`, `second`: Estimates of the same size.

    The variance of a block's mean is that of its pixels, which are independent. Blocks where few pixels vary
    have few degrees of freedom [Welch-Satterthwaite].
    """
    found = scores(first, second, block)
    mean, z, noisy = found.scale, found.z, found.noise > 0
    worst = np.unravel_index(np.argmax(z), z.shape)
    # Blocks that are all but black tell no factor.
    relative = np.sqrt(found.variance) / np.maximum(np.abs(found.second), 1e-3 * mean)
    return Verdict(
        float(z.max()),
        float(100 * np.abs(found.first - found.second).max() / mean),
        (int(worst[1]), int(worst[0]), int(worst[2])),
        float(np.sqrt((z[noisy] ** 2).mean())) if noisy.any() else 0.0,
        float(100 * (limit + POWER) * np.median(relative[noisy] if noisy.any() else relative)),
        limit,
    )


class Scores(NamedTuple):
    """Blocks of two pictures, arrays [rows x columns x channels]."""

    first: np.ndarray  # means of the pixels
    second: np.ndarray
    z: np.ndarray  # of their difference, in standard errors of the normal distribution; never negative
    variance: np.ndarray  # of the difference
    noise: np.ndarray  # the part of it that comes from the seeds
    freedom: np.ndarray  # degrees of freedom of the variance
    pixels: np.ndarray  # that count
    scale: float  # mean of the second picture

    def z_at_factor(self, factor):
        """z after the second picture has been multiplied."""
        t = np.abs(self.first - factor * self.second) / np.sqrt(self.variance)
        return normal_score(t, self.freedom)


def scores(first, second, block=BLOCK, mask=None):
    """`mask` [height x width]: the pixels that count; a block without any has z = 0."""
    weight = np.ones(first.mean.shape) if mask is None else np.repeat(mask[..., None], first.mean.shape[2], 2)
    pixels = _blocks(weight, block)
    count = np.maximum(pixels, 1)
    scale = np.abs(second.mean).mean() or 1.0
    means = [_blocks(side.mean * weight, block) / count for side in (first, second)]
    noise, squares = sum(np.array(_variance(side, weight, count, block)) for side in (first, second))
    stored = _blocks(second.rounding * np.abs(second.mean) * weight, block) / count
    variance = noise + (ROUNDING * scale) ** 2 + stored**2
    freedom = variance**2 / np.maximum(squares, 1e-9 * variance**2)
    z = normal_score(np.abs(means[0] - means[1]) / np.sqrt(variance), freedom)
    return Scores(*means, z, variance, noise, freedom, pixels, scale)


def judge_renders(first, second):
    """`first`, `second`: [seeds x height x width x channels]."""
    return judge(estimate(first), estimate(second))


def _variance(side, weight, count, block):
    """Variance of the means of blocks of `count` pixels, and the denominator of its degrees of freedom."""
    squares = side.variance**2 / (side.seeds - 1)
    return _blocks(side.variance * weight, block) / count**2, _blocks(squares * weight, block) / count**4


def normal_score(t, freedom):
    """The normal deviate of the same tail as Student's `t`, to two digits or better [Wallace 1959]."""
    return np.sqrt(freedom * np.log1p(t**2 / freedom)) * (8 * freedom + 1) / (8 * freedom + 3)


def _blocks(values, block):
    """Sums of [height x width x channels] over blocks; the last of a row or column is what is left."""
    rows, columns = (np.arange(0, size, block) for size in values.shape[:2])
    return np.add.reduceat(np.add.reduceat(values.astype(np.float64), rows, axis=0), columns, axis=1)


def _slices(shape):
    height, width = shape[:2]
    for y in range(0, height, BLOCK):
        for x in range(0, width, BLOCK):
            yield slice(y, y + BLOCK), slice(x, x + BLOCK)
