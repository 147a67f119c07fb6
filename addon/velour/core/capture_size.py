"""What a capture of a tile takes: on disk, in memory, and of time by two small ones."""

from __future__ import annotations

from typing import NamedTuple

_MOST_MEMORY = 1 << 30  # of a view's images; larger ones lie in a file in the folder
_PROBE_TEXELS = 64
_PROBE_VIEWS = 4
_PROBE_LIGHTS = (4, 16)


def capture_bytes(settings) -> int:
    """What a capture of one side takes on disk, within a few per cent; of two sides four times as much."""
    row = 6 * settings.texels + 16  # colours as half floats, and what the file says of the row
    if settings.samples > 1:
        row += 2 * settings.texels + 16  # errors
    maps = 12 * settings.texels**2  # coverage and heights
    return settings.views * (settings.lights * settings.texels * row + maps)


def capture_memory(settings, sides: int) -> int:
    """Bytes of a view's images: colours and, of more than one sample, errors, as half floats."""
    channels = 4 if settings.samples > 1 else 3
    return min(2 * channels * sides * settings.lights * settings.texels**2, _MOST_MEMORY)


class Probe(NamedTuple):
    """A small capture, of as many samples and bounces."""

    texels: int
    views: int
    lights: int


def probes(settings) -> tuple[Probe, Probe]:
    """The two that capture_seconds() asks for."""
    texels, views = min(settings.texels, _PROBE_TEXELS), min(settings.views, _PROBE_VIEWS)
    return tuple(Probe(texels, views, min(settings.lights, lights)) for lights in _PROBE_LIGHTS)


class Timed(NamedTuple):
    """What a probe took."""

    traced: float  # seconds of its rays
    whole: float  # the same, what comes before, and writing


def capture_seconds(settings, took: tuple[Timed, Timed]) -> float:
    """Of the whole capture, by what its probes took.

    A texel of a view costs what its own rays do, whatever the lights, and as much again for each light, to
    trace and to write. What comes before is done once, and is the same for all.
    """
    few, many = probes(settings)
    share = settings.views * settings.texels**2 / (few.views * few.texels**2)
    before = max(took[0].whole - took[0].traced, 0.0)
    if many.lights == few.lights:
        return before + share * took[0].traced
    more = many.lights - few.lights
    traced = max(took[1].traced - took[0].traced, 0.0) / more
    whole = max(took[1].whole - took[0].whole, traced * more) / more
    own = max(took[0].traced - few.lights * traced, 0.0)
    return before + share * (own + settings.lights * whole)


def spread(directions, count: int):
    """`count` of an array of directions, evenly by number: sets go ring by ring from the pole."""
    return directions[[(2 * i + 1) * len(directions) // (2 * count) for i in range(count)]]


def capture_text(settings, took: tuple[Timed, Timed], sides: int) -> str:
    """What artists are told before they begin."""
    disk = capture_bytes(settings) * sides**2
    memory = capture_memory(settings, sides)
    return (
        f"About {duration(capture_seconds(settings, took))}, {disk / 1e6:,.0f} MB on disk,"
        f" {memory / 1e6:,.0f} MB of memory beside the scene"
    )


def duration(seconds: float) -> str:
    """In the largest unit of which there are at least two."""
    for unit, length in (("hours", 3600), ("minutes", 60)):
        if seconds >= 2 * length:
            return f"{seconds / length:.0f} {unit}"
    return f"{max(seconds, 2):.0f} seconds"
