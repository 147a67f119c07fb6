"""Estimates the memory of a command-line render from its files, before they are read.

The factors come from measured peaks. They are conservative: memory that is freed before the next part is
allocated is counted as if it stayed.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

from ..native import library, structs
from ..native.errors import Status, VelourError
from .memory_limit import Limit
from .mesh_memory import mesh_memory
from .sizes import limit_size

MIB = 1 << 20

_STARTING = 16 * MIB  # for any scene
_THREAD = 2 * MIB
_MODEL = 4  # bytes per byte of a model: halves become floats, plus tables over the view
_BTF_MODEL = 10  # per byte of a BTF model, which is packed; up to 7 measured, for SVD
_MEASUREMENT = 3  # per byte of a table: the table and its proposal
_WORLD_PIXEL = 22  # per pixel: texels and their sums
_WORLD_VALUE = 8  # per channel of a pixel, while it is read
_PIXEL = 96  # per pixel: its sums, and the picture that is written
_RAY = 36  # per ray that is recorded to measure the share of tracing (ray_log.cpp)
_MAX_RAYS = 6_000_000
_RECORDED = 16  # one tile in so many
_MERGED_PIXEL = 112  # more per pixel if a side file is merged in


@dataclass(frozen=True)
class Estimate:
    """Peak memory of the whole process, in bytes."""

    parts: dict[str, int]
    remedies: dict[str, str]  # advice by part, for the largest one

    @property
    def total(self) -> int:
        return sum(self.parts.values())

    def __str__(self) -> str:
        return ", ".join(f"{name} {limit_size(value)}" for name, value in self.parts.items())

    @property
    def remedy(self) -> str:
        """Advice for the largest part."""
        return self.remedies[max(self.parts, key=self.parts.get)]

    def within(self, limit: Limit | None, what: str) -> str:
        """A line that states the estimate. Raises VelourError if `what` would exceed the limit."""
        size = limit_size(self.total)
        if limit and self.total > limit.size:
            raise VelourError(
                Status.OUT_OF_MEMORY,
                f"{what} needs about {size} of memory ({self}), more than the limit of"
                f" {limit_size(limit.size)} ({limit.of}); {self.remedy}.",
            )
        at_most = f" of {limit_size(limit.size)} ({limit.of})" if limit else ""
        return f"Estimated memory: {size}{at_most}: {self}"


_REMEDIES = {
    "program": "raise the limit",
    "mesh": "use a mesh with fewer faces, or raise the limit",
    "material": "fit a model and render it instead, or raise the limit",
    "world": "use an environment image with fewer pixels, or raise the limit",
    "picture": "render parts of the image (--crop) and merge them, or raise the limit",
}


def estimate(
    mesh: str,
    material: str,
    proposal: str | None,
    world: tuple[int, int, int],
    window: tuple[int, int],
    goes_on: bool,
    threads: int,
) -> Estimate:
    """`world`: width, height and channels of the environment image; `window`: width and height of the
    rendered pixels; `goes_on`: they are merged with a side file."""
    of_material = _material(material)  # first, as it opens the library, which counts as program
    width, height, channels = world
    parts = {
        "program": resident() + _STARTING + _THREAD * threads,
        "mesh": mesh_memory(mesh),
        "material": of_material + (_MODEL * os.path.getsize(proposal) if proposal else 0),
        "world": width * height * (_WORLD_PIXEL + _WORLD_VALUE * channels),
        "picture": window[0] * window[1] * (_PIXEL + (_MERGED_PIXEL if goes_on else 0)),
    }
    return Estimate(parts, _REMEDIES)


def recorded_rays(window: tuple[int, int], options: structs.RenderOptions) -> int:
    """Upper bound of what measure_ray_share takes, in bytes: paths may leave the scene early."""
    split = min(options.split, options.spp)
    rays = window[0] * window[1] * -(-options.spp // split) * (1 + split) * (1 + options.bounces)
    return min(-(-rays // _RECORDED), _MAX_RAYS) * _RAY


def _material(path: str) -> int:
    info = library.file_info(path)
    if info["kind"] == "btf":
        return info["raw_bytes"] * 4 // 3  # with its mip levels
    if info["kind"] != "model":
        return os.path.getsize(path) * _MEASUREMENT
    tables = sum(side.get("table_bytes") or 0 for side in info.get("sides", ()))
    return os.path.getsize(path) * (_BTF_MODEL if "texels" in info else _MODEL) + tables


def resident() -> int:
    """Resident memory of this process in bytes; 0 if the system does not report it."""
    return _status("VmRSS")


def peak() -> int:
    """Peak of resident(), in bytes."""
    return _status("VmHWM")


def _status(field: str) -> int:
    try:
        with open("/proc/self/status", encoding="ascii") as file:
            lines = dict(line.split(":", 1) for line in file if ":" in line)
        return int(lines[field].split()[0]) * 1024
    except (OSError, KeyError, ValueError):
        return 0
