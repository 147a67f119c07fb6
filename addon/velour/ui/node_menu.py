"""Adds the shaders that Velour supports to the Add menu of a material's nodes.

Blender 3.4 offers them only to EEVEE and Cycles. Menus of 4.0 and newer check for no engine but EEVEE.
"""

import bpy

try:
    import nodeitems_utils
except ImportError:  # used by older menus; the newest tested Blender still has it
    nodeitems_utils = None

from ..engine.engine import VelourRenderEngine
from ..export.shaders.readers import READERS

_RENDERED = {"ShaderNodeOutputMaterial", "ShaderNodeMixShader", "ShaderNodeAddShader", *READERS}

_opened = []  # menu entries with their original poll functions


def open_to_engine():
    for item in _items():
        _opened.append((item, item.poll))
        item.poll = _or_velour(item.poll)


def close_to_engine():
    for item, poll in _opened:
        item.poll = poll
    _opened.clear()


def _items():
    categories, *_ = getattr(nodeitems_utils, "_node_categories", {}).get("SHADER", ((),))
    for category in categories:
        for item in category.items(None):
            if getattr(item, "nodetype", None) in _RENDERED and item.poll is not None:
                yield item


def _or_velour(poll):
    return lambda context: (
        poll(context)
        or (
            context.engine == VelourRenderEngine.bl_idname
            and isinstance(context.space_data.id, bpy.types.Material)
        )
    )
