"""The window: a tile as the artist adds it, changes its type, and sees it repeated."""

import bpy
import numpy as np

from support import window


def start(folder):
    """Called by the harness once the window is there."""
    window.run(folder, (add_and_repeat, another_type))


def _clear_view():
    """A 3D viewport without the objects of the start, in a scene of millimetres."""
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)
    bpy.context.scene.unit_settings.scale_length = 0.001
    area = next(area for area in window.first().screen.areas if area.type == "VIEW_3D")
    area.spaces.active.shading.type = "SOLID"
    area.spaces.active.shading.color_type = "MATERIAL"
    return area


def _in_view(area):
    region = next(region for region in area.regions if region.type == "WINDOW")
    return bpy.context.temp_override(window=window.first(), area=area, region=region)


def _add(area, **arguments):
    with _in_view(area):
        assert bpy.ops.velour.add_mesostructure("INVOKE_DEFAULT", True, **arguments) == {"FINISHED"}
    return bpy.context.view_layer.objects.active


def add_and_repeat(folder):
    area = _clear_view()
    _add(area, type="WEAVE")
    with _in_view(area):
        bpy.ops.view3d.view_selected()
    yield 0.7
    alone = window.screenshot(folder, "weave")
    with _in_view(area):
        bpy.ops.velour.repeat_tile()
    yield 0.7
    assert np.abs(window.screenshot(folder, "weave-repeated") - alone).max() > 0.2, "no copies"


def another_type(folder):
    """The panel of the last operation is filled in; another type in it begins with that type's own shape."""
    area = _clear_view()
    _add(area, type="NET")
    yield 0.5
    last = bpy.context.window_manager.operators[-1].properties
    assert abs(last.size - 20) < 1e-4, last.size
    assert abs(last.gap - 0.78) < 1e-6, last.gap
    last.type = "GRAVEL"
    for name in ("size", "gap", "count"):
        assert not last.is_property_set(name), name
    window.screenshot(folder, "net")
