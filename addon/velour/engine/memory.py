"""What a frame will take beside Blender's own scene, stated before it is rendered, and refused where that is
more than there is."""

import os
from typing import NamedTuple

from ..core.memory_estimate import resident, size_text
from ..core.memory_limit import Limit, memory_limit
from ..native.errors import Status, VelourError
from ..native.passes import sums_per_pixel

_RENDERING = 16 << 20  # beside what is counted
_THREAD = 2 << 20
_FLOAT = 4
_RESULTS = 2  # Blender's own of a frame: while it is handed over, and while it is written
_KEPT_FILMS = 2  # of parts: what a file had, and what it gets


class Estimate(NamedTuple):
    """Bytes at the peak, of the whole process."""

    blender: int  # with its scene, as it is now
    scene: int  # Velour's, with the hierarchies of tracing
    picture: int  # film and passes

    @property
    def total(self):
        return sum(self)

    def __str__(self):
        return ", ".join(f"{name} {size_text(value)}" for name, value in self._asdict().items())

    @property
    def remedy(self):
        parts = self._asdict()
        return _REMEDIES[max(parts, key=parts.get)]


_REMEDIES = {
    "blender": "make the .blend smaller, or give it more",
    "scene": "take meshes of fewer faces and smaller pictures, or give it more",
    "picture": "render fewer passes or pixels, or give it more",
}


def estimate(native_scene, view, passes, shown, threads, keeps_film):
    """Of a scene that is exported already; `passes` is the render job's, `shown` are the LayerPasses."""
    scene = native_scene.info()["bytes"]
    channels = sum(each.channels for each in shown)
    numbers = sums_per_pixel(passes) * (1 + _KEPT_FILMS * keeps_film) + _RESULTS * channels
    picture = view.width * view.height * _FLOAT * numbers + _RENDERING + _THREAD * threads
    return Estimate(max(0, resident() - scene), scene, picture)


def checked(found, asked):
    """A line that states the Estimate. `asked`: the most it may be, in bytes; else what the system gives."""
    limit = Limit(asked, "--velour-memory") if asked else memory_limit(os.environ)
    if limit and found.total > limit.size:
        raise VelourError(
            Status.OUT_OF_MEMORY,
            f"The frame would take about {size_text(found.total)} of memory ({found}), above its limit of"
            f" {size_text(limit.size)} ({limit.of}); {found.remedy}.",
        )
    at_most = f" of {size_text(limit.size)} ({limit.of})" if limit else ""
    return f"Estimated memory: {size_text(found.total)}{at_most}: {found}"
