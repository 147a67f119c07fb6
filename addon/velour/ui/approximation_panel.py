"""Panel of a measured material's approximation for other programs, and its error."""

import bpy

from ..core.sizes import percent
from ..export.nodes import approximation_node, velour_node
from ..operators.approximate import VELOUR_OT_approximate
from ..operators.approximation_group import mismatch
from ..operators.approximation_image import images_of
from ..operators.displace import VELOUR_OT_displace
from ..properties.approximation_state import VIEW_ANGLES
from .material_panel import MaterialPanel
from .model_panel import VELOUR_MATERIAL_PT_model, draw_error_by_angle
from .summaries import model_summary
from .text import draw_sentence


class VELOUR_MATERIAL_PT_approximation(MaterialPanel, bpy.types.Panel):
    bl_label = "Approximation"
    bl_parent_id = "VELOUR_MATERIAL_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        return VELOUR_MATERIAL_PT_model.poll(context)

    def draw(self, context):
        layout, group = self.layout, approximation_node(context.material)
        if group is None:
            draw_sentence(context, layout, "EEVEE, Cycles and Solid mode show this material's own shader.")
            layout.operator(VELOUR_OT_approximate.bl_idname, icon="NODE_MATERIAL")
            return
        state = group.node_tree.velour
        if state.relative_l2 >= 0.0:
            layout.label(text=f"In Cycles and EEVEE: {percent(state.relative_l2)} off")
            if state.reason:
                draw_sentence(context, layout, state.reason)
            errors = (error if error >= 0.0 else None for error in state.by_view_angle)
            draw_error_by_angle(layout.box(), dict(zip(VIEW_ANGLES, errors, strict=True)))
        digest = _digest(velour_node(context.material).image)
        is_other = digest and digest != state.model
        wrong = "The approximation is of another model." if is_other else mismatch(group.node_tree)
        if wrong:
            draw_sentence(context, layout, f"{wrong} Press Refresh.", icon="ERROR")
        layout.operator(VELOUR_OT_approximate.bl_idname, text="Refresh", icon="FILE_REFRESH")
        is_on = state.displaces
        if is_on or images_of(group.node_tree).height is not None:
            button = layout.operator(VELOUR_OT_displace.bl_idname, icon="MOD_DISPLACE", depress=is_on)
            button.enable = not is_on


def _digest(image):
    """SHA-256 of a model's file, even if none is expected of it; "" until it is read."""
    info = model_summary(image)
    return info["file_sha256"] if isinstance(info, dict) else image.velour.sha256
