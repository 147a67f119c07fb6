"""Size, memory and time of a tile's silhouette (VOTF); the time is extrapolated from small ones."""

from __future__ import annotations

import math
from typing import NamedTuple

from .capture_size import duration
from .sizes import data_size

_LEAST_TEXELS = 4
# Limits of the library, which refuses more (native/src/votf/eval/occlusion_volume.h).
_MOST_SIDE, _MOST_DEPTH, _MOST_POINTS = 4096, 1024, 1 << 28
_OF_A_POINT, _OF_A_LINE = 21, 96  # bytes: vectors and distances; crossings of a vertical line
# The time for distances grows with a power of the points, which probes measure; it is clamped to this range.
_LEAST_POWER, _MOST_POWER = 1.0, 1.6
_USUAL_POWER = 1.3  # used if the probes are too short to measure it
_SHORT = 0.02  # seconds


class Probe(NamedTuple):
    """A small VOTF that is computed to extrapolate from."""

    texels: int
    is_whole: bool  # also finds the plane of a BTF's texels, but skips the quality check

    def options(self) -> dict:
        """Options of votf_job()."""
        return {"texels": self.texels, **({"check_views": 0} if self.is_whole else {"reference_height": 0.0})}


def probes(texels: int) -> tuple[Probe, Probe, Probe]:
    """The probes that outline_text() needs. Finding the plane takes equally long for any number of texels."""
    few, many = (max(texels // part, _LEAST_TEXELS) for part in (4, 2))
    return Probe(_LEAST_TEXELS, True), Probe(few, False), Probe(many, False)


class Made(NamedTuple):
    """Results of a probe."""

    points: tuple[int, int, int]
    heights: tuple[float, float]  # lowest and highest point of the grid, in tile widths
    seconds: float  # without the quality check
    whole: float  # seconds with the quality check and the preparation
    wrong: float | None  # share of wrong rays

    @classmethod
    def of(cls, report: dict, whole: float) -> Made:
        points, heights = (tuple(report[name]) for name in ("points", "heights"))
        return cls(points, heights, report["seconds"], whole, report["wrong"])


def grid(texels: int, made: Made) -> tuple[int, int, int]:
    """Grid points of a VOTF with this many texels, from another one of the tile; within one along y and z."""
    thickness = made.heights[1] - made.heights[0] - 2 / made.points[0]
    rows = max(round(texels * made.points[1] / made.points[0]), 1)
    return texels, rows, math.ceil(thickness * texels - 1e-3) + 3


def is_too_large(points: tuple[int, int, int]) -> bool:
    """Whether the library would refuse this grid."""
    x, y, z = points
    return max(x, y) > _MOST_SIDE or z > _MOST_DEPTH or x * y * z > _MOST_POINTS


def outline_memory(points: tuple[int, int, int]) -> int:
    """Memory in bytes, in addition to the scene."""
    x, y, z = points
    return x * y * (z * _OF_A_POINT + _OF_A_LINE)


def outline_seconds(texels: int, made: tuple[Made, Made, Made]) -> float:
    """Estimated seconds of a VOTF, from its probes().

    The preparation takes the same time for all. The time for distances grows with a power of the points that
    the other two probes measure; it exceeds one if the points outgrow the processor's caches. The time of the
    quality check grows with the number of texels.
    """
    first, few, many = made
    begins = max(first.whole - first.seconds, 0.0)  # preparation of the tile for rays
    looks = max(many.whole - many.seconds - begins, 0.0) * (texels / many.points[0]) ** 2
    ratio = math.prod(grid(texels, many)) / math.prod(many.points)
    return first.whole + many.seconds * ratio ** _power(few, many) + looks


def _power(few: Made, many: Made) -> float:
    points = math.prod(many.points) / math.prod(few.points)
    if points <= 1 or min(few.seconds, many.seconds) < _SHORT:
        return _USUAL_POWER
    power = math.log(many.seconds / few.seconds) / math.log(points)
    return min(max(power, _LEAST_POWER), _MOST_POWER)


def outline_text(texels: int, made: tuple[Made, Made, Made]) -> str:
    """Text for the artist beforehand."""
    points = grid(texels, made[-1])
    size = " x ".join(map(str, points))
    if is_too_large(points):
        return f"A silhouette of {size} points is too large; lower Texels"
    time = f"About {duration(outline_seconds(texels, made))}"
    time += ", plus a few seconds for the approximation in other engines"
    wrong = [f"{m.wrong:.2%} at {m.points[0]}" for m in made if m.wrong is not None]
    return (
        f"{time}; {data_size(math.prod(points))} in the model ({size} points);"
        f" {data_size(outline_memory(points))} of additional memory;"
        f" wrong rays at coarser resolutions: {', '.join(wrong)}"
    )
