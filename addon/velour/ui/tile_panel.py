"""Tiles of mesostructure: period and capture."""

import bpy

from ..core.capture_size import capture_bytes, pairs_bytes
from ..core.sizes import data_size
from ..engine.engine import VelourRenderEngine
from ..export.objects import GEOMETRY
from ..operators.capture_btf import VELOUR_OT_capture_btf
from ..operators.compress_btf import VELOUR_OT_compress_btf
from ..operators.estimate_capture import VELOUR_OT_estimate_capture
from ..operators.estimate_fit import captured_and_fitted_as
from ..operators.repeat_tile import VELOUR_OT_repeat_tile, is_repeated
from ..operators.tiles import captured_as
from .draw_btf_fit import draw_btf_fit
from .draw_plot import draw_chosen, draw_plot
from .progress import draw_progress
from .summaries import model_summary
from .text import draw_sentence


class TilePanel:
    bl_label = "Mesostructure"
    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    COMPAT_ENGINES = {VelourRenderEngine.bl_idname}

    def _draw(self, context, owner, collection_name):
        layout, settings = self.layout, owner.velour
        layout.use_property_split = True
        layout.use_property_decorate = False
        layout.column().prop(settings, "period")
        text = "Hide Repeats" if is_repeated(owner) else "Show Repeats"
        layout.operator(VELOUR_OT_repeat_tile.bl_idname, text=text).collection = collection_name
        column = layout.column(align=True)
        for name in ("directory", "texels", "views", "lights", "samples", "bounces", "sides", "held_out"):
            column.prop(settings, name)
        column.prop(settings, "use_approximate")
        column.label(text=_size(settings), icon="INFO")
        state = context.window_manager.velour
        if state.estimate and state.estimated == captured_as(owner):
            draw_sentence(context, layout, state.estimate, icon="TIME")
        draw_progress(context, layout)
        row = layout.row()
        row.operator(VELOUR_OT_estimate_capture.bl_idname, icon="TIME").collection = collection_name
        row = row.row(align=True)
        row.operator(VELOUR_OT_capture_btf.bl_idname, icon="PLAY").collection = collection_name
        anew = row.operator(VELOUR_OT_capture_btf.bl_idname, text="", icon="NEWFOLDER")
        anew.collection, anew.new_folder = collection_name, True
        self._draw_material(context, layout, owner, collection_name)

    def _draw_material(self, context, layout, owner, collection_name):
        """Draws the parameters of the capture's material, and the last result."""
        settings, button = owner.velour, (VELOUR_OT_compress_btf.bl_label, "MATERIAL")
        key = captured_and_fitted_as(owner)
        draw_btf_fit(context, layout, settings, key, button, collection=collection_name)
        info = model_summary(settings.model) if settings.model is not None else None
        if isinstance(info, dict) and "texels" in info:
            draw_plot(context, layout, settings.model, None, "ORDER")
            draw_chosen(layout, info)


class VELOUR_OBJECT_PT_tile(TilePanel, bpy.types.Panel):
    bl_context = "object"

    @classmethod
    def poll(cls, context):
        obj = context.object
        is_one = obj is not None and obj.type in GEOMETRY and obj.velour.is_shown()
        return context.engine in cls.COMPAT_ENGINES and is_one

    def draw(self, context):
        self._draw(context, context.object, "")


class VELOUR_COLLECTION_PT_tile(TilePanel, bpy.types.Panel):
    bl_context = "collection"

    @classmethod
    def poll(cls, context):
        collection = context.collection
        is_one = collection is not None and collection != context.scene.collection
        is_one = is_one and collection.velour.is_shown()
        return context.engine in cls.COMPAT_ENGINES and is_one

    def draw(self, context):
        self._draw(context, context.collection, context.collection.name)


def _size(settings):
    """Size of the capture with held-out pairs; two sides have all four pairs of hemispheres."""
    front, pairs = capture_bytes(settings), pairs_bytes(settings)
    one, both = data_size(front + pairs), data_size(4 * front + pairs)
    return {"ONE": one, "TWO": both, "AUTOMATIC": f"{one}, or {both} with holes"}[settings.sides]
