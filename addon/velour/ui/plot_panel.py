"""The plots of a material's model."""

import bpy

from ..export.nodes import velour_node
from ..operators.compare import VELOUR_OT_compare, comparison_name, find_comparison
from ..operators.model_plots import measurement_for
from ..operators.shown_image import find_made
from ..properties.plot_settings import PLOTS
from .draw_plot import draw_chosen, draw_plot, draw_plot_buttons
from .material_panel import MaterialPanel
from .summaries import model_summary
from .text import draw_sentence

_COMPARISON_UNITS = 10.0  # height in buttons


class VELOUR_MATERIAL_PT_plots(MaterialPanel, bpy.types.Panel):
    bl_label = "Plots"
    bl_parent_id = "VELOUR_MATERIAL_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        node = velour_node(context.material)
        return node is not None and node.image is not None and isinstance(model_summary(node.image), dict)

    def draw(self, context):
        layout, node = self.layout, velour_node(context.material)
        info = model_summary(node.image)
        settings = context.window_manager.velour.plot
        kind = settings.kind
        if "texels" in info:
            kind = "ORDER"  # the only plot of a BTF
        else:
            row = layout.row(align=True)
            for item in PLOTS:
                if item[0] != "OUTLINE":  # drawn in the silhouette's panel
                    row.prop_enum(settings, "kind", item[0])
            _draw_view(layout, settings, info)
        draw_plot(context, layout, node.image, measurement_for(kind, node.velour), kind)
        if kind == "ORDER":
            draw_chosen(layout, info)
        draw_plot_buttons(layout, kind, settings)
        if node.velour.measurement is not None:
            _draw_comparison(context, layout, node)


def _draw_comparison(context, layout, node):
    """Draws measurement and model above their difference, if they are the current ones."""
    image = find_comparison(node)
    if image is not None and image.preview is not None:
        layout.template_icon(image.preview.icon_id, scale=_COMPARISON_UNITS)
    elif find_made(comparison_name(context.material.name)) is not None:
        sentence = "The last comparison shows another model or measurement. Compare again."
        draw_sentence(context, layout, sentence, icon="INFO")
    layout.operator(VELOUR_OT_compare.bl_idname)


def _draw_view(layout, settings, info):
    row = layout.row(align=True)
    if settings.kind == "LOBES":
        row.prop(settings, "view")
    if settings.kind in ("LOBES", "ALBEDO") and not info["isotropic"]:
        row.prop(settings, "azimuth")
