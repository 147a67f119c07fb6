"""Passes of a view layer, and mist, in the Properties editor, in Cycles' order and words."""

import bpy

from ..export.layer_passes import CRYPTOMATTES
from .layer_panels import LayerPanel


class VELOUR_VIEWLAYER_PT_passes(LayerPanel, bpy.types.Panel):
    bl_label = "Passes"

    def draw(self, context):
        pass


class VELOUR_VIEWLAYER_PT_passes_data(LayerPanel, bpy.types.Panel):
    bl_label = "Data"
    bl_parent_id = "VELOUR_VIEWLAYER_PT_passes"

    def draw(self, context):
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        layout.use_property_decorate = False
        self._include(layout, layer)
        column = layout.column(heading="Indexes", align=True)
        column.prop(layer, "use_pass_object_index")
        column.prop(layer, "use_pass_material_index")
        column = layout.column(heading="Debug", align=True)
        column.prop(layer.velour, "use_pass_sample_count")
        column.prop(layer.velour, "use_pass_error")

    def _include(self, layout, layer):
        column = layout.column(heading="Include", align=True)
        for name in ("combined", "z", "mist", "position", "normal", "vector", "uv"):
            column.prop(layer, f"use_pass_{name}")
        column.prop(layer.velour, "use_pass_albedo")
        column.prop(layer.velour, "use_pass_denoising")


class VELOUR_VIEWLAYER_PT_passes_cryptomatte(LayerPanel, bpy.types.Panel):
    bl_label = "Cryptomatte"
    bl_parent_id = "VELOUR_VIEWLAYER_PT_passes"

    def draw(self, context):
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        layout.use_property_decorate = False
        switches = {f"use_pass_cryptomatte_{kind}": kind.title() for kind in CRYPTOMATTES}
        column = layout.column()
        for switch, text in switches.items():
            column.prop(layer, switch, text=text)
        column = layout.column()
        column.active = any(getattr(layer, switch) for switch in switches)
        column.prop(layer, "pass_cryptomatte_depth", text="Levels")


class VELOUR_WORLD_PT_mist(LayerPanel, bpy.types.Panel):
    bl_label = "Mist Pass"
    bl_context = "world"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        asked = any(layer.use_pass_mist for layer in context.scene.view_layers)
        return super().poll(context) and context.world is not None and asked

    def draw(self, context):
        layout, mist = self.layout, context.world.mist_settings
        layout.use_property_split = True
        column = layout.column(align=True)
        column.prop(mist, "start")
        column.prop(mist, "depth")
        layout.prop(mist, "falloff")
