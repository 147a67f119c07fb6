"""View layer filter and overrides in the Properties editor, worded as in Cycles."""

import bpy

from .properties_panel import PropertiesPanel


class LayerPanel(PropertiesPanel):
    bl_context = "view_layer"


class VELOUR_VIEWLAYER_PT_filter(LayerPanel, bpy.types.Panel):
    bl_label = "Filter"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        self.layout.use_property_split = True
        self.layout.use_property_decorate = False
        self.layout.column(heading="Include").prop(context.view_layer, "use_sky", text="Environment")


class VELOUR_VIEWLAYER_PT_override(LayerPanel, bpy.types.Panel):
    bl_label = "Override"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context):
        layout, layer = self.layout, context.view_layer
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.prop(layer, "material_override", text="Material")  # the full name does not fit narrow editors
        if hasattr(layer, "world_override"):  # 4.3 and newer
            layout.prop(layer, "world_override", text="World")
        layout.prop(layer, "samples")
