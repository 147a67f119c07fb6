"""The chapter preset: the look scene, and a preset on its ball."""

import bpy

from . import scene
from .desk import inside

SIZE = (520, 520)


def steps(desk, measurement, facts):
    yield from desk.arrange()
    with inside("VIEW_3D"):
        bpy.ops.velour.new_look()
    yield 1.0
    scene.render(desk.folder, "look", SIZE)
    ball = bpy.context.view_layer.objects.active
    ball.active_material = None
    yield from desk.show("MATERIAL")
    bpy.context.window_manager.velour.browser.catalog = "Metals"
    yield 1.0
    desk.picture_of_panels("preset_grid", "MATERIAL", "Measured Material")
