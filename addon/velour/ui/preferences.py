"""The add-on's preferences: is the library there, and which."""

import bpy

from . import library_state
from .text import draw_sentence


class VelourPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__.rpartition(".")[0]

    def draw(self, context):
        problem = library_state.problem()
        if problem:
            draw_sentence(context, self.layout, problem, icon="ERROR")
            return
        column = self.layout.column(align=True)
        for line in library_state.lines():
            column.label(text=line)
