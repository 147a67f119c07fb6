"""Motion blur; Blender has panels for it only with its own engines. Settings of Cycles are its own."""

import bpy

from ..engine.engine import VelourRenderEngine
from ..export.objects import GEOMETRY


class _MotionPanel:
    bl_label = "Motion Blur"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_options = {"DEFAULT_CLOSED"}
    COMPAT_ENGINES = {VelourRenderEngine.bl_idname}


class VELOUR_RENDER_PT_motion_blur(_MotionPanel, bpy.types.Panel):
    bl_context = "render"

    @classmethod
    def poll(cls, context):
        return context.engine in cls.COMPAT_ENGINES

    def draw_header(self, context):
        self.layout.prop(context.scene.render, "use_motion_blur", text="")

    def draw(self, context):
        layout, render = self.layout, context.scene.render
        layout.use_property_split = True
        layout.active = render.use_motion_blur
        owner = render if hasattr(render, "motion_blur_position") else getattr(context.scene, "cycles", None)
        if owner is not None:
            layout.prop(owner, "motion_blur_position", text="Position")
        layout.prop(render, "motion_blur_shutter", text="Shutter")
        layout.template_curve_mapping(render, "motion_blur_shutter_curve")


class VELOUR_OBJECT_PT_motion_blur(_MotionPanel, bpy.types.Panel):
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        obj = context.object
        blurs = obj is not None and obj.type in (*GEOMETRY, "CAMERA") and hasattr(obj, "cycles")
        return context.engine in cls.COMPAT_ENGINES and blurs

    def draw_header(self, context):
        self.layout.prop(context.object.cycles, "use_motion_blur", text="")

    def draw(self, context):
        layout, settings = self.layout, context.object.cycles
        layout.use_property_split = True
        layout.active = context.scene.render.use_motion_blur and settings.use_motion_blur
        layout.prop(settings, "motion_steps", text="Steps")
        if context.object.type != "CAMERA":
            layout.prop(settings, "use_deform_motion", text="Deformation")
