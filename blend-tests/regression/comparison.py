"""One picture beside its reference: color, alpha and passes, by blocks and as a whole."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from support.judge import BLOCK, POWER, WHOLE, Estimate, Verdict, judge, z_limit

from .passes import MEASURED, Passes

COLOR, ALPHA = slice(0, 3), slice(3, 4)
_WORDS = {"shape": "normals and distances", "coordinates": "texture coordinates"}
WORLD = "the world"
Sides = tuple[Estimate, Estimate]  # ours, the reference's


class Comparison(NamedTuple):
    z: float  # largest of all comparisons, in standard errors
    limit: float  # that it may not exceed
    percent: float  # largest difference of two blocks, of the reference's mean color
    what: str  # "color", "alpha", a pass or WORLD: the first that differs, or where z is largest
    block: tuple[int, int] | None  # column and row of its worst block, from the bottom left; None: of WORLD
    sees: float  # factor of exposure, in per cent, that is refused in 99 of 100 cases
    passes: tuple[str, ...] = ()  # names of the passes that differ

    @property
    def agrees(self) -> bool:
        return self.z <= self.limit

    @property
    def picture_agrees(self) -> bool:
        return self.agrees or self.what not in ("color", "alpha")


def compare(
    ours: Estimate,
    reference: Estimate,
    pictures: int,
    passes: tuple[Passes, Passes] | None = None,
) -> Comparison:
    """`pictures`: of the run, which share one chance of a false alarm. `passes`: ours, the reference's."""
    sides = {"color": (ours.channels(COLOR), reference.channels(COLOR))}
    if reference.mean.shape[2] > ALPHA.start:
        sides["alpha"] = ours.channels(ALPHA), reference.channels(ALPHA)
    sides |= _pass_sides(passes) if passes else {}
    limit = z_limit(pictures * sum(comparisons(known.mean.shape) for _, known in sides.values()))
    found = {what: [judge(*each, limit, block) for block in (BLOCK, WHOLE)] for what, each in sides.items()}
    differ = [what for what in found if _largest(found[what]) > limit]
    # What the picture shows comes first, so that the page looks at it.
    what = next(iter(differ), max(found, key=lambda kind: _largest(found[kind])))
    blocks, _ = found[what]
    return Comparison(
        _largest(found[what]),
        limit,
        found["color"][0].percent,
        what,
        blocks.block[:2] if what != WORLD else None,
        smallest_factor(ours, reference, limit),
        tuple(kind for kind in differ if kind not in ("color", "alpha")),
    )


def _pass_sides(passes: tuple[Passes, Passes]) -> dict[str, Sides]:
    ours, known = passes
    found = {_WORDS.get(name, name): (getattr(ours, name), getattr(known, name)) for name in MEASURED}
    if has_worlds(passes):
        found[WORLD] = ours.world, known.world
    return found


def has_worlds(passes: tuple[Passes, Passes]) -> bool:
    ours, known = (side.world for side in passes)
    return ours is not None and known is not None and ours.mean.shape == known.mean.shape


def smallest_factor(ours: Estimate, reference: Estimate, limit: float) -> float:
    """In per cent: what all colors must be off by to be refused, by the picture as a whole. Infinite for a
    black one."""
    sides = [side.channels(COLOR) for side in (ours, reference)]
    count = sides[0].mean[..., 0].size
    variance = sum(side.variance.sum(axis=(0, 1)) for side in sides) / count**2
    mean = np.abs(sides[1].mean).mean(axis=(0, 1))
    lit = mean > 0
    relative = np.sqrt(variance[lit]) / mean[lit] + sides[1].rounding
    return float(100 * (limit + POWER) * relative.min(initial=np.inf))


def comparisons(shape: tuple[int, ...]) -> int:
    """Number of comparisons of a picture [height x width x channels], by blocks and as a whole."""
    height, width, channels = shape
    return (-(-height // BLOCK) * -(-width // BLOCK) + 1) * channels


def _largest(verdicts: list[Verdict]) -> float:
    return max(verdict.z for verdict in verdicts)
