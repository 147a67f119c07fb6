"""Silhouette (VOTF) of a material: parameters, estimate and statistics."""

import bpy

from ..core.sizes import data_size
from ..export.nodes import velour_node
from ..operators.add_votf import VELOUR_OT_add_votf
from ..operators.asked_outline import outlined_as
from ..operators.estimate_votf import VELOUR_OT_estimate_votf
from .draw_plot import draw_plot, draw_plot_buttons
from .material_panel import MaterialPanel
from .model_panel import VELOUR_MATERIAL_PT_model, draw_rows
from .placement_summary import measured
from .progress import draw_progress
from .summaries import model_summary
from .text import draw_sentence


class VELOUR_MATERIAL_PT_outline(MaterialPanel, bpy.types.Panel):
    bl_label = "Silhouette (VOTF)"
    bl_parent_id = "VELOUR_MATERIAL_PT_measured"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return VELOUR_MATERIAL_PT_model.poll(context)

    def draw(self, context):
        layout, node = self.layout, velour_node(context.material)
        settings = node.velour
        layout.use_property_split = True
        layout.use_property_decorate = False
        column = layout.column(align=True)
        for name in ("structure", "outline_texels"):
            column.prop(settings, name)
        state = context.window_manager.velour
        asked = outlined_as(context.material, settings.structure, settings.outline_texels)
        if state.outline_estimate and state.outline_estimated == asked:
            draw_sentence(context, layout, state.outline_estimate, icon="TIME")
        draw_progress(context, layout)
        row = layout.row()
        for operator, icon in ((VELOUR_OT_estimate_votf, "TIME"), (VELOUR_OT_add_votf, "MESH_GRID")):
            row.operator(operator.bl_idname, icon=icon)
        info = model_summary(node.image)
        if isinstance(info, dict) and "shell" in info:
            _draw_outline(context, layout, node, info["shell"])


def _draw_outline(context, layout, node, shell):
    column = layout.column(align=True)
    for name in ("outline_width", "outline_softness"):
        column.prop(node.velour, name)
    draw_rows(layout, outline_rows(shell))
    draw_plot(context, layout, node.image, None, "OUTLINE")
    draw_plot_buttons(layout, "OUTLINE", context.window_manager.velour.plot)
    _draw_outline_here(context, layout)


def _draw_outline_here(context, layout):
    report = measured(context, context.material) if context.object is not None else None
    if report is None or report.outline is None:
        return
    box = layout.box()
    box.label(text=f"On '{context.object.name}'")
    draw_rows(box, report.outline.rows)
    for sentence in report.outline.warnings:
        draw_sentence(context, layout, sentence, icon="ERROR")


def outline_rows(shell):
    wrong, (low, high) = shell["wrong"], shell["heights"]
    return (
        ("Structure", shell["source"]),
        ("In Memory", f"{data_size(shell['bytes'])}, {' x '.join(map(str, shell['points']))} points"),
        ("Height", f"{low:.3g} to {high:.3g} of the tile width"),
        ("Wrong rays", "not measured" if wrong is None else f"{wrong:.2%}"),
    )
