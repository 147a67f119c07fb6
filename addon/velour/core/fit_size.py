"""What the fit of a BTF takes of memory, and how large its model is.

The sums are those of native/src/compress/fit_memory.cpp: of what is held at once, the largest.
"""

from __future__ import annotations

import os
from typing import NamedTuple

_FLOAT, _HALF, _DOUBLE = 4, 2, 8
_LIBRARIES = 8 << 20
_READING = 24  # bytes of a value of the view that is read, with its levels
_ORDER_PAIRS, _CANDIDATES, _POINTS, _LEAST_POINTS = 400, 2048, 64, 8  # of SRBFs' orders
_POINT_PAIRS = 900
_ARGUMENTS, _LOBE = 40, 40  # bytes
_MOST_COEFFICIENTS = 512
_DIRECTIONS = 64  # of tensors: views, lights that clusters are sought in
_FUNCTIONS, _LEAST_FUNCTIONS, _SLICES, _LEAST_SLICES, _POINT_FLOATS = 640, 40, 6144, 384, 16 << 20
_MOMENT_GROUPS, _JOINT_RANKS = 4, 640
_MOST_OF_VIEW, _MOST_OF_VIEWS, _MOST_COMPONENTS = 160, 16384, 512
_TENSORS = ("kcta", "cta", "tucker")


