"""Types of arguments: each turns text into a value or says what is wrong with it (wrong usage, status 2)."""

from __future__ import annotations

import argparse
import math
from typing import NamedTuple


def whole(low: int, high: int = 2**32 - 1):
    """A whole number in [low, high]."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not a whole number") from None
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{value} is not between {low} and {high}")
        return value

    return parse


seed = whole(0, 2**64 - 1)


def real(low: float = -math.inf, high: float = math.inf):
    """A finite number in [low, high]."""

    def parse(text: str) -> float:
        try:
            value = float(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not a number") from None
        if not (math.isfinite(value) and low <= value <= high):
            raise argparse.ArgumentTypeError(f"{text} is not a finite number between {low:g} and {high:g}")
        return value

    return parse


def picture_size(text: str) -> tuple[int, int]:
    """WIDTHxHEIGHT in pixels."""
    parts = text.lower().split("x")
    if len(parts) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} is not WIDTHxHEIGHT")
    side = whole(1, 65536)
    return side(parts[0]), side(parts[1])


def reals(count: int, low: float = -math.inf, high: float = math.inf):
    """`count` numbers with commas between them."""

    def parse(text: str) -> tuple[float, ...]:
        parts = text.split(",")
        if len(parts) != count:
            raise argparse.ArgumentTypeError(f"{text!r} is not {count} numbers with commas between them")
        return tuple(map(real(low, high), parts))

    return parse


class Camera(NamedTuple):
    eye: tuple[float, ...]
    target: tuple[float, ...]
    fov: float  # vertical, radians


def camera(text: str) -> Camera:
    """EX,EY,EZ,TX,TY,TZ,FOV: metres, and the vertical angle of view in degrees."""
    values = reals(7)(text)
    if not 0 < values[6] < 180:
        raise argparse.ArgumentTypeError(
            f"the angle of view is {values[6]:g}; it lies between 0 and 180 degrees"
        )
    return Camera(values[:3], values[3:6], math.radians(values[6]))
