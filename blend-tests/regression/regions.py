"""Parts of a picture and its reference, by object and by material, compared at stated levels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from support.judge import BLOCK, WHOLE, Estimate, Scores, scores, z_limit

from .passes import MIXED, NOTHING, Labels, Passes

LEVEL = 1e-3  # chance that a list of comparisons names anything that has not changed
EXPLAINED = 0.01  # chance that a common factor, or a change of one material only, is not taken for one
FEWEST = 8  # pixels of an object or a material that is judged


class Sides(NamedTuple):
    picture: tuple[Estimate, Estimate]  # colors; ours, the reference's
    ours: Passes
    known: Passes
    worst_only: bool = False  # of the names of a list

    def by_most(self) -> Sides:
        """What fills too few pixels alone gets those that it fills by half, which show others, too."""
        ours, known = (side.by_most(FEWEST) for side in (self.ours, self.known))
        return self._replace(ours=ours, known=known, worst_only=True)

    def stays(self, kind: str) -> np.ndarray:
        """[height x width] bool: pixels that show the same object or material in both."""
        labels = getattr(self.ours, kind), getattr(self.known, kind)
        numbers = np.array([MIXED, NOTHING, *(_number(labels[0], name) for name in labels[1].names)])
        return (numbers[labels[1].numbers + 1] == labels[0].numbers) & (labels[0].numbers != MIXED)


class Factor(NamedTuple):
    """Factor between two pictures: weighted least squares over blocks and channels, which share it."""

    value: float
    error: float
    explains: bool  # whether blocks agree with it, at the level EXPLAINED

    @classmethod
    def of(cls, found: list[Scores]) -> Factor:
        first, second, variance = (
            np.concatenate([getattr(each, name)[each.pixels > 0] for each in found])
            for name in ("first", "second", "variance")
        )
        weight = (second**2 / variance).sum()
        if weight == 0:
            return cls(1.0, np.inf, False)
        value = (first * second / variance).sum() / weight
        z = max(each.z_at_factor(value).max() for each in found)
        # The channels of a render share its light, and so most of their errors.
        return cls(float(value), float(np.sqrt(3 / weight)), bool(z <= z_limit(first.size, EXPLAINED)))

    @property
    def differs(self) -> bool:
        return abs(self.value - 1) > z_limit(1, LEVEL) * self.error

    def agrees(self, other: Factor) -> bool:
        """Whether both may be one factor: their difference is within the noise of independent renders.

        The limit is that of `differs`, so that equal factors are named as two in one of a thousand cases.
        """
        return abs(self.value - other.value) <= z_limit(1, LEVEL) * np.hypot(self.error, other.error)

    def __str__(self) -> str:
        return f"{self.value:.4f} +- {self.error:.4f}"


def changed(sides: Sides, kind: str, measured: str, usable: np.ndarray) -> list[str]:
    """Names of the objects or materials whose pass `measured` differs where both show them, worst first."""
    first, second, tested = getattr(sides.ours, measured), getattr(sides.known, measured), {}
    labels = getattr(sides.known, kind)
    for name in labels.names:
        mask = usable & labels.where(name)
        if np.count_nonzero(mask) >= FEWEST:
            tested[name] = both((first, second), mask)
    count = sum(each.z.size for pair in tested.values() for each in pair)
    z = {name: largest(pair) for name, pair in tested.items()}
    names = sorted((name for name in z if z[name] > z_limit(count, LEVEL)), key=lambda name: -z[name])
    return names[:1] if sides.worst_only else names


def regions(sides: Sides) -> dict[str, np.ndarray]:
    """Pixels by material; "": the background."""
    labels, stays = sides.known.materials, sides.stays("materials")
    found = {name: stays & labels.where(name) for name in labels.names}
    found[""] = stays & (labels.numbers == NOTHING)
    return {name: mask for name, mask in found.items() if np.count_nonzero(mask) >= FEWEST}


def both(pair: tuple[Estimate, Estimate], mask: np.ndarray) -> tuple[Scores, Scores]:
    """By blocks, and all pixels of the mask together."""
    window = _blocks_around(mask)
    cut = [side._replace(mean=side.mean[window], variance=side.variance[window]) for side in pair]
    return scores(*cut, BLOCK, mask[window]), scores(*cut, WHOLE, mask[window])


def _blocks_around(mask: np.ndarray) -> tuple[slice, slice]:
    """The blocks that hold a mask, which is not empty."""
    found = []
    for axis in (1, 0):
        places = np.flatnonzero(mask.any(axis=axis))
        found.append(slice(places[0] // BLOCK * BLOCK, (places[-1] // BLOCK + 1) * BLOCK))
    return tuple(found)


def largest(pair: tuple[Scores, Scores]) -> float:
    return max(float(each.z.max()) for each in pair)


def covered(sides: Sides, kind: str, names: list[str]) -> np.ndarray:
    """Pixels that show one of `names` in either."""
    labels = getattr(sides.ours, kind), getattr(sides.known, kind)
    covered = np.zeros(labels[1].numbers.shape, bool)
    for name in names:
        covered |= labels[0].where(name) | labels[1].where(name)
    return covered


def _number(labels: Labels, name: str) -> int:
    return 1 + labels.names.index(name) if name in labels.names else -2
