"""Estimates the memory of a frame, including Blender's own scene, before it is rendered, and refuses a frame
above the limit."""

import os

from ..core.memory_estimate import Estimate, resident
from ..core.memory_limit import Limit, memory_limit
from ..native.passes import sums_per_pixel

_RENDERING = 16 << 20  # bytes in addition to what is counted
_THREAD = 2 << 20
_FLOAT = 4
_RESULTS = 2  # Blender's copies of a frame: while it is delivered, and while it is written
_KEPT_FILMS = 2  # films of parts: the one read from a file, and the one written


# Parts: Blender with its current scene; Velour's scene with its BVHs; film and passes.
_REMEDIES = {
    "blender": "make the .blend smaller, or raise the limit",
    "scene": "use meshes with fewer faces and smaller images, or raise the limit",
    "picture": "render fewer passes or pixels, or raise the limit",
}


def estimate(native_scene, view, passes, shown, threads, keeps_film):
    """Estimate for an exported scene; `passes`: those of the render job, `shown`: the LayerPasses."""
    scene = native_scene.info()["bytes"]
    channels = sum(each.channels for each in shown)
    numbers = sums_per_pixel(passes) * (1 + _KEPT_FILMS * keeps_film) + _RESULTS * channels
    picture = view.width * view.height * _FLOAT * numbers + _RENDERING + _THREAD * threads
    parts = {"blender": max(0, resident() - scene), "scene": scene, "picture": picture}
    return Estimate(parts, _REMEDIES)


class MemoryLimit:
    """Memory limit of a frame. `asked`: the limit in bytes; None: the system's limit."""

    def __init__(self, asked):
        self._limit = Limit(asked, "--velour-memory") if asked else memory_limit(os.environ)
        self._before = resident()

    def check_export(self):
        """Raises VelourError if the scene is too large before all of it is exported; otherwise the system
        would kill Blender without a message before the estimate."""
        scene = max(0, resident() - self._before)
        found = Estimate({"blender": self._before, "scene": scene}, _REMEDIES)
        found.within(self._limit, "The frame, which is only partly exported yet,")

    def check(self, found):
        """A line that states the Estimate; raises VelourError if it is too large."""
        return found.within(self._limit, "The frame")
