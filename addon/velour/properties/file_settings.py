"""What is remembered of a model or measurement file, or of a picture that Velour made."""

import bpy
from bpy.props import BoolProperty, StringProperty

from .saved_by import saved_by


class VelourFileSettings(bpy.types.PropertyGroup):
    """`image.velour`."""

    saved_by: saved_by()
    sha256: StringProperty(
        name="SHA-256",
        description="Of the file when it was chosen or fitted; empty: not checked."
        " A final render refuses a file that has changed since",
        override={"LIBRARY_OVERRIDABLE"},
    )
    is_plot: BoolProperty(options={"HIDDEN"})  # drawn by an operator, which may draw another one over it
    made_as: StringProperty(
        options={"HIDDEN"}
    )  # the name that its operator asked for; it may have another one
    compared: StringProperty(options={"HIDDEN"})  # a comparison: of which model with which measurement
