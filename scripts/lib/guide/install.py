"""The chapter install: the add-on in the preferences."""

import bpy

from .desk import area


def steps(desk, _measurement, _facts):
    editor = area("VIEW_3D")
    editor.type = "PREFERENCES"
    bpy.context.preferences.active_section = "ADDONS"
    bpy.context.window_manager.addon_search = "Velour"
    yield 1.5  # the first draw looks for add-ons
    yield from desk.show("RENDER")
    desk.picture_of_editor("install", "PREFERENCES", height=150)
