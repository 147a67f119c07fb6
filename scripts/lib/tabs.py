"""For scripts/tabs, in a window of Blender: pictures of the Properties editor with Velour and with Cycles."""

import math

import addon_utils
import bl_ui
import bpy
import numpy as np
from support import framebuffer, window

_ENGINES = ("VELOUR", "CYCLES")
_ADDONS = ("velour", "cycles")
_TABS = ("RENDER", "OUTPUT", "VIEW_LAYER", "SCENE", "WORLD", "OBJECT", "MATERIAL")
_LAMPS = ("POINT", "SUN", "SPOT", "AREA")
_RIM = 20  # rows of the editor's lower rim


def start(folder):
    """Called by the harness when the window exists."""
    window.run(folder, (tabs,), seconds=math.inf)


def tabs(folder):
    _open_all_panels()
    yield from window.show_properties("RENDER")
    window.first().cursor_warp(0, 0)  # outside the pictures
    _activate("Cube")
    for tab in _TABS:
        yield from _picture(folder, tab, tab.lower())
    _activate("Camera")
    yield from _picture(folder, "DATA", "camera")
    for lamp in _LAMPS:
        _activate("Light").data.type = lamp
        yield from _picture(folder, "DATA", f"light-{lamp.lower()}")


def _activate(name):
    objects = bpy.context.view_layer.objects
    objects.active = objects[name]
    return objects.active


def _open_all_panels():
    """Registers all panels as open before they are first drawn: no script can change the state that Blender
    remembers after that.

    Previews stay closed: one that is being rendered while the engine changes can block Blender forever.
    """
    for addon in _ADDONS:
        addon_utils.disable(addon)
    bl_ui.unregister()
    for panel in bpy.types.Panel.__subclasses__():
        if "DEFAULT_CLOSED" in getattr(panel, "bl_options", ()) and "preview" not in panel.__name__:
            panel.bl_options = set(panel.bl_options) - {"DEFAULT_CLOSED"}
    bl_ui.register()
    for addon in _ADDONS:
        addon_utils.enable(addon)


def _picture(folder, tab, name):
    sides = []
    for engine in _ENGINES:
        bpy.context.scene.render.engine = engine
        yield 0.3
        area = max(window.first().screen.areas, key=lambda area: area.width * area.height)
        area.spaces.active.context = tab
        yield 0.7
        shown = window.pixels(folder)
        sides.append(shown[area.y : area.y + area.height, area.x : area.x + area.width])
    framebuffer.write_png(folder / f"{name}.png", _without_empty_rows(np.concatenate(sides, axis=1)))


def _without_empty_rows(picture):
    """Crops the empty rows above the editor's lower rim, which are all equal. The first row is the lowest."""
    filled = np.flatnonzero((picture[_RIM:] != picture[_RIM]).any(axis=(1, 2)))
    return picture[filled[0] :]
