"""How an approximation's Mapping node places its image, in the steps that other programs know."""

import math
from typing import NamedTuple


class Step(NamedTuple):
    """Scaled, then turned counter-clockwise, then moved."""

    scale: tuple
    degrees: float
    translation: tuple


def chain(mapping):
    """One step where one can say it; two where tiles are turned and not as wide as high.

    The Mapping node is of the type Texture: moved back, turned back, and divided by its scale.
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
