"""Measures a material's placement on the active object for panels, between redraws.

engine/write_lock.py explains why."""

import time
from typing import NamedTuple

import bpy
from bpy.app.handlers import persistent

from ..export.measured_look import constant_look
from ..export.nodes import velour_node
from ..export.outline_report import OutlineReport, outline_report_on
from ..export.placement import Tile
from ..export.placement_report import PlacementReport, report_on, report_on_brushed
from ..operators.job_target import key_of
from .summaries import model_summary

_QUIET_SECONDS = 0.3  # nothing is measured during changes such as dragging


class Measured(NamedTuple):
    placement: PlacementReport | None = None  # if the material has tiles or is anisotropic
    outline: OutlineReport | None = None  # if it has a VOTF, and the object has texture coordinates


_key = None  # identifies what was drawn last
_report = None  # report for _key, possibly outdated
_is_fresh = False
_changed = 0.0  # time.monotonic() of the last change


def measured(context, material):
    """Measured of the active object, which must exist; None while there is none yet."""
    global _key, _report, _is_fresh
    shown = (context.object, material, context.scene)
    key = (*map(key_of, shown), context.scene.frame_current)
    if key != _key:
        _key, _report, _is_fresh = key, None, False
    if not _is_fresh and not bpy.app.timers.is_registered(_measure):
        bpy.app.timers.register(_measure)
    return _report


def attach():
    bpy.app.handlers.depsgraph_update_post.append(_note_change)


def detach():
    global _key, _report
    bpy.app.handlers.depsgraph_update_post.remove(_note_change)
    if bpy.app.timers.is_registered(_measure):
        bpy.app.timers.unregister(_measure)
    _key = _report = None


@persistent
def _note_change(_scene, _depsgraph):
    """Only records the change, since renders may call it from their thread."""
    global _is_fresh, _changed
    _is_fresh, _changed = False, time.monotonic()


def _measure():
    """Timer on the main thread, between redraws."""
    global _report, _is_fresh
    quiet = time.monotonic() - _changed
    if quiet < _QUIET_SECONDS:
        return _QUIET_SECONDS - quiet
    obj, material, scene, _frame = _key
    _is_fresh = True
    _report = _report_of(
        bpy.data.objects.get(obj), bpy.data.materials.get(material), bpy.data.scenes.get(scene)
    )
    for window in bpy.context.window_manager.windows:
        for area in window.screen.areas:
            if area.type == "PROPERTIES":
                area.tag_redraw()
    return None


def _report_of(obj, material, scene):
    node = velour_node(material)
    info = model_summary(node.image) if node is not None and node.image is not None else None
    depsgraph = bpy.context.evaluated_depsgraph_get()
    if obj is None or not isinstance(info, dict) or depsgraph.scene != scene:
        return None
    tile = Tile.of(material, node, constant_look(node), info)
    placement = _placement_of(depsgraph, obj, material, info, tile)
    if "shell" not in info:
        return Measured(placement)
    width = node.velour.outline_width
    return Measured(placement, outline_report_on(depsgraph, obj, material, info["shell"], tile, width))


def _placement_of(depsgraph, obj, material, info, tile):
    if tile is not None:
        return report_on(depsgraph, obj, material, tile)
    return None if info["isotropic"] else report_on_brushed(depsgraph, obj, material)
