"""Blender's own panels that also apply to Velour."""

import bpy

from ..engine.engine import VelourRenderEngine

_ENGINE = VelourRenderEngine.bl_idname

# Panels that list BLENDER_RENDER but whose settings Velour does not read; their children go with them.
_EXCLUDED = {
    "OBJECT_PT_shading",  # light linking, 4.0 and newer
    "RENDER_PT_gpencil",
    "RENDER_PT_simplify",  # Velour's own is below Sampling
    "RENDER_PT_simplify_greasepencil",
    "RENDER_PT_simplify_render",
    "RENDER_PT_simplify_viewport",
    "VIEWLAYER_PT_filter",
    "VIEWLAYER_PT_layer_passes",
    # Velour's own light panel shows more.
    "DATA_PT_area",
    "DATA_PT_falloff_curve",
    "DATA_PT_light",
    "DATA_PT_spot",
}
_EXCLUDED_WORDS = ("freestyle", "stereoscopy")
# Panels of other engines that Velour can use unchanged.
_BORROWED = {
    "EEVEE_MATERIAL_PT_context_material",
    "EEVEE_WORLD_PT_surface",
    "MATERIAL_PT_preview",
    "DATA_PT_camera_dof",
    "DATA_PT_camera_dof_aperture",
    "WORLD_PT_context_world",
}


_opened = []  # excludes Velour's own panels, which must not change


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
        # Panels of node editors share the set of engines with the panel that they copy.
        name = panel.__name__.removeprefix("NODE_")
        if name in _BORROWED or ("BLENDER_RENDER" in engines and not _is_excluded(name)):
            yield panel


def _is_excluded(name):
    return name in _EXCLUDED or any(word in name for word in _EXCLUDED_WORDS)
