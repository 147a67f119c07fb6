"""Settings of a material outside of its nodes."""

import bpy

from ..export.notes import Notes
from ..export.shaders import as_measured, surface_layers
from .layer_panels import LayerPanel

# Settings of materials that are not one measured model alone; stored with Cycles, and available while it
# is enabled.
_OF_CYCLES = {
    "emission_sampling": "Emission Sampling",  # 3.5 and newer
    "sample_as_light": "Multiple Importance",  # before
    "use_bump_map_correction": "Bump Map Correction",  # 4.2 and newer
}


class VELOUR_MATERIAL_PT_settings(LayerPanel, bpy.types.Panel):
    bl_label = "Settings"
    bl_context = "material"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return super().poll(context) and context.material is not None

    def draw(self, context):
        layout, material = self.layout, context.material
        layout.use_property_split = True
        layout.prop(material, "pass_index")
        cycles = getattr(material, "cycles", None)
        if as_measured(surface_layers(material, Notes())) is None:
            for name, text in _OF_CYCLES.items():
                if hasattr(cycles, name):
                    layout.prop(cycles, name, text=text)
