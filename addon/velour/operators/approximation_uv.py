"""Placement of an approximation's tiles as transforms that other programs support."""

import math
from typing import NamedTuple


class Step(NamedTuple):
    """Scaling, then counterclockwise rotation, then translation."""

    scale: tuple
    degrees: float
    translation: tuple


def chain(placed):
    """One Step if possible; two if tiles are rotated and not square. `placed`: approximation_look.Placed."""
    (x, y), repeats = placed.offset, placed.repeats
    angle = 0.0 - placed.rotation
    moved = _turned((0.0 - x, 0.0 - y), angle)
    if angle == 0 or math.isclose(*repeats, rel_tol=1e-6):
        return (Step(repeats, math.degrees(angle), _scaled(moved, repeats)),)
    return Step((1.0, 1.0), math.degrees(angle), moved), Step(repeats, 0.0, (0.0, 0.0))


def affine(placed):
    """The same as rows (a, b, c) of tile coordinates a u + b v + c."""
    start, along_u, along_v = (_moved(placed, point) for point in ((0.0, 0.0), (1.0, 0.0), (0.0, 1.0)))
    return tuple((u - c, v - c, c) for c, u, v in zip(start, along_u, along_v, strict=True))


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
