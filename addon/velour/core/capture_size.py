"""Disk space, memory and time of a capture of a tile; the time is extrapolated from two small captures."""

from __future__ import annotations

from typing import NamedTuple

from .sizes import data_size

_MOST_MEMORY = 1 << 30  # bytes for a view's images; larger ones lie in a file in the folder
_PROBE_TEXELS = 64
_PROBE_VIEWS = 4
_PROBE_LIGHTS = (4, 16)


def capture_bytes(settings) -> int:
    """Disk space of a one-sided capture in bytes, within a few per cent; two sides take four times that."""
    return settings.views * _view_bytes(settings, settings.lights)


def pairs_bytes(settings) -> int:
    """Disk space of the held-out pairs in bytes; their number does not depend on the sides."""
    return settings.held_out * _view_bytes(settings, lights=1)


def _view_bytes(settings, lights: int) -> int:
    row = 6 * settings.texels + 16  # colors as half floats, and the file's overhead per row
    if settings.samples > 1:
        row += 2 * settings.texels + 16  # errors
    maps = 12 * settings.texels**2  # coverage and heights
    return lights * settings.texels * row + maps


def capture_memory(settings, sides: int) -> int:
    """Bytes of a view's images as half floats: colors and, with more than one sample, errors."""
    channels = 4 if settings.samples > 1 else 3
    return min(2 * channels * sides * settings.lights * settings.texels**2, _MOST_MEMORY)


class Probe(NamedTuple):
    """A small capture with the same samples and bounces."""

    texels: int
    views: int
    lights: int


def probes(settings) -> tuple[Probe, Probe]:
    """The two probes that capture_seconds() needs."""
    texels, views = min(settings.texels, _PROBE_TEXELS), min(settings.views, _PROBE_VIEWS)
    return tuple(Probe(texels, views, min(settings.lights, lights)) for lights in _PROBE_LIGHTS)


class Timed(NamedTuple):
    """Times of a probe, in seconds."""

    traced: float  # tracing rays
    whole: float  # preparation, tracing rays and writing


def capture_seconds(settings, took: tuple[Timed, Timed], sides: int = 1) -> float:
    """Estimated seconds of the whole capture with its held-out pairs, from the times of its probes.

    A texel of a view has a fixed cost for its own rays, and a cost for each light, to trace and to write. The
    preparation is done once per capture and takes the same time for all.
    """
    few, many = probes(settings)
    own, light = _costs(few, many, took)
    views = settings.views * (own + settings.lights * light)
    # With two sides, the probes' views and lights are mirrored below; the pairs are not.
    pairs = settings.held_out * (own / sides + light / sides**2)
    before = max(took[0].whole - took[0].traced, 0.0) * (2 if settings.held_out else 1)
    return before + (views + pairs) * settings.texels**2 / (few.views * few.texels**2)


def _costs(few: Probe, many: Probe, took: tuple[Timed, Timed]) -> tuple[float, float]:
    """Seconds for a probe's views and texels: fixed, and per light."""
    if many.lights == few.lights:
        return took[0].traced, 0.0
    more = many.lights - few.lights
    traced = max(took[1].traced - took[0].traced, 0.0) / more
    whole = max(took[1].whole - took[0].whole, traced * more) / more
    return max(took[0].traced - few.lights * traced, 0.0), whole


def spread(directions, count: int):
    """`count` of an array of directions, evenly spaced by index: sets go ring by ring from the pole."""
    return directions[[(2 * i + 1) * len(directions) // (2 * count) for i in range(count)]]


def capture_text(settings, took: tuple[Timed, Timed], sides: int) -> str:
    """Text for the artist before the capture."""
    disk = capture_bytes(settings) * sides**2 + pairs_bytes(settings)
    memory = capture_memory(settings, sides)
    return (
        f"About {duration(capture_seconds(settings, took, sides))}, {data_size(disk)} on disk,"
        f" {data_size(memory)} of additional memory"
    )


def duration(seconds: float) -> str:
    """Text in the largest unit of which there are at least two."""
    for unit, length in (("hours", 3600), ("minutes", 60)):
        if seconds >= 2 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{max(seconds, 2):.0f} seconds"
