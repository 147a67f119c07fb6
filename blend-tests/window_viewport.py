"""The rendered viewport: what it shows, how soon, in which colours; that it stops and goes on."""

import importlib
import time

import bpy
import numpy as np

from support import inputs, scenes, window

_TURN = 0.05
_PATIENCE = 40  # seconds; the machine may be busy


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (grey, first_picture))


def _addon(name):
    return importlib.import_module(f"{inputs.ADDON}.{name}")


def area_3d():
    return next(area for area in window.first().screen.areas if area.type == "VIEW_3D")


def show_rendered(samples=64):
    """Switches the viewport on; overlays and widgets off, so that pixels are the picture's."""
    scene = scenes.use_engine(samples)
    scene.velour.viewport_samples = samples
    space = area_3d().spaces.active
    space.overlay.show_overlays = space.show_gizmo = False
    space.shading.type = "RENDERED"
    return space


def viewports():
    return list(_addon("engine.viewport_clock").viewports())


def until(is_true, what):
    """Turns until `is_true()`."""
    end = time.monotonic() + _PATIENCE
    while not is_true():
        assert time.monotonic() < end, what
        yield _TURN


def finished():
    """Turns until the viewport has all of its samples on the screen."""
    yield 0.2
    yield from until(lambda: not viewports(), "the viewport does not come to its end")
    yield 0.3


def middle(pixels):
    """The middle of the 3D viewport on a screenshot."""
    area = area_3d()
    x, y = area.x + area.width // 2, area.y + area.height // 2
    return pixels[y - 20 : y + 20, x - 20 : x + 20]


def grey(folder):
    """Scene-linear 0.18 is 118 of 255 under Standard."""
    bpy.data.objects.remove(bpy.data.objects["Cube"])
    bpy.data.objects.remove(bpy.data.objects["Light"])
    scenes.set_world((0.18, 0.18, 0.18))
    show_rendered()
    yield from finished()
    values = 255 * middle(window.screenshot(folder, "grey"))
    assert np.abs(values - 118).max() <= 1, (values.min(), values.max())


def first_picture(folder):
    scenes.set_world((0.5, 0.7, 1.0), 0.5)
    space = show_rendered(samples=256)
    yield 0.4
    window.screenshot(folder, "first")
    yield from finished()
    window.screenshot(folder, "finished")
    space.shading.type = "SOLID"
    yield 0.5
    window.screenshot(folder, "solid")
