"""Placement of tiles and anisotropy on objects."""

import bpy

from ..export.nodes import velour_node
from ..export.uv_maps import linked_uv_map
from ..operators.placement import VELOUR_OT_keep_uv_density
from .material_panel import MaterialPanel, draw_input
from .model_panel import draw_rows
from .placement_summary import measured
from .summaries import model_summary
from .text import draw_sentence


class VELOUR_MATERIAL_PT_placement(MaterialPanel, bpy.types.Panel):
    bl_label = "Placement"
    bl_parent_id = "VELOUR_MATERIAL_PT_measured"

    @classmethod
    def poll(cls, context):
        info = _info(context)
        return _has_tiles(info) or not info.get("isotropic", True)

    def draw(self, context):
        layout, info = self.layout, _info(context)
        layout.use_property_split = True
        layout.use_property_decorate = False
        node = velour_node(context.material)
        settings = node.velour.placement
        if _has_tiles(info):
            layout.row().prop(settings, "mode", expand=True)
            if settings.mode == "REPEATS":
                layout.column().prop(settings, "repeats")
            else:
                _draw_real_size(layout, settings, info.get("tile_metres"), context.object)
        linked = linked_uv_map(node)
        _draw_uv_map(layout, settings if linked is None else linked, context.object)
        if node.group is not None and "Rotation" in node.group.inputs:
            draw_input(layout, node.group.inputs["Rotation"])
        if _has_tiles(info):
            layout.column().prop(settings, "offset")
            layout.prop(settings, settings.scale_property)
        if context.object is not None:
            report = measured(context, context.material)
            _draw_report(context, layout, report and report.placement)


def _info(context):
    """Info of the active material's model; empty if there is none yet."""
    node = velour_node(context.material)
    info = model_summary(node.image) if node is not None and node.image is not None else None
    return info if isinstance(info, dict) else {}


def _has_tiles(info):
    return "texels" in info or "shell" in info


def _draw_uv_map(layout, owner, obj):
    """Draws the UV map of the placement or of a UV Map node, with a search field for meshes."""
    if obj is not None and obj.type == "MESH":
        layout.prop_search(owner, "uv_map", obj.data, "uv_layers", icon="GROUP_UVS", text="UV Map")
    else:
        layout.prop(owner, "uv_map", text="UV Map")


def _draw_real_size(layout, settings, own_metres, obj):
    column = layout.column()
    column.prop(settings, "tile_size", text="Tile Size (mm)")
    if min(settings.tile_size) == 0:
        icon, text = ("ERROR", "Unknown; enter the tile size")
        if own_metres:
            icon, text = (
                "INFO",
                "From the BTF: {:.4g} x {:.4g} mm".format(*(1e3 * side for side in own_metres)),
            )
        column.label(text=text, icon=icon)
    column = layout.column()
    column.prop(settings, "uv_density", text="UV Density (1/m)")
    if obj is not None:  # the operator reads its density
        column.operator(VELOUR_OT_keep_uv_density.bl_idname, icon="PINNED")


def _draw_report(context, layout, report):
    if report is None:
        layout.label(text="Measuring...", icon="TIME")
        return
    if not report.rows and not report.warnings:
        return
    box = layout.box()
    box.label(text=f"On '{context.object.name}'")
    draw_rows(box, report.rows)
    for sentence in report.warnings:
        draw_sentence(context, layout, sentence, icon="ERROR")
