"""Tiles of mesostructure: the steps from a tile to its material on an object, and their settings."""

import bpy

from ..core.capture_size import capture_bytes, pairs_bytes
from ..core.sizes import data_size
from ..export.nodes import velour_node
from ..export.objects import GEOMETRY
from ..operators.add_votf import VELOUR_OT_add_votf
from ..operators.apply_material import VELOUR_OT_apply_material
from ..operators.capture_btf import VELOUR_OT_capture_btf
from ..operators.estimate_capture import VELOUR_OT_estimate_capture
from ..operators.estimate_fit import captured_and_fitted_as
from ..operators.repeat_tile import VELOUR_OT_repeat_tile, is_repeated
from ..operators.tiles import captured_as, is_temporary
from .draw_btf_fit import ESTIMATE, draw_fit_buttons, draw_fit_settings
from .draw_plot import draw_chosen, draw_plot
from .progress import draw_progress
from .properties_panel import PropertiesPanel
from .summaries import model_summary
from .text import draw_sentence
from .tile_steps import steps

_TEMPORARY = (  # of a file that is not saved; of a file that has been saved since
    "Temporary: deleted with this unsaved file. To keep it, save the file first, or choose a Folder.",
    "Temporary: deleted when this file is closed. Capture again to keep it.",
)


class TilePanel(PropertiesPanel):
    """Mixin for a panel of the object or the collection that is a tile; a tab gives it `_owner`."""

    @classmethod
    def poll(cls, context):
        return super().poll(context) and cls._owner(context) is not None

    def draw(self, context):
        layout, owner = self.layout, self._owner(context)
        layout.use_property_split = True
        layout.use_property_decorate = False
        name = "" if isinstance(owner, bpy.types.Object) else owner.name
        self._draw(context, layout, owner, name)


class StepsPanel(TilePanel):
    bl_label = "Mesostructure"

    def _draw(self, context, layout, owner, collection):
        """`collection`: name of the collection that is the tile; empty: the active object."""
        found = steps(context, owner)
        column = _step(layout, "1. Tile", found.tile)
        column.column().prop(owner.velour, "period")
        text = "Hide Repeats" if is_repeated(owner) else "Show Repeats"
        column.operator(VELOUR_OT_repeat_tile.bl_idname, text=text).collection = collection
        _draw_capture(context, _step(layout, "2. Capture", found.capture), owner, collection)
        key, button = captured_and_fitted_as(owner), ("Make Material", "NONE")
        column = _step(layout, "3. Material", found.material)
        draw_fit_buttons(context, column, key, button, collection=collection)
        column = _step(layout, "4. Silhouette", found.outline)
        _draw_outline(column.operator(VELOUR_OT_add_votf.bl_idname, icon="MESH_GRID"), owner, collection)
        column = _step(layout, "5. Object", found.application)
        column.prop(owner.velour, "target")
        column.operator(VELOUR_OT_apply_material.bl_idname, icon="CHECKMARK").collection = collection
        draw_progress(context, layout)


def _step(layout, title, step):
    """Draws the title of a step; returns the layout of its buttons, gray while the step has to wait."""
    layout.label(text=title, icon="CHECKMARK" if step.is_done else "RADIOBUT_OFF")
    if step.reason:
        layout.label(text=step.reason, icon="INFO")
    column = layout.column()
    column.enabled = not step.reason
    return column


def _draw_capture(context, layout, owner, collection):
    layout.label(text=_size(owner.velour), icon="DISK_DRIVE")
    if is_temporary(owner):
        draw_sentence(context, layout, _TEMPORARY[bool(bpy.data.filepath)], icon="INFO")
    state = context.window_manager.velour
    if state.estimate and state.estimated == captured_as(owner):
        draw_sentence(context, layout, state.estimate, icon="TIME")
    row = layout.split(factor=ESTIMATE)
    row.operator(VELOUR_OT_estimate_capture.bl_idname).collection = collection
    row = row.row(align=True)
    row.operator(VELOUR_OT_capture_btf.bl_idname, icon="PLAY").collection = collection
    again = row.operator(VELOUR_OT_capture_btf.bl_idname, text="", icon="NEWFOLDER")
    again.collection, again.new_folder = collection, True


def _draw_outline(button, owner, collection):
    """Sets the arguments of Add Silhouette."""
    material = owner.velour.material
    button.material = material.name if material is not None else ""
    button.collection, button.structure = collection, "" if collection else owner.name


class CaptureSettingsPanel(TilePanel):
    bl_label = "Capture Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def _draw(self, _context, layout, owner, _collection):
        column = layout.column(align=True)
        for name in ("directory", "texels", "views", "lights", "samples", "bounces", "sides", "held_out"):
            column.prop(owner.velour, name)
        column.prop(owner.velour, "use_approximate")


class FitSettingsPanel(TilePanel):
    bl_label = "Fit Settings"
    bl_options = {"DEFAULT_CLOSED"}

    def _draw(self, context, layout, owner, _collection):
        """Also draws the size and the error of the last fit."""
        draw_fit_settings(layout, owner.velour)
        node = velour_node(owner.velour.material) if owner.velour.material is not None else None
        info = model_summary(node.image) if node is not None and node.image is not None else None
        if isinstance(info, dict) and "texels" in info:
            draw_plot(context, layout, node.image, None, "ORDER")
            draw_chosen(layout, info)


class ObjectTab:
    bl_context = "object"

    @staticmethod
    def _owner(context):
        """The object that is a tile, or None."""
        obj = context.object
        return obj if obj is not None and obj.type in GEOMETRY and obj.velour.is_shown() else None


class CollectionTab:
    bl_context = "collection"

    @staticmethod
    def _owner(context):
        """The collection that is a tile, or None."""
        collection = context.collection
        is_one = collection is not None and collection != context.scene.collection
        return collection if is_one and collection.velour.is_shown() else None


class VELOUR_OBJECT_PT_tile(ObjectTab, StepsPanel, bpy.types.Panel):
    pass


class VELOUR_OBJECT_PT_tile_capture(ObjectTab, CaptureSettingsPanel, bpy.types.Panel):
    bl_parent_id = "VELOUR_OBJECT_PT_tile"


class VELOUR_OBJECT_PT_tile_fit(ObjectTab, FitSettingsPanel, bpy.types.Panel):
    bl_parent_id = "VELOUR_OBJECT_PT_tile"


class VELOUR_COLLECTION_PT_tile(CollectionTab, StepsPanel, bpy.types.Panel):
    pass


class VELOUR_COLLECTION_PT_tile_capture(CollectionTab, CaptureSettingsPanel, bpy.types.Panel):
    bl_parent_id = "VELOUR_COLLECTION_PT_tile"


class VELOUR_COLLECTION_PT_tile_fit(CollectionTab, FitSettingsPanel, bpy.types.Panel):
    bl_parent_id = "VELOUR_COLLECTION_PT_tile"


CLASSES = (
    VELOUR_OBJECT_PT_tile,
    VELOUR_OBJECT_PT_tile_capture,
    VELOUR_OBJECT_PT_tile_fit,
    VELOUR_COLLECTION_PT_tile,
    VELOUR_COLLECTION_PT_tile_capture,
    VELOUR_COLLECTION_PT_tile_fit,
)


def _size(settings):
    """Size of the capture with held-out pairs; two sides have all four pairs of hemispheres."""
    front, pairs = capture_bytes(settings), pairs_bytes(settings)
    one, both = data_size(front + pairs), data_size(4 * front + pairs)
    return {"ONE": one, "TWO": both, "AUTOMATIC": f"{one}, or {both} with holes"}[settings.sides]
