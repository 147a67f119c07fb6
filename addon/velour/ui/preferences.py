"""The add-on's preferences: state of the library, presets, and the folder of measurements."""

import bpy
from bpy.props import StringProperty

from ..core import presets
from ..operators.add_presets import VELOUR_OT_add_presets, library_of, missing
from . import library_state
from .text import draw_sentence


class VelourPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__.rpartition(".")[0]

    measurements: StringProperty(
        name="Measurements",
        description="Folder of measurements and models that the Measurement Library panel shows",
        subtype="DIR_PATH",
    )

    def draw(self, context):
        problem = library_state.problem()
        if problem:
            draw_sentence(context, self.layout, problem, icon="ERROR")
            return
        column = self.layout.column(align=True)
        for line in library_state.lines():
            column.label(text=line)
        self.layout.prop(self, "measurements")
        self._draw_presets(context)

    def _draw_presets(self, context):
        folder = presets.folder()
        column = self.layout.column()
        if library_of(context.preferences, folder):
            draw_sentence(
                context, column, f"Preset materials: in the asset browser, from {folder}", icon="CHECKMARK"
            )
            return
        text = (
            f"Preset materials: {folder}"
            if presets.has_library(folder)
            else f"No preset materials. {missing(folder)}"
        )
        draw_sentence(context, column, text)
        column.operator(VELOUR_OT_add_presets.bl_idname, icon="ASSET_MANAGER")
