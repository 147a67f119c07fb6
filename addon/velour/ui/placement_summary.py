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
from .summaries import model_summary, redraw_panels

_QUIET_SECONDS = 0.3  # nothing is measured during changes such as dragging


class Measured(NamedTuple):
    placement: PlacementReport | None = None  # if the material has tiles or is anisotropic
    outline: OutlineReport | None = None  # if it has a VOTF, and the object has texture coordinates


class _Shown(NamedTuple):
    """What a panel shows; datablocks as in key_of()."""

    object: str | tuple
    material: str | tuple
    scene: str | tuple
    view_layer: str


_KEPT = 16  # editors that show different objects draw in turn
_reports = {}  # _Shown: Measured, possibly outdated; None: not yet. What was drawn last comes last
_fresh = {}  # those whose report is not outdated, and its frame
_waiting = {}  # those to measure; what was drawn last comes last
_changed = 0.0  # time.monotonic() of the last change


def measured(context, material):
    """Measured of the active object, which must exist; None while there is none yet."""
    owners = map(key_of, (context.object, material, context.scene))
    key = _Shown(*owners, context.view_layer.name)
    _reports[key] = _reports.pop(key, None)
    while len(_reports) > _KEPT:
        _forget(next(iter(_reports)))
    if _fresh.get(key) != context.scene.frame_current:
        _waiting[key] = None
        if not bpy.app.timers.is_registered(_measure):
            bpy.app.timers.register(_measure)
    return _reports[key]


def _forget(key):
    del _reports[key]
    _fresh.pop(key, None)
    _waiting.pop(key, None)


def attach():
    bpy.app.handlers.depsgraph_update_post.append(_note_change)


def detach():
    bpy.app.handlers.depsgraph_update_post.remove(_note_change)
    if bpy.app.timers.is_registered(_measure):
        bpy.app.timers.unregister(_measure)
    for kept in (_reports, _fresh, _waiting):
        kept.clear()


@persistent
def _note_change(_scene, _depsgraph):
    """Only records the change, since renders may call it from their thread."""
    global _changed
    _fresh.clear()
    _changed = time.monotonic()


def _measure():
    """Timer on the main thread, between redraws; measures for one panel at a time."""
    if not _waiting:  # what waited was forgotten
        return None
    quiet = time.monotonic() - _changed
    if quiet < _QUIET_SECONDS:
        return _QUIET_SECONDS - quiet
    key, _ = _waiting.popitem()
    # The timer's own context may have the scene and the view layer of another window.
    scene = bpy.data.scenes.get(key.scene)
    layer = scene.view_layers.get(key.view_layer) if scene is not None else None
    if layer is not None:
        layer.update()
        _fresh[key] = scene.frame_current  # from here on, changes outdate the report
    _reports[key] = _report_of(key, layer)
    redraw_panels()
    return 0.0 if _waiting else None


def _report_of(shown, layer):
    obj, material = bpy.data.objects.get(shown.object), bpy.data.materials.get(shown.material)
    node = velour_node(material)
    info = model_summary(node.image) if node is not None and node.image is not None else None
    if obj is None or layer is None or not isinstance(info, dict):
        return None
    depsgraph = layer.depsgraph
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
