"""The chapter library: browsing a folder of measurements in the Material tab."""

import importlib

import bpy
from bench import data_files
from support import inputs, window

from . import scene
from .desk import inside

_PANEL = "Measurement Library"
_FOLDER = "measurements"


def steps(desk, measurement, facts):
    yield from desk.arrange()
    scene.start()
    with inside("VIEW_3D"):
        monkey = scene.add_monkey()
    monkey.active_material = bpy.data.materials.new("Material")
    (desk.folder / _FOLDER).symlink_to(data_files.folder() / "brdf")
    bpy.ops.wm.save_as_mainfile(filepath=str(desk.folder / "library.blend"))
    browse = importlib.import_module(f"{inputs.ADDON}.operators.browse")
    browse.addon_preferences(
        bpy.context
    ).measurements = f"//{_FOLDER}/"  # Blender's notation for paths relative to the .blend
    settings = bpy.context.window_manager.velour.browser
    settings.chosen = str(desk.folder / _FOLDER / measurement.name)
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
