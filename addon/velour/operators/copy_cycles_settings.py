"""Copies the scene's Cycles settings that suppress fireflies."""

import bpy

from ..export.unused_settings import COPIED


class VELOUR_OT_copy_cycles_settings(bpy.types.Operator):
    bl_idname = "velour.copy_cycles_settings"
    bl_label = "Copy from Cycles"
    bl_description = "Copy Clamping, Filter Glossy and Reflective Caustics from the scene's Cycles settings"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context):
        if hasattr(context.scene, "cycles"):
            return True
        cls.poll_message_set("Cycles is not enabled")
        return False

    def execute(self, context):
        cycles, settings = context.scene.cycles, context.scene.velour
        for name, copied in COPIED.values():
            setattr(settings, copied, getattr(cycles, name))
        self.report({"INFO"}, "Copied Clamping, Filter Glossy and Reflective Caustics.")
        return {"FINISHED"}
