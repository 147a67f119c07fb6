"""Panel of a material's scene model: a second, smaller model for the scene's usage of the material."""

import bpy

from ..export.nodes import velour_node
from ..operators.check_scene import VELOUR_OT_check_scene
from ..operators.fit_for_scene import VELOUR_OT_fit_for_scene
from ..operators.open_file import VELOUR_OT_open_scene_model
from ..operators.save_model import VELOUR_OT_save_model
from .material_panel import MaterialPanel, draw_refusal
from .model_panel import draw_rows
from .summaries import model_summary
from .text import draw_sentence


class VELOUR_MATERIAL_PT_scene_model(MaterialPanel, bpy.types.Panel):
    bl_label = "Scene Model"
    bl_parent_id = "VELOUR_MATERIAL_PT_advanced"
    bl_options = {"DEFAULT_CLOSED"}

    @classmethod
    def poll(cls, context):
        node = velour_node(context.material)
        return node is not None and (node.image is not None or node.velour.scene_model is not None)

    def draw(self, context):
        layout, settings = self.layout, velour_node(context.material).velour
        column = layout.column(align=True)
        column.enabled = settings.measurement is not None
        column.operator(VELOUR_OT_fit_for_scene.bl_idname, icon="PLAY")
        column.operator(VELOUR_OT_fit_for_scene.bl_idname, text="This Frame Only").current_frame = True
        if settings.scene_model is None:
            return
        layout.prop(settings, "use_scene_model")
        layout.template_ID(settings, "scene_model", open=VELOUR_OT_open_scene_model.bl_idname)
        _draw_model(context, layout, settings.scene_model)
        if settings.use_scene_model:
            _draw_served(context, layout, context.material, settings.scene_model)


def _draw_model(context, layout, image):
    info = model_summary(image)
    if info is None:
        layout.label(text="Reading the model...", icon="TIME")
        return
    if isinstance(info, str):
        draw_refusal(context, layout, image, info)
        return
    if info.get("scene") is None:
        sentence = "This model was not fitted for a scene, so all frames use it."
        draw_sentence(context, layout, sentence, icon="INFO")
        return
    draw_rows(layout, _rows(info))
    layout.operator(VELOUR_OT_save_model.bl_idname, icon="EXPORT").for_scene = True


def _draw_served(context, layout, material, image):
    """Draws whether the model was valid in the frame last checked, and the remedy if not."""
    found = context.window_manager.velour.checked.of_model(context.scene, material, image)
    for text, is_inside in dict.fromkeys((each.text, each.is_inside) for each in found):
        draw_sentence(context, layout, text, icon="CHECKMARK" if is_inside else "ERROR")
    layout.operator(VELOUR_OT_check_scene.bl_idname, icon="VIEWZOOM")


def _rows(info):
    own, full = info["parameter_bytes"], info["scene"]["full_parameter_bytes"]
    more = _rows_of_btf if "full_texels" in info["scene"] else _rows_of_brdf
    return (("Parameters", f"{own} bytes, full model {full} ({full / own:.1f} times as many)"), *more(info))


def _rows_of_brdf(info):
    scene, (begin, end) = info["scene"], info["view_range"]
    return (
        ("Image error", f"{scene['picture_error']:.3g}, full model {scene['full_picture_error']:.3g}"),
        ("Views", f"{begin:.0f} to {end:.0f}\N{DEGREE SIGN}, {_pictures(scene)}"),
    )


def _pictures(scene):
    return "1 image" if scene["frames"] == 1 else f"{scene['frames']} images"


def _rows_of_btf(info):
    scene, (width, height) = info["scene"], info["texels"]
    full_width, full_height = scene["full_texels"]
    finest = scene["surface"]["finest"] * max(full_width, full_height)
    rows = (
        ("Texels", f"{width} x {height}, full model {full_width} x {full_height}"),
        ("Pixels", f"at least {finest:.1f} texels of the full model, {_pictures(scene)}"),
    )
    if not scene["seen_views_alone"]:
        return rows
    errors = f"{scene['picture_error']:.3g}, full model {scene['full_picture_error']:.3g}"
    return (*rows, ("Image error", errors))
