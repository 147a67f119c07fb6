"""What Blender's own panels lack of objects with Velour: lamps, and which rays an object is hidden from.

The stock panels of lamps belong to EEVEE, whose factors Velour does not read, and ray visibility to Cycles.
"""

import bpy

from ..engine.engine import VelourRenderEngine
from ..export.objects import GEOMETRY
from .text import draw_sentence

_NEWER_POWER = ("exposure", "normalize")  # 4.5 and newer


class _ObjectPanel:
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {VelourRenderEngine.bl_idname}


class VELOUR_LIGHT_PT_light(_ObjectPanel, bpy.types.Panel):
    bl_label = "Light"
    bl_context = "data"

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES and context.light is not None

    def draw(self, context):
        layout, light = self.layout, context.light
        layout.row().prop(light, "type", expand=True)
        layout.use_property_split = True
        column = layout.column()
        if hasattr(light, "use_temperature"):
            row = column.row(heading="Temperature", align=True)
            row.prop(light, "use_temperature", text="")
            value = row.row()
            value.active = light.use_temperature
            value.prop(light, "temperature", text="")
        column.prop(light, "color")
        column.prop(light, "energy", text="Strength" if light.type == "SUN" else "Power")
        for name in _NEWER_POWER:
            if hasattr(light, name):
                column.prop(light, name)
        _draw_size(layout.column(), light)
        if hasattr(light, "use_shadow"):
            layout.column().prop(light, "use_shadow", text="Cast Shadow")


def _draw_size(column, light):
    if light.type == "SUN":
        column.prop(light, "angle")
    elif light.type == "AREA":
        column.prop(light, "shape")
        is_even = light.shape in ("SQUARE", "DISK")
        column.prop(light, "size", text="Size" if is_even else "Size X")
        if not is_even:
            column.prop(light, "size_y", text="Y")
        column.prop(light, "spread")
    else:
        column.prop(light, "shadow_soft_size", text="Radius")
        if hasattr(light, "use_soft_falloff"):
            column.prop(light, "use_soft_falloff")


class VELOUR_OBJECT_PT_ray_visibility(_ObjectPanel, bpy.types.Panel):
    bl_label = "Ray Visibility"
    bl_context = "object"
    bl_parent_id = "OBJECT_PT_visibility"

    @classmethod
    def poll(cls, context):
        obj = context.object
        return context.engine in cls.COMPAT_ENGINES and obj is not None and obj.type in GEOMETRY

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
                context, layout, "Velour hides objects from diffuse and glossy rays together.", icon="INFO"
            )
