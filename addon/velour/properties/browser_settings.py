"""Where a browser of measurements stands. Never saved; its folder is a preference."""

import bpy
from bpy.props import IntProperty, StringProperty


def _to_first_page(settings, _context):
    settings.page = 1


class VelourBrowserSettings(bpy.types.PropertyGroup):
    """`window_manager.velour.browser`."""

    search: StringProperty(
        name="Search",
        description="Words that the names must have",
        options={"SKIP_SAVE", "TEXTEDIT_UPDATE"},
        update=_to_first_page,
    )
    page: IntProperty(name="Page", description="Of the pictures", default=1, min=1, options={"SKIP_SAVE"})
    chosen: StringProperty(options={"HIDDEN", "SKIP_SAVE"})  # path of a file
    # Grows when the folder is to be looked through anew.
    visits: IntProperty(options={"HIDDEN", "SKIP_SAVE"})
