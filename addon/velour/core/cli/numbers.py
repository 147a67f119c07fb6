"""Argument types: each parses text into a value or says what is wrong with it (wrong usage, status 2)."""

from __future__ import annotations

import argparse
import math
from typing import NamedTuple


def whole(low: int, high: int = 2**32 - 1):
    """Parser of an integer in [low, high]."""

    def parse(text: str) -> int:
        try:
            value = int(text)
        except ValueError:
            raise argparse.ArgumentTypeError(f"{text!r} is not an integer") from None
        if not low <= value <= high:
            raise argparse.ArgumentTypeError(f"{value} is not between {low} and {high}")
        return value

    return parse


seed = whole(0, 2**64 - 1)


def real(low: float = -math.inf, high: float = math.inf):
    """Parser of a finite number in [low, high]."""

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
    """Parser of `count` numbers separated by commas."""

    def parse(text: str) -> tuple[float, ...]:
        parts = text.split(",")
        if len(parts) != count:
            raise argparse.ArgumentTypeError(f"{text!r} is not {count} comma-separated numbers")
        return tuple(map(real(low, high), parts))

    return parse


def span(text: str) -> tuple[int, int]:
    """BEGIN:END, two integers in ascending order."""
    ends = text.split(":")
    if len(ends) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} is not BEGIN:END")
    begin, end = map(whole(0, 2**30), ends)
    if begin >= end:
        raise argparse.ArgumentTypeError(f"{text!r} is empty: the end must be greater than the begin")
    return begin, end


def pixels(text: str) -> tuple[int, int, int, int]:
    """X0:X1,Y0:Y1 as x0, y0, x1, y1."""
    spans = text.split(",")
    if len(spans) != 2:
        raise argparse.ArgumentTypeError(f"{text!r} is not X0:X1,Y0:Y1")
    (x0, x1), (y0, y1) = map(span, spans)
    return x0, y0, x1, y1


def size_in_bytes(text: str) -> int:
    """Bytes, or K, M, G, T (powers of 1024); 2^63 at most."""
    number, unit = (text[:-1], text[-1]) if text[-1:].upper() in ("K", "M", "G", "T") else (text, "")
    if not number.isdecimal():
        raise argparse.ArgumentTypeError(f"{text!r} is not a number of bytes, such as 8G")
    doublings = 10 * " KMGT".index(unit.upper() or " ")
    return whole(1, 2**63 >> doublings)(number) << doublings


class Camera(NamedTuple):
    eye: tuple[float, ...]
    target: tuple[float, ...]
    fov: float  # vertical, radians


def camera(text: str) -> Camera:
    """EX,EY,EZ,TX,TY,TZ,FOV: meters, and the vertical field of view in degrees."""
    values = reals(7)(text)
    if not 0 < values[6] < 180:
        raise argparse.ArgumentTypeError(
            f"the field of view is {values[6]:g} degrees; it must be between 0 and 180"
        )
    if values[:3] == values[3:6]:
        raise argparse.ArgumentTypeError("the camera is at its target; move one of them")
    return Camera(values[:3], values[3:6], math.radians(values[6]))


def add_job_arguments(parser: argparse.ArgumentParser) -> None:
    """Adds the options of every command that computes."""
    parser.add_argument("--seed", type=seed, metavar="K", help="random seed")
    parser.add_argument("--threads", type=whole(0, 1024), metavar="T", help="number of threads (0: all)")
