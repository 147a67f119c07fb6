"""Settings of the fit and of the model that are rarely needed."""

import bpy

from ..export.nodes import velour_node
from ..operators.measured import is_btf
from ..operators.open_file import VELOUR_OT_open_model
from .material_panel import MaterialPanel
from .summaries import model_summary


class VELOUR_MATERIAL_PT_advanced(MaterialPanel, bpy.types.Panel):
    bl_label = "Advanced"
    bl_parent_id = "VELOUR_MATERIAL_PT_measured"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return velour_node(context.material) is not None

    def draw(self, context):
        layout, node = self.layout, velour_node(context.material)
        layout.use_property_split = True
        layout.use_property_decorate = False
        settings = node.velour
        info = model_summary(node.image) if node.image is not None else None
        info = info if isinstance(info, dict) else {}
        measures_btf = settings.measurement is not None and is_btf(settings.measurement)
        if not measures_btf and "texels" not in info:
            _draw_fit_settings(layout.column(align=True), settings)
        layout.template_ID(node.texture, "image", open=VELOUR_OT_open_model.bl_idname, text="Model File")
        if info.get("model") == "scattered":
            layout.column().prop(node.texture.velour, "neighbors")
        column = layout.column(heading="Render")
        column.active = settings.measurement is not None
        column.prop(settings, "use_reference", text="Measurement")


def _draw_fit_settings(column, settings):
    """The settings of the kind of model that is fitted."""
    for name in ("model", "tolerance", "max_lobes"):
        column.prop(settings, name)
    if settings.model == "SCATTERED":
        column.prop(settings, "kernel")
    else:
        column.prop(settings, "use_limit_albedo")
        column.prop(settings, "use_symmetric")
    column.prop(settings, "use_all_data")
