"""Adds the preset library to Blender's asset browsers, only when the user asks for it."""

import os

import bpy
from bpy.props import StringProperty

from ..core import presets


class VELOUR_OT_add_presets(bpy.types.Operator):
    bl_idname = "velour.add_presets"
    bl_label = "Add Preset Library"
    bl_description = "Add the folder of Velour's preset materials to the asset libraries in the preferences"
    bl_options = {"REGISTER"}

    directory: StringProperty(
        name="Folder",
        subtype="DIR_PATH",
        description="Folder that contains velour_presets.blend. Empty: the folder of the add-on",
        options={"SKIP_SAVE"},
    )

    def invoke(self, context, event):
        """Asks for the folder if the add-on contains no presets."""
        if self.directory or presets.has_library(presets.folder()):
            return self.execute(context)
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context):
        folder = os.path.normpath(bpy.path.abspath(self.directory) or presets.folder())
        if not presets.has_library(folder):
            self.report({"ERROR"}, missing(folder))
            return {"CANCELLED"}
        known = library_of(context.preferences, folder)
        if known is not None:
            self.report({"INFO"}, f"The asset library '{known.name}' already exists: {folder}")
            return {"FINISHED"}
        _add(context.preferences, folder)
        self.report({"INFO"}, f"Added the asset library '{presets.NAME}': {folder}")
        return {"FINISHED"}


def missing(folder):
    """Error message for a `folder` without presets, with the remedy."""
    return (
        f"{folder} does not contain {presets.LIBRARY_FILE}. Run scripts/presets in Velour's sources, then"
        " scripts/build or scripts/package; or choose the folder that contains it."
    )


def library_of(preferences, folder):
    """The user's asset library at `folder`, or None."""
    for library in preferences.filepaths.asset_libraries:
        if os.path.realpath(bpy.path.abspath(library.path)) == os.path.realpath(folder):
            return library
    return None


def _add(preferences, folder):
    bpy.ops.preferences.asset_library_add(directory=str(folder))
    library = library_of(preferences, folder)
    library.name = presets.NAME
    if hasattr(library, "import_method"):
        _prefer_appending(library)


def _prefer_appending(library):
    """Prefers appending, so that models are stored in the file that uses them."""
    try:
        library.import_method = "APPEND_REUSE"
    except TypeError:  # newer Blender versions list it, but reject it
        library.import_method = "APPEND"
