"""Lighting of a rendered viewport; Blender has panels for it only with EEVEE and Cycles."""

import bpy

from ..engine.engine import VelourRenderEngine


class VELOUR_VIEW3D_PT_lighting(bpy.types.Panel):
    bl_label = "Lighting"
    bl_space_type = "VIEW_3D"
    bl_region_type = "HEADER"
    bl_parent_id = "VIEW3D_PT_shading"
    COMPAT_ENGINES = {VelourRenderEngine.bl_idname}

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES and context.space_data.shading.type == "RENDERED"

    def draw(self, context):
        layout, shading = self.layout, context.space_data.shading
        column = layout.column()
        column.prop(shading, "use_scene_lights_render")
        column.prop(shading, "use_scene_world_render")
        if not shading.use_scene_world_render:
            _draw_studio_light(layout, shading)


def _draw_studio_light(layout, shading):
    """Omits World Opacity and Blur: Velour shows the image fully opaque and sharp."""
    split = layout.split(factor=0.9)
    picture = split.column().row()
    picture.scale_y = 0.6
    picture.template_icon_view(shading, "studio_light", scale_popup=3)
    split.column().operator("preferences.studiolight_show", emboss=False, text="", icon="PREFERENCES")
    column = layout.split(factor=0.9).column()
    column.prop(shading, "studiolight_rotate_z", text="Rotation")
    column.prop(shading, "studiolight_intensity")
