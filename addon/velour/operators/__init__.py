"""What the artist can do."""

import bpy

from .accept_file import VELOUR_OT_accept_file
from .add_material import VELOUR_OT_add_material
from .fit import VELOUR_OT_cancel_fit, VELOUR_OT_fit
from .fit_for_scene import VELOUR_OT_fit_for_scene
from .load_material import VELOUR_OT_load_material
from .save_model import VELOUR_OT_save_model

CLASSES = (
    VELOUR_OT_add_material,
    VELOUR_OT_load_material,
    VELOUR_OT_fit,
    VELOUR_OT_fit_for_scene,
    VELOUR_OT_cancel_fit,
    VELOUR_OT_save_model,
    VELOUR_OT_accept_file,
)


def attach():
    bpy.types.TOPBAR_MT_file_import.append(_draw_import)


def detach():
    bpy.types.TOPBAR_MT_file_import.remove(_draw_import)


def _draw_import(menu, _context):
    menu.layout.operator(
        VELOUR_OT_load_material.bl_idname, text="Measured Material (.velour, .binary, .bsdf, .brdf)"
    )
