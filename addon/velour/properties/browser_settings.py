"""State of the browsers of measurements and presets. Never saved."""

import bpy
from bpy.props import EnumProperty, IntProperty, StringProperty

from ..core import presets

_catalogs = []  # Blender needs a reference to the strings of dynamic items


def _to_first_page(settings, _context):
    settings.page = 1


def _catalog_items(_settings, _context):
    if not _catalogs:
        try:
            names = dict.fromkeys(preset.catalog for preset in presets.listed())
        except (OSError, ValueError):  # the panel shows why
            names = {}
        _catalogs[:] = [(name, name, "") for name in names] or [("NONE", "None", "No presets")]
    return _catalogs


class VelourBrowserSettings(bpy.types.PropertyGroup):
    """`window_manager.velour.browser`."""

    search: StringProperty(
        name="Search",
        description="Show only files whose names contain all of these words",
        options={"SKIP_SAVE", "TEXTEDIT_UPDATE"},
        update=_to_first_page,
    )
    page: IntProperty(name="Page", description="Page of thumbnails", default=1, min=1, options={"SKIP_SAVE"})
    catalog: EnumProperty(
        name="Presets",
        description="Group of preset materials to show",
        items=_catalog_items,
        options={"SKIP_SAVE"},
    )
    chosen: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # path of a file
    # Incremented to search the folder again.
    visits: IntProperty(options={"HIDDEN", "SKIP_SAVE"})
