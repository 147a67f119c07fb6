"""Sky Textures: images that the running Blender renders of them (sky_render.py), kept in the cache folder."""

import hashlib
import json
import math
import os
import subprocess
import sys
import tempfile
import threading
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

from ...core.files import write_atomic
from ..caches import cache_folder
from ..image_nodes import UnsupportedError

_WIDTH = 2048  # texels; between them, radiance is interpolated within 0.1 %
_SECONDS = 300  # that Blender may take
_MOST_KEPT = 64  # files in the cache
_PROGRAM = Path(__file__).with_name("sky_render.py")
_INHERITED = {"texture_mapping", "color_mapping"}
_BY_DIRECTION = {"PREETHAM", "HOSEK_WILKIE"}  # models that `sun_rotation` does not turn

_rendering = {}  # threads by path
_failures = {}  # sentences by path


class SkyPicture(NamedTuple):
    """The sky without the disk of its sun, in place of a Picture."""

    path: str
    image = None
    alpha = False

    def pixels(self):
        """[height x width x 3] float32, linear Rec. 709, row 0 at the bottom."""
        with np.load(self.path) as stored:
            return stored["sky"].astype(np.float32)


class Sun(NamedTuple):
    """The disk of a sky's sun."""

    direction: tuple  # towards it, unit
    angle: float  # its diameter, radians
    radiance: tuple  # [3], linear Rec. 709, mean over the disk


class Sky(NamedTuple):
    picture: SkyPicture
    turn: float  # the picture is turned about +z by this angle from +y towards +x, radians
    sun: Sun | None


class PendingError(Exception):
    """The sky is being rendered; worlds are tagged as changed when it is there."""


def sky_of(node, waits):
    """The Sky of a Sky Texture node. Raises UnsupportedError if it cannot be rendered.

    waits: render what is not cached now; else raise PendingError and render it in the background.
    """
    values = _values(node)
    turn = values.pop("sun_rotation", 0.0) if node.sky_type not in _BY_DIRECTION else 0.0
    path = _path(values)
    if not path.is_file():
        _render(node, path, values, waits)
    with np.load(path) as stored:
        radiance = tuple(map(float, stored["sun"]))
    picture = SkyPicture(str(path))
    return Sky(picture, turn, _sun(values, turn, radiance) if any(radiance) else None)


def _values(node):
    """Values of the properties that only this kind of node has."""
    own = set(node.bl_rna.properties.keys()) - set(bpy.types.ShaderNode.bl_rna.properties.keys()) - _INHERITED
    values = {name: getattr(node, name) for name in sorted(own)}
    return {
        name: value if isinstance(value, (bool, int, float, str)) else list(value)
        for name, value in values.items()
        if isinstance(value, (bool, int, float, str)) or hasattr(value, "__len__")
    }


def _sun(values, turn, radiance):
    elevation = values["sun_elevation"]
    level = math.cos(elevation)
    direction = level * math.sin(turn), level * math.cos(turn), math.sin(elevation)
    return Sun(direction, values["sun_size"], radiance)


def _path(values):
    made_of = [values, _WIDTH, bpy.app.version_string, _PROGRAM.read_text(encoding="utf-8")]
    digest = hashlib.sha256(json.dumps(made_of, sort_keys=True).encode()).hexdigest()
    return Path(cache_folder()) / f"sky-texture-{digest}.npz"


def _render(node, path, values, waits):
    if waits:
        if path in _rendering:
            _rendering[path].join()
        else:
            _run(path, values)
    elif path not in _rendering and path not in _failures:
        _rendering[path] = threading.Thread(target=_run, args=(path, values), daemon=True)
        _rendering[path].start()
        bpy.app.timers.register(lambda: _announce(path), first_interval=0.1, persistent=True)
    if path.is_file():
        return
    if path not in _failures:
        raise PendingError
    raise UnsupportedError(f"Blender cannot render '{node.name}': {_failures.pop(path)}")


def _announce(path):
    """Tags all worlds once the thread has ended; seconds until the next call."""
    if _rendering[path].is_alive():
        return 0.1
    del _rendering[path]
    for world in bpy.data.worlds:
        world.update_tag()
    return None


def _run(path, values):
    """Leaves a file, or a sentence in _failures."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        write_atomic(path, lambda temporary: _start_blender(temporary, values))
        _remove_oldest(path.parent)
    except (OSError, subprocess.SubprocessError) as error:
        _failures[path] = str(error)


def _start_blender(path, values):
    with tempfile.TemporaryDirectory() as folder:
        order = Path(folder) / "order.json"
        order.write_text(json.dumps({"node": values, "width": _WIDTH, "path": str(path)}), encoding="utf-8")
        options = ["-b", "--factory-startup", "--python-exit-code", "1", "--python"]
        # The module bpy has no program of its own.
        start = [bpy.app.binary_path, *options] if bpy.app.binary_path else [sys.executable]
        done = subprocess.run(
            [*start, str(_PROGRAM), "--", str(order)],
            stdin=subprocess.DEVNULL,
            capture_output=True,
            text=True,
            errors="replace",
            timeout=_SECONDS,
            check=False,
        )
    if done.returncode != 0 or os.path.getsize(path) == 0:
        lines = (done.stderr.strip() or done.stdout.strip() or "no message").splitlines()
        raise OSError(lines[-1])


def _remove_oldest(folder):
    files = sorted(folder.glob("sky-texture-*.npz"), key=os.path.getmtime)
    for file in files[:-_MOST_KEPT]:
        file.unlink(missing_ok=True)
