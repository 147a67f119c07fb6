"""Data on a model or measurement file, or on an image that Velour made."""

import bpy
from bpy.props import BoolProperty, StringProperty

from .saved_by import saved_by


class VelourFileSettings(bpy.types.PropertyGroup):
    """`image.velour`."""

    saved_by: saved_by()
    sha256: StringProperty(
        name="SHA-256",
        description="SHA-256 of the file when it was chosen or fitted. Final renders refuse a file that has"
        " changed since. Empty: not checked",
        override={"LIBRARY_OVERRIDABLE"},
    )
    is_plot: BoolProperty(options={"HIDDEN"})  # made by an operator, which may overwrite it
    made_as: StringProperty(options={"HIDDEN"})  # name requested by its operator; the actual one may differ
    compared: StringProperty(options={"HIDDEN"})  # key of the model and measurement that a comparison shows
