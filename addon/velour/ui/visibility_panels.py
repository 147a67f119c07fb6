"""Ray visibility of objects and worlds; Blender has panels for it only with Cycles."""

import bpy

from ..export.objects import GEOMETRY
from .properties_panel import PropertiesPanel
from .text import draw_sentence


class _VisibilityPanel(PropertiesPanel):
    bl_label = "Ray Visibility"


class VELOUR_OBJECT_PT_ray_visibility(_VisibilityPanel, bpy.types.Panel):
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    @classmethod
    def poll(cls, context):
        obj = context.object
        return super().poll(context) and obj is not None and obj.type in GEOMETRY

    def draw(self, context):
        layout, obj = self.layout, context.object
        layout.use_property_split = True
        column = layout.column()
        column.prop(obj, "visible_camera", text="Camera")
        column.prop(obj, "visible_diffuse", text="Diffuse")
        column.prop(obj, "visible_glossy", text="Glossy")
        column.prop(obj, "visible_shadow", text="Shadow")
        if obj.visible_diffuse != obj.visible_glossy:
            draw_sentence(
                context,
                layout,
                "Velour can hide objects only from diffuse and glossy rays together, so this is ignored.",
                icon="INFO",
            )


class VELOUR_WORLD_PT_ray_visibility(_VisibilityPanel, bpy.types.Panel):
    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        has_switch = hasattr(context.world, "cycles_visibility")  # stored with Cycles, while it is enabled
        return super().poll(context) and has_switch

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.prop(context.world.cycles_visibility, "camera")
