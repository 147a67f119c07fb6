"""Placement of an approximation's tiles as transforms that other programs support.

A Placed is that of operators/approximation_look.
"""

from __future__ import annotations

import math
from typing import NamedTuple

_NEGLIGIBLE = 1e-6


class Step(NamedTuple):
    """Scaling, then counterclockwise rotation, then translation."""

    scale: tuple
    degrees: float
    translation: tuple


def chain(placed):
    """One Step if possible; two if tiles are rotated and not square. `placed`: a Placed."""
    (x, y), repeats = placed.offset, placed.repeats
    angle = 0.0 - placed.rotation
    moved = _turned((0.0 - x, 0.0 - y), angle)
    if angle == 0 or math.isclose(*repeats, rel_tol=1e-6):
        return (Step(repeats, math.degrees(angle), _scaled(moved, repeats)),)
    return Step((1.0, 1.0), math.degrees(angle), moved), Step(repeats, 0.0, (0.0, 0.0))


def nearest_step(placed):
    """The Step of a Placed, and whether it is exact: rotated tiles that are not square would be sheared.

    Otherwise its matrix is the one with the smallest squared differences; the corner of a tile stays.
    """
    along_u, along_v = zip(*((u, v) for u, v, _start in affine(placed)), strict=True)
    squares, product = sum(r * r for r in placed.repeats), 2 * placed.repeats[0] * placed.repeats[1]
    angle = 0.0 - placed.rotation
    turn = 0.5 * math.atan2(product * math.sin(2 * angle), squares * math.cos(2 * angle))
    turn += math.pi * round((angle - turn) / math.pi)  # the scale is then positive
    scale = _turned(along_u, -turn)[0], _turned(along_v, -turn)[1]
    found = _turned((scale[0], 0.0), turn), _turned((0.0, scale[1]), turn)
    error = max(map(math.dist, (along_u, along_v), found))
    corner = _turned(_scaled(placed.offset, scale), turn)
    step = Step(scale, math.degrees(turn), tuple(0.0 - each for each in corner))
    return step, error <= _NEGLIGIBLE * max(placed.repeats)


def gltf_transform(step):
    """KHR_texture_transform of a Step; v is downward in glTF. Empty: none is needed."""
    angle, (x, y), (u, v) = math.radians(step.degrees), step.scale, step.translation
    offset = [u - y * math.sin(angle), 1 - v - y * math.cos(angle)]
    parts = ("offset", offset, [0, 0]), ("rotation", angle, 0), ("scale", [x, y], [1, 1])
    return {name: value for name, value, default in parts if not _is_near(value, default)}


def affine(placed):
    """The same as rows (a, b, c) of tile coordinates a u + b v + c."""
    start, along_u, along_v = (_moved(placed, point) for point in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    return tuple((u - c, v - c, c) for c, u, v in zip(start, along_u, along_v, strict=True))


def _is_near(value, default):
    if isinstance(value, list):
        return all(map(_is_near, value, default))
    return math.isclose(value, default, abs_tol=_NEGLIGIBLE)


def _moved(placed, point):
    for step in chain(placed):
        turned = _turned(_scaled(point, step.scale), math.radians(step.degrees))
        point = tuple(p + t for p, t in zip(turned, step.translation, strict=True))
    return point


def _turned(vector, angle):
    x, y = vector
    return math.cos(angle) * x - math.sin(angle) * y, math.sin(angle) * x + math.cos(angle) * y


def _scaled(vector, factors):
    return tuple(v * factor for v, factor in zip(vector, factors, strict=True))
