"""Blender's own panels that also make sense for Velour."""

import bpy

from ..engine.engine import VelourRenderEngine

_ENGINE = VelourRenderEngine.bl_idname

# Panels that list BLENDER_RENDER but whose settings Velour does not read.
_EXCLUDED = {
    "RENDER_PT_freestyle",
    "RENDER_PT_gpencil",
    "RENDER_PT_simplify_greasepencil",
    "RENDER_PT_stereoscopy",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_freestyle",
    "VIEWLAYER_PT_freestyle_edge_detection",
    "VIEWLAYER_PT_freestyle_linesets",
    "VIEWLAYER_PT_freestyle_lineset_collection",
    "VIEWLAYER_PT_freestyle_lineset_edgetype",
    "VIEWLAYER_PT_freestyle_lineset_facemarks",
    "VIEWLAYER_PT_freestyle_lineset_visibilty",
    "VIEWLAYER_PT_freestyle_linestyle",
    "VIEWLAYER_PT_layer_passes",
    "MATERIAL_PT_freestyle",
    "DATA_PT_light",  # Velour's own shows more
}
# Panels of other engines that suit Velour as they are.
_BORROWED = {
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_WORLD_PT_surface",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "WORLD_PT_context_world",
}


_opened = []  # Velour's own panels are none of them, and stay what they are


def open_to_engine():
    _opened.extend(_panels())
    for panel in _opened:
        panel.COMPAT_ENGINES.add(_ENGINE)


def close_to_engine():
    for panel in _opened:
        panel.COMPAT_ENGINES.discard(_ENGINE)
    _opened.clear()


def _panels():
    for panel in bpy.types.Panel.__subclasses__():
        engines = getattr(panel, "COMPAT_ENGINES", ())
        # Those of node editors share their engines with the one that they were made of.
        name = panel.__name__.removeprefix("NODE_")
        if name in _BORROWED or ("BLENDER_RENDER" in engines and name not in _EXCLUDED):
            yield panel
