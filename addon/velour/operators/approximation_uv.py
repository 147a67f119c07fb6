"""Placement by an approximation's Mapping node as transforms that other programs support."""

import math
from typing import NamedTuple


class Step(NamedTuple):
    """Scaling, then counterclockwise rotation, then translation."""

    scale: tuple
    degrees: float
    translation: tuple


def chain(mapping):
    """One Step if possible; two if tiles are rotated and not square.

    The Mapping node has type Texture: inverse translation, inverse rotation, division by its scale.
    """
    x, y, _ = mapping.inputs["Location"].default_value
    angle = 0.0 - mapping.inputs["Rotation"].default_value[2]
    repeats = tuple(1.0 / side for side in mapping.inputs["Scale"].default_value[:2])
    moved = _turned((0.0 - x, 0.0 - y), angle)
    if angle == 0 or math.isclose(*repeats, rel_tol=1e-6):
        return (Step(repeats, math.degrees(angle), _scaled(moved, repeats)),)
    return Step((1.0, 1.0), math.degrees(angle), moved), Step(repeats, 0.0, (0.0, 0.0))


def _turned(vector, angle):
    x, y = vector
    return math.cos(angle) * x - math.sin(angle) * y, math.sin(angle) * x + math.cos(angle) * y


def _scaled(vector, factors):
    return tuple(v * factor for v, factor in zip(vector, factors, strict=True))
