"""A folder of measurements, looked through in the Material tab."""

import importlib
import tempfile
from pathlib import Path

import bpy
import data_files
from support import inputs, window

from . import scene
from .desk import inside

_PANEL = "Library of Measurements"


def steps(desk, measurement, facts):
    yield from desk.arrange()
    scene.start()
    with inside("VIEW_3D"):
        monkey = scene.add_monkey()
    monkey.active_material = bpy.data.materials.new("Material")
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary, "measurements")
        folder.symlink_to(data_files.folder() / "brdf")
        yield from _library(desk, folder, measurement.name)


def _library(desk, folder, chosen):
    browse = importlib.import_module(f"{inputs.ADDON}.operators.browse")
    browse.addon_preferences(bpy.context).measurements = str(folder)
    settings = bpy.context.window_manager.velour.browser
    settings.chosen = str(folder / chosen)
    yield from desk.show("MATERIAL")
    yield from desk.fold("MATERIAL", _PANEL, is_open=True)
    yield from _all_pictures()
    desk.picture_of_panels("library", "MATERIAL", _PANEL)


def _all_pictures():
    browser = importlib.import_module(f"{inputs.ADDON}.ui.browser")
    for _ in range(1200):
        yield 0.1
        for area in window.first().screen.areas:
            area.tag_redraw()
        if browser.is_at_rest() and browser._pictures:
            yield 0.5
            return
    raise TimeoutError("the pictures of the library are never there")
