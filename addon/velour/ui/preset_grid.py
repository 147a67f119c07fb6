"""Preset materials as a grid of balls in an empty Material tab."""

import bpy.utils.previews

from ..core import presets
from ..operators.add_preset import VELOUR_OT_add_preset
from .text import draw_sentence, label_width
from .units import button_height

_PICTURE = 4.0  # height in buttons
_BESIDE = 2.0  # width of the panel's and editor's margins in buttons
_BESIDE_NAME = 1.1  # width of a button beside its text, in buttons
_found = None  # (list of Preset, sentence), read once
_previews = None


def draw_presets(context, layout):
    """Draws the presets of the chosen catalog; nothing if the add-on has none. Safe in draw()."""
    found, sentence = _presets()
    if sentence:
        draw_sentence(context, layout, sentence, icon="ERROR")
    if not found:
        return
    settings = context.window_manager.velour.browser
    layout.prop(settings, "catalog")
    shown = [preset for preset in found if preset.catalog == settings.catalog]
    columns = _columns(context, [preset.name for preset in shown])
    grid = layout.grid_flow(row_major=True, columns=columns, even_columns=True, even_rows=True)
    for preset in shown:
        cell = grid.column(align=True)
        cell.template_icon(_icon(preset), scale=_PICTURE)
        cell.operator(VELOUR_OT_add_preset.bl_idname, text=preset.name).preset = preset.name


def _columns(context, names):
    """Number of columns in which no name is cut."""
    unit = button_height(context.preferences.system)
    widest = max((label_width(context, name) for name in names), default=0) + _BESIDE_NAME * unit
    return max(1, int((context.region.width - _BESIDE * unit) / max(widest, _PICTURE * unit)))


def _presets():
    global _found
    if _found is None:
        try:
            _found = presets.listed(), None
        except (OSError, ValueError) as error:
            _found = [], str(error)
    return _found


def _icon(preset):
    global _previews
    if _previews is None:
        _previews = bpy.utils.previews.new()
    if preset.name not in _previews:
        _previews.load(preset.name, str(preset.picture), "IMAGE")
    return _previews[preset.name].icon_id


def forget():
    global _found, _previews
    _found = None
    if _previews is not None:
        bpy.utils.previews.remove(_previews)
        _previews = None
