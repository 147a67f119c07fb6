"""Velour's operators."""

import bpy

from ..core.measurement_files import SUFFIXES
from . import approximation_look, repeat_tile, usd_hook
from .accept_file import VELOUR_OT_accept_file
from .add_material import VELOUR_OT_add_material
from .add_mesostructure import VELOUR_OT_add_mesostructure
from .add_preset import VELOUR_OT_add_preset
from .add_presets import VELOUR_OT_add_presets
from .add_votf import VELOUR_OT_add_votf
from .apply_material import VELOUR_OT_apply_material
from .approximate import VELOUR_OT_approximate
from .browse import (
    VELOUR_OT_choose_measurement,
    VELOUR_OT_make_thumbnails,
    VELOUR_OT_refresh_browser,
)
from .capture_btf import VELOUR_OT_capture_btf
from .check_scene import VELOUR_OT_check_scene
from .compare import VELOUR_OT_compare
from .compress_btf import VELOUR_OT_compress_btf
from .convert import VELOUR_OT_convert_materials
from .copy_cycles_settings import VELOUR_OT_copy_cycles_settings
from .displace import VELOUR_OT_displace
from .estimate_capture import VELOUR_OT_estimate_capture
from .estimate_fit import VELOUR_OT_estimate_fit
from .estimate_votf import VELOUR_OT_estimate_votf
from .fit import VELOUR_OT_cancel_fit, VELOUR_OT_cancel_waiting, VELOUR_OT_fit
from .fit_for_scene import VELOUR_OT_fit_for_scene
from .load_material import VELOUR_OT_load_material
from .mark_asset import VELOUR_OT_mark_asset
from .new_look import VELOUR_OT_new_look
from .open_file import VELOUR_OT_open_measurement, VELOUR_OT_open_model, VELOUR_OT_open_scene_model
from .placement import VELOUR_OT_describe_placement, VELOUR_OT_keep_uv_density
from .plots import VELOUR_OT_enlarge_plot, VELOUR_OT_save_plot
from .repeat_tile import VELOUR_OT_repeat_tile
from .sampling_preset import VELOUR_OT_sampling_preset
from .save_model import VELOUR_OT_save_model
from .use_as_tile import VELOUR_OT_use_as_tile

CLASSES = (
    VELOUR_OT_add_material,
    VELOUR_OT_load_material,
    VELOUR_OT_open_measurement,
    VELOUR_OT_open_model,
    VELOUR_OT_open_scene_model,
    VELOUR_OT_fit,
    VELOUR_OT_fit_for_scene,
    VELOUR_OT_approximate,
    VELOUR_OT_displace,
    VELOUR_OT_convert_materials,
    VELOUR_OT_cancel_fit,
    VELOUR_OT_cancel_waiting,
    VELOUR_OT_save_model,
    VELOUR_OT_save_plot,
    VELOUR_OT_enlarge_plot,
    VELOUR_OT_compare,
    VELOUR_OT_mark_asset,
    VELOUR_OT_choose_measurement,
    VELOUR_OT_make_thumbnails,
    VELOUR_OT_refresh_browser,
    VELOUR_OT_accept_file,
    VELOUR_OT_add_mesostructure,
    VELOUR_OT_add_preset,
    VELOUR_OT_add_presets,
    VELOUR_OT_new_look,
    VELOUR_OT_repeat_tile,
    VELOUR_OT_estimate_capture,
    VELOUR_OT_estimate_fit,
    VELOUR_OT_estimate_votf,
    VELOUR_OT_capture_btf,
    VELOUR_OT_compress_btf,
    VELOUR_OT_add_votf,
    VELOUR_OT_apply_material,
    VELOUR_OT_describe_placement,
    VELOUR_OT_keep_uv_density,
    VELOUR_OT_check_scene,
    VELOUR_OT_copy_cycles_settings,
    VELOUR_OT_sampling_preset,
    VELOUR_OT_use_as_tile,
)


def attach():
    approximation_look.attach()
    repeat_tile.attach()
    usd_hook.attach()
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)
    bpy.types.TOPBAR_MT_file_new.append(_draw_new)
    bpy.types.VIEW3D_MT_mesh_add.append(_draw_add_mesh)
    bpy.types.OUTLINER_MT_collection.append(_draw_collection)


def detach():
    bpy.types.OUTLINER_MT_collection.remove(_draw_collection)
    bpy.types.VIEW3D_MT_mesh_add.remove(_draw_add_mesh)
    bpy.types.TOPBAR_MT_file_new.remove(_draw_new)
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)
    usd_hook.detach()
    repeat_tile.detach()
    approximation_look.detach()


def _draw_import(menu, _context):
    menu.layout.operator(VELOUR_OT_load_material.bl_idname, text=f"Measured Material ({', '.join(SUFFIXES)})")


def _draw_new(menu, _context):
    menu.layout.separator()
    menu.layout.operator(VELOUR_OT_new_look.bl_idname, text=VELOUR_OT_new_look.bl_label, icon="MATSPHERE")


def _draw_add_mesh(menu, _context):
    menu.layout.separator()
    menu.layout.operator_menu_enum(
        VELOUR_OT_add_mesostructure.bl_idname, "type", text="Mesostructure", icon="TEXTURE"
    )


def _draw_collection(menu, context):
    menu.layout.separator()
    operator = menu.layout.operator(VELOUR_OT_use_as_tile.bl_idname, icon="TEXTURE")
    operator.collection = context.collection.name if context.collection else ""
