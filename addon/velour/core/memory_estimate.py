"""What a render of the command line will take, told from its files before they are read.

The factors are those of measured peaks. They err to the safe side: what is freed before the next part comes
is counted as if it stayed.
"""

from __future__ import annotations

import os
from dataclasses import dataclass

from ..native import images, library
from ..native.errors import Status, VelourError
from .memory_limit import Limit
from .mesh_memory import mesh_memory
from .sizes import limit_size

MIB = 1 << 20

_STARTING = 16 * MIB  # whatever the scene
_THREAD = 2 * MIB
_MODEL = 4  # a byte of a model: halves become floats, tables over the view
_BTF_MODEL = 10  # of a BTF's, which are packed; up to 7 measured, of singular values
_MEASUREMENT = 3  # a byte of a table: the table, its proposal
_WORLD_PIXEL = 22  # texels and their sums
_WORLD_VALUE = 8  # while it is read
_PIXEL = 96  # sums of a pixel, and the picture that is written
_MERGED_PIXEL = 112  # beside what a side file has


@dataclass(frozen=True)
class Estimate:
    """Bytes at the peak, of the whole process."""

    parts: dict[str, int]
    remedies: dict[str, str]  # of each part, where it is the largest

    @property
    def total(self) -> int:
        return sum(self.parts.values())

    def __str__(self) -> str:
        return ", ".join(f"{name} {limit_size(value)}" for name, value in self.parts.items())

    @property
    def remedy(self) -> str:
        """What helps most."""
        return self.remedies[max(self.parts, key=self.parts.get)]

    def within(self, limit: Limit | None, what: str) -> str:
        """A line that states it. Raises VelourError where `what` would take more than the limit."""
        size = limit_size(self.total)
        if limit and self.total > limit.size:
            raise VelourError(
                Status.OUT_OF_MEMORY,
                f"{what} would take about {size} of memory ({self}), above its limit of"
                f" {limit_size(limit.size)} ({limit.of}); {self.remedy}.",
            )
        at_most = f" of {limit_size(limit.size)} ({limit.of})" if limit else ""
        return f"Estimated memory: {size}{at_most}: {self}"


_REMEDIES = {
    "program": "give it more",
    "mesh": "take a mesh of fewer faces, or give it more",
    "material": "fit a model and render that, or give it more",
    "world": "take a picture of fewer pixels for the world, or give it more",
    "picture": "render parts of it (--crop) and merge them, or give it more",
}


def estimate(
    mesh: str,
    material: str,
    proposal: str | None,
    world: str,
    window: tuple[int, int],
    goes_on: bool,
    threads: int,
) -> Estimate:
    """`window`: pixels that are rendered, across and up; `goes_on`: beside those of a side file."""
    of_material = _material(material)  # opens the library, which is a part of the program
    width, height, channels = images.size(world)
    parts = {
        "program": resident() + _STARTING + _THREAD * threads,
        "mesh": mesh_memory(mesh),
        "material": of_material + (_MODEL * os.path.getsize(proposal) if proposal else 0),
        "world": width * height * (_WORLD_PIXEL + _WORLD_VALUE * channels),
        "picture": window[0] * window[1] * (_PIXEL + (_MERGED_PIXEL if goes_on else 0)),
    }
    return Estimate(parts, _REMEDIES)


def _material(path: str) -> int:
    info = library.file_info(path)
    if info["kind"] == "btf":
        return info["raw_bytes"] * 4 // 3  # with coarser levels
    if info["kind"] != "model":
        return os.path.getsize(path) * _MEASUREMENT
    tables = sum(side.get("table_bytes") or 0 for side in info.get("sides", ()))
    return os.path.getsize(path) * (_BTF_MODEL if "texels" in info else _MODEL) + tables


def resident() -> int:
    """Bytes of this process that are in memory now; 0 where the system does not tell."""
    return _status("VmRSS")


def peak() -> int:
    """The most that there ever were."""
    return _status("VmHWM")


def _status(field: str) -> int:
    try:
        with open("/proc/self/status", encoding="ascii") as file:
            lines = dict(line.split(":", 1) for line in file if ":" in line)
        return int(lines[field].split()[0]) * 1024
    except (OSError, KeyError, ValueError):
        return 0
