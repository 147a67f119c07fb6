"""What a frame will take beside Blender's own scene, stated before it is rendered, and refused where that is
more than there is."""

import os

from ..core.memory_estimate import Estimate, resident
from ..core.memory_limit import Limit, memory_limit
from ..native.passes import sums_per_pixel

_RENDERING = 16 << 20  # beside what is counted
_THREAD = 2 << 20
_FLOAT = 4
_RESULTS = 2  # Blender's own of a frame: while it is handed over, and while it is written
_KEPT_FILMS = 2  # of parts: what a file had, and what it gets


# Of Blender with its scene as it is now, Velour's scene with the hierarchies of tracing, film and passes.
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
    parts = {"blender": max(0, resident() - scene), "scene": scene, "picture": picture}
    return Estimate(parts, _REMEDIES)


class MemoryLimit:
    """Of a frame. `asked`: the most that may be taken, in bytes; else what the system gives."""

    def __init__(self, asked):
        self._limit = Limit(asked, "--velour-memory") if asked else memory_limit(os.environ)
        self._before = resident()

    def check_export(self):
        """Raises VelourError where the scene is too large before all of it is exported: else the system would
        end Blender, without a word, before anything is estimated."""
        scene = max(0, resident() - self._before)
        found = Estimate({"blender": self._before, "scene": scene}, _REMEDIES)
        found.within(self._limit, "The frame, which is not all exported yet,")

    def check(self, found):
        """A line that states the Estimate; raises VelourError where that is too large."""
        return found.within(self._limit, "The frame")
