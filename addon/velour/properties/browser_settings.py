"""State of the measurement browser. Never saved; its folder is a preference."""

import bpy
from bpy.props import IntProperty, StringProperty


def _to_first_page(settings, _context):
    settings.page = 1


class VelourBrowserSettings(bpy.types.PropertyGroup):
    """`window_manager.velour.browser`."""

    search: StringProperty(
        name="Search",
        description="Show only files whose names contain all of these words",
        options={"SKIP_SAVE", "TEXTEDIT_UPDATE"},
        update=_to_first_page,
    )
    page: IntProperty(name="Page", description="Page of thumbnails", default=1, min=1, options={"SKIP_SAVE"})
    chosen: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # path of a file
    # Incremented to search the folder again.
    visits: IntProperty(options={"HIDDEN", "SKIP_SAVE"})
