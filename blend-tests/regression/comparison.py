"""One picture beside its reference: color and alpha, by blocks and as a whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from support.judge import BLOCK, POWER, WHOLE, Estimate, Verdict, judge, z_limit

_CHANNELS = {"color": slice(0, 3), "alpha": slice(3, 4)}


class Comparison(NamedTuple):
    z: float  # largest of all comparisons, in standard errors
    limit: float  # that it may not exceed
    percent: float  # largest difference of two blocks, of the reference's mean color
    what: str  # "color" or "alpha": where z is largest
    block: tuple[int, int]  # column and row of the worst block, from the bottom left
    sees: float  # factor of exposure, in per cent, that is refused in 99 of 100 cases

    @property
    def agrees(self) -> bool:
        return self.z <= self.limit


def compare(ours: Estimate, reference: Estimate, pictures: int) -> Comparison:
    """`pictures`: of the run, which share one chance of a false alarm."""
    limit = z_limit(pictures * _comparisons(reference.mean.shape))
    found = {}
    for what, channels in _CHANNELS.items():
        if channels.start >= reference.mean.shape[2]:
            continue
        sides = ours.channels(channels), reference.channels(channels)
        found[what] = [judge(*sides, limit, block) for block in (BLOCK, WHOLE)]
    what = max(found, key=lambda kind: _largest(found[kind]))
    blocks, _ = found[what]
    return Comparison(
        _largest(found[what]),
        limit,
        found["color"][0].percent,
        what,
        blocks.block[:2],
        smallest_factor(ours, reference, limit),
    )


def smallest_factor(ours: Estimate, reference: Estimate, limit: float) -> float:
    """In per cent: what all colors must be off by to be refused, by the picture as a whole."""
    sides = [side.channels(_CHANNELS["color"]) for side in (ours, reference)]
    count = sides[0].mean[..., 0].size
    variance = sum(side.variance.sum(axis=(0, 1)) for side in sides) / count**2
    mean = np.abs(sides[1].mean).mean(axis=(0, 1))
    relative = np.sqrt(variance) / np.maximum(mean, 1e-30) + sides[1].rounding
    return float(100 * (limit + POWER) * relative.min())


def _largest(verdicts: list[Verdict]) -> float:
    return max(verdict.z for verdict in verdicts)


def _comparisons(shape: tuple[int, ...]) -> int:
    height, width, channels = shape
    return (-(-height // BLOCK) * -(-width // BLOCK) + 1) * channels