class Extent(NamedTuple):
    """Of a BTF that is to be fitted."""

    width: int  # texels
    height: int
    pairs: int
    lights: int
    hemispheres: int = 1  # pairs of them that the BTF has; 4: seen and lit from below as well
    sides: int = 1  # of those, that are fitted: dark ones and equal ones are not, which nobody knows before

    @classmethod
    def of(cls, info: dict) -> Extent:
        """`info`: what the library knows of a BTF."""
        below = all(theta > 90 for theta in info["largest_theta"].values())
        sides = 4 if below else 1
        return cls(*info["texels"], info["pairs"], info["lights"], sides, sides)

    @property
    def texels(self) -> int:
        return self.width * self.height

    @property
    def pyramid(self) -> int:
        """Texels of all levels."""
        width, height, total = self.width, self.height, self.texels
        while width > 1 or height > 1:
            width, height = max(width // 2, 1), max(height // 2, 1)
            total += width * height
        return total

    @property
    def raw_bytes(self) -> int:
        return self.pairs * self.texels * 3 * _HALF

    @property
    def views(self) -> int:
        return self.pairs // self.lights

    def reading(self) -> int:
        return self.texels * self.lights * 3 * _READING


def most_bytes(of: Extent, method: str, asked: int = 0) -> int:
    """Of all that is fitted; a file is packed, and smaller. `asked`: 0: as the fit has it."""
    if asked:
        return asked
    if method == "srbf":
        return max(of.raw_bytes // 400, of.sides * _srbf_bytes(of.pyramid, 16, 16))
    if method in _TENSORS:
        return max(of.raw_bytes // 400, of.sides * (of.pyramid * 16 + 20000))
    return max(of.raw_bytes // 200, 8 * _component(of, method))


def fit_memory(of: Extent, method: str, asked: int = 0, searched: bool = False, threads: int = 0) -> int:
    """Bytes beside the program and the BTF's own. `searched`: by a largest error and no size."""
    return _held(of, method, asked, searched, threads or os.cpu_count() or 1, least=False)


def least_memory(of: Extent, method: str, asked: int = 0, searched: bool = False, threads: int = 0) -> int:
    """The least limit (`memory` of a fit) that it can be kept to."""
    return _held(of, method, asked, searched, threads or os.cpu_count() or 1, least=True)


def _held(of, method, asked, searched, threads, least):
    if method == "srbf":
        return _of_srbf(of, asked, searched, threads, _LEAST_POINTS if least else _POINTS)
    if method in _TENSORS:
        return _of_tensors(of, *((_LEAST_FUNCTIONS, _LEAST_SLICES) if least else (_FUNCTIONS, _SLICES)))
    components = 1 if searched and least else _components(of, method, asked, searched)
    return _of_components(of, components, method == "svd-view", threads)


def _srbf_bytes(texels, coefficients, lobes):
    return texels * (coefficients + _HALF) + lobes * _LOBE + coefficients * (2 + 2 * _FLOAT)


def _of_srbf(of, asked, searched, threads, search_points):
    within = most_bytes(of, "srbf", asked) // (_srbf_bytes(of.pyramid, 1, 0) - _srbf_bytes(of.pyramid, 0, 0))
    most = min(2 * max(within, 1), _MOST_COEFFICIENTS) if not searched or asked else _MOST_COEFFICIENTS
    points = min(max(of.texels // 4, 24), 400)
    pairs = min(_POINT_PAIRS, of.pairs // of.hemispheres)
    held = _LIBRARIES + of.sides * points * pairs * 2 * (_ARGUMENTS + 3 * _FLOAT)
    of_point = min(pairs, _ORDER_PAIRS) * _FLOAT * (_CANDIDATES + 4 * most) + 6 * _CANDIDATES * _FLOAT
    refinement = points * pairs * 2 * 9 * _FLOAT
    refinement += threads * pairs * most * 4 * _FLOAT + points * most * 9 * _FLOAT
    texels = (of.pyramid + 10 * of.texels) * most * _FLOAT + of.texels * 128
    parts = (of.reading() + texels, refinement, _judging(of, most, threads), search_points * of_point)
    return held + max(parts)


def _judging(of, coefficients, threads):
    images = threads * of.texels * 3 * (_HALF + 2 * _FLOAT)
    return 3 * of.pyramid * coefficients * _FLOAT + images


def _of_tensors(of, functions, slices):
    """Slices that clusters are sought in; or texels and functions refitted, by the products of all views."""
    entries = min(of.views, _DIRECTIONS) * min(of.lights, _DIRECTIONS) * 3
    points = _POINT_FLOATS * slices // _SLICES
    sliced = min(slices, of.texels) * entries * _FLOAT
    clustering = max(4 * sliced, sliced + of.reading() + 2 * points * _FLOAT)
    shown = of.views * of.pyramid * (2 * _FLOAT + 4) + 3 * of.texels * of.lights * _FLOAT
    moments = of.views * (functions + 3 * of.lights) * functions * _FLOAT
    texels = (3 * of.pyramid + 2 * of.texels) * functions * _FLOAT
    systems = 2 * _MOMENT_GROUPS * _JOINT_RANKS**2 * _DOUBLE
    refit = (2 * of.pyramid + of.texels) * functions * _FLOAT + systems
    return _LIBRARIES + max(clustering, of.reading() + moments + shown + max(texels, refit))


def _component(of, method):
    """Bytes of one."""
    return _HALF * ((of.lights if method == "svd-view" else of.pairs) + of.pyramid)


def _components(of, method, asked, searched):
    limit = _MOST_OF_VIEWS if method == "svd-view" else _MOST_COMPONENTS
    if searched and not asked:
        return limit
    return min(max(most_bytes(of, method, asked) // _component(of, method), 1), limit)


def _of_components(of, components, by_view, threads):
    held = _LIBRARIES + of.reading() + _judging(of, components, threads)
    if by_view:
        columns = min(of.lights, _MOST_OF_VIEW // 3)
        functions = 3 * of.pairs * columns * _FLOAT + 5 * of.lights**2 * _DOUBLE
        return held + functions + components * (2 * of.lights + 2 * of.pyramid) * _FLOAT
    columns = components + 8
    sketches = 3 * columns * (2 * of.texels + of.pairs) * _FLOAT
    turning = columns * max(4 * of.texels * _FLOAT, 3 * of.pairs * _DOUBLE)
    projecting = components * (2 * of.pairs + 2 * of.pyramid) * _FLOAT
    return held + sketches + max(turning, projecting)
