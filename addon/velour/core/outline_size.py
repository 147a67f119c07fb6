"""What an outline (VOTF) of a tile takes: in the model, in memory, and of time by small ones of it."""

from __future__ import annotations

import math
from typing import NamedTuple

from .capture_size import duration
from .sizes import data_size

_LEAST_TEXELS = 4
# The library's: more is refused (native/src/votf/occlusion_volume.h).
_MOST_SIDE, _MOST_DEPTH, _MOST_POINTS = 4096, 1024, 1 << 28
_OF_A_POINT, _OF_A_LINE = 21, 96  # bytes of memory: vectors and distances; crossings of a vertical line
# Powers of the points that the seconds of their distances grow with: what probes say is held within.
_LEAST_POWER, _MOST_POWER = 1.0, 1.6
_USUAL_POWER = 1.3  # where probes are too short to say
_SHORT = 0.02  # seconds


class Probe(NamedTuple):
    """A small outline."""

    texels: int
    is_whole: bool  # it looks for the plane of a BTF's texels, too, but not at how good it is

    def options(self) -> dict:
        """Of votf_job()."""
        return {"texels": self.texels, **({"check_views": 0} if self.is_whole else {"reference_height": 0.0})}


def probes(texels: int) -> tuple[Probe, Probe, Probe]:
    """Those that outline_text() asks for. The plane costs the same whatever the texels."""
    few, many = (max(texels // part, _LEAST_TEXELS) for part in (4, 2))
    return Probe(_LEAST_TEXELS, True), Probe(few, False), Probe(many, False)


class Made(NamedTuple):
    """What a probe was."""

    points: tuple[int, int, int]
    heights: tuple[float, float]  # of the grid, widths of the tile
    seconds: float  # without looks at how good it is
    whole: float  # with those and what comes before
    wrong: float | None  # share of rays

    @classmethod
    def of(cls, report: dict, whole: float) -> Made:
        points, heights = (tuple(report[name]) for name in ("points", "heights"))
        return cls(points, heights, report["seconds"], whole, report["wrong"])


def grid(texels: int, made: Made) -> tuple[int, int, int]:
    """Points of an outline so fine, by another one of the tile; within one along y and z."""
    thickness = made.heights[1] - made.heights[0] - 2 / made.points[0]
    rows = max(round(texels * made.points[1] / made.points[0]), 1)
    return texels, rows, math.ceil(thickness * texels - 1e-3) + 3


def is_too_large(points: tuple[int, int, int]) -> bool:
    """Whether the library would refuse it."""
    x, y, z = points
    return max(x, y) > _MOST_SIDE or z > _MOST_DEPTH or x * y * z > _MOST_POINTS


def outline_memory(points: tuple[int, int, int]) -> int:
    """Bytes beside the scene."""
    x, y, z = points
    return x * y * (z * _OF_A_POINT + _OF_A_LINE)


def outline_seconds(texels: int, made: tuple[Made, Made, Made]) -> float:
    """Of an outline, by what its probes() took.

    What comes before is the same for all. Distances grow with a power of the points that the two others tell,
    which is above one where they outgrow the processor's caches; looks at how good it is with the texels.
    """
    first, few, many = made
    begins = max(first.whole - first.seconds, 0.0)  # the tile is made ready for rays
    looks = max(many.whole - many.seconds - begins, 0.0) * (texels / many.points[0]) ** 2
    ratio = math.prod(grid(texels, many)) / math.prod(many.points)
    return first.whole + many.seconds * ratio ** _power(few, many) + looks


def _power(few: Made, many: Made) -> float:
    points = math.prod(many.points) / math.prod(few.points)
    if points <= 1 or min(few.seconds, many.seconds) < _SHORT:
        return _USUAL_POWER
    power = math.log(many.seconds / few.seconds) / math.log(points)
    return min(max(power, _LEAST_POWER), _MOST_POWER)


def outline_text(texels: int, made: tuple[Made, Made, Made], approximated: bool) -> str:
    """What artists are told before they begin. `approximated`: other engines' look of it is made as well."""
    points = grid(texels, made[-1])
    size = " x ".join(map(str, points))
    if is_too_large(points):
        return f"An outline of {size} points is too large; give fewer texels"
    time = f"About {duration(outline_seconds(texels, made))}"
    if approximated:
        time += ", and a few seconds for the look in other engines"
    wrong = [f"{m.wrong:.2%} at {m.points[0]}" for m in made if m.wrong is not None]
    return (
        f"{time}; {data_size(math.prod(points))} in the model ({size} points);"
        f" {data_size(outline_memory(points))} of memory beside the scene;"
        f" rays wrong with fewer texels: {', '.join(wrong)}"
    )
