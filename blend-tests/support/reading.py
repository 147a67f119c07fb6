"""Files that take long to read, and reading that does not begin before it may."""

import threading
import time
from pathlib import Path
from unittest import mock

import bpy

from . import inputs, window

_DATA = Path(__file__).resolve().parent.parent / "scenes/data"
MODEL, TILES = _DATA / "paint.velour", _DATA / "weave.velour"
LARGE = 300_000_000  # bytes: beside them what a turn has to do anyway is little
_HELD_SHARE = 0.08  # that a turn may take from the main thread, of what reading at once takes from it


module = inputs.module


def large_file(folder, name="large.velour", size=LARGE, model=None):
    """A model's file of that many bytes, of which most are zeros behind the model."""
    path = folder / name
    path.write_bytes(model or MODEL.read_bytes())
    with open(path, "r+b") as file:
        file.truncate(size)
    return path


def shown(path):
    """The cube's material with a model that stays a file; its image."""
    data = path.read_bytes()
    measured = module("operators.measured")
    material = measured.new_material("Paint")
    image = measured.linked_model(str(path), module("export.files").sha256(data))
    measured.ensure_node(material).image = image
    cube = bpy.context.view_layer.objects["Cube"]
    cube.active_material = material
    bpy.context.view_layer.objects.active = cube
    with window.override():
        bpy.ops.ed.undo_push(message="a model")
    return image


def check_turns(what, seconds, at_once):
    """`seconds`: of the main thread in each turn. `at_once()` reads all in one: machines differ."""
    whole, longest = [], max(seconds)
    window.timed(at_once, whole)()
    print(f"{what} held the window for {1e3 * longest:.1f} ms at most; at once takes {1e3 * whole[0]:.0f} ms")
    assert longest < _HELD_SHARE * whole[0], f"a turn held the window for {longest:.3f} s"


class Held:
    """Reading does not begin before release(): what happens meanwhile, happens meanwhile."""

    def __init__(self, owner, name):
        self._go_on = threading.Event()
        read = getattr(owner, name)

        is_cancelled = module("core.read_job").is_cancelled

        def held(*arguments):
            end = time.monotonic() + 60
            while not self._go_on.wait(0.02):
                is_cancelled()  # a pause, as in whatever takes long (core/reading_gate.py)
                assert time.monotonic() < end
            return read(*arguments)

        self._patch = mock.patch.object(owner, name, held)
        self._patch.start()

    def release(self):
        self._go_on.set()
        self._patch.stop()
