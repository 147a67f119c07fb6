"""Statistics of a material's model."""

import bpy

from ..core.model_warnings import panel_warnings
from ..core.sizes import data_size
from ..export.nodes import velour_node
from ..operators.mark_asset import VELOUR_OT_mark_asset
from ..operators.save_model import VELOUR_OT_save_model
from ..properties.btf_fit_settings import METHODS
from .material_panel import MaterialPanel, draw_refusal
from .summaries import model_summary
from .text import draw_sentence, value_lines

_METHODS = {key.lower().replace("_", "-"): name for key, name, *_ in METHODS}  # as the library calls them
_NAMES = 0.4  # share of the width for the names of rows


class VELOUR_MATERIAL_PT_model(MaterialPanel, bpy.types.Panel):
    bl_label = "Model"
    bl_parent_id = "VELOUR_MATERIAL_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        node = velour_node(context.material)
        return node is not None and node.image is not None

    def draw(self, context):
        info = model_summary(velour_node(context.material).image)
        if info is None:
            self.layout.label(text="Reading the model...", icon="TIME")
            return
        if isinstance(info, str):
            draw_refusal(context, self.layout, velour_node(context.material).image, info)
            return
        if "texels" in info:
            draw_rows(self.layout, _btf_rows(info))
        else:
            _draw_numbers(self.layout, info)
        for sentence in panel_warnings(info):
            draw_sentence(context, self.layout, sentence, icon="INFO")
        self.layout.operator(VELOUR_OT_save_model.bl_idname, icon="EXPORT")
        self.layout.operator(VELOUR_OT_mark_asset.bl_idname, icon="ASSET_MANAGER")


def _draw_numbers(layout, info):
    rows = (
        ("Source", info["source"]["name"]),
        ("Model", {"scattered": "Per-View"}.get(info["model"], info["model"].capitalize())),
        ("Lobes", _lobes(info)),
        ("Size", data_size(info["bytes"])),
        ("Relative error", _number(info["relative_l2"])),
        ("Max albedo", _number(info["albedo_max"])),
        ("Reciprocity error", _number(info["reciprocity"])),
    )
    draw_rows(layout, rows)
    draw_error_by_angle(layout.box(), info["by_view_angle"])


def _btf_rows(info):
    unseen, tile = info["psnr_held_out"], info["tile_metres"]
    return (
        ("Source", info["source"]["name"]),
        ("Model", f"BTF, {_METHODS.get(info['method'], info['method'])}"),
        ("Texels", "{} x {}".format(*info["texels"])),
        ("Tile", "unknown size" if tile is None else "{:.4g} x {:.4g} mm".format(*(1e3 * t for t in tile))),
        ("Directions", f"{info['views']} views, {info['lights']} lights"),
        *_btf_terms(info),
        ("Size", f"{data_size(info['bytes'])}, 1:{info['raw_bytes'] / info['bytes']:.0f}"),
        ("PSNR", f"{info['psnr']:.1f} dB"),
        ("Error", _relative_error(info["relative_l2"])),
        ("Held-out pairs", "not measured" if unseen is None else f"{unseen:.1f} dB"),
    )


def _btf_terms(info):
    """Rows on the terms of a texel, and on the sides of the surface."""
    if "components" in info:
        return (("Components", str(info["components"])),)
    first = _lobe_terms(info) if "lobes" in info else _cluster_terms(info["sides"][0])
    return (
        *first,
        *(("Side", _side_text(side, info["sides"])) for side in info["sides"]),
    )


def _lobe_terms(info):
    return (("Lobes", f"{info['lobes']}, {info['coefficients']} coefficients per texel"),)


def _cluster_terms(side):
    """Rows for clustered tensors. `side`: the first one, which is above if there is such a side."""
    ranks, members = side["ranks"], side["members"]
    return (
        ("Clusters", f"{side['clusters']}, {members} per texel"),
        (
            "Ranks",
            f"texel {ranks['texel']}, view {ranks['view']}, light {ranks['light']}, color {ranks['color']}",
        ),
    )


def _side_text(side, sides):
    """Directions from which the side is seen and lit, and its memory."""
    if side["as"] is not None:
        return f"{_side_name(side)}: same as {_side_name(sides[side['as']])}, no extra memory"
    return f"{_side_name(side)}: {data_size(side['parameter_bytes'])} in memory"


def _side_name(side):
    seen, lit = ({"above": "front", "below": "back"}[side[key]] for key in ("view", "light"))
    return seen if seen == lit else f"{seen} lit from the {lit}"


def _relative_error(error):
    return "not measured" if error is None else f"{error:.3g}, relative"


def draw_rows(layout, rows):
    """Draws names on the left, values on the right, which are wrapped."""
    split = layout.split(factor=_NAMES)
    names, values = split.column(align=True), split.column(align=True)
    names.alignment = "RIGHT"
    for name, value in rows:
        for number, line in enumerate(value_lines(bpy.context, value, 1 - _NAMES)):
            names.label(text="" if number else name)
            values.label(text=line)


def _lobes(info):
    if info["model"] == "scattered":
        return f"{info['lobes']} over {info['views']} views"
    return f"{info['lobes']} for all views"


def draw_error_by_angle(box, errors):
    box.label(text="Error by view angle")
    row = box.row(align=True)
    for angle, error in errors.items():
        column = row.column(align=True)
        column.alignment = "CENTER"
        column.label(text=f"{angle}\N{DEGREE SIGN}")
        column.label(text=_number(error))


def _number(value):
    return "not covered" if value is None else f"{value:.3g}"
