"""Tags materials whose measured nodes get other images; Blender does not, as the nodes are not linked."""

import bpy

from ..export.nodes import model_names

_owner = object()
_chosen = {}  # {name of material: names of images}


def attach():
    bpy.app.handlers.load_post.append(_listen)
    _listen()


def detach():
    bpy.app.handlers.load_post.remove(_listen)
    bpy.msgbus.clear_by_owner(_owner)


@bpy.app.handlers.persistent
def _listen(*_arguments):
    """Subscribes again in each file, as loading drops subscriptions."""
    bpy.msgbus.clear_by_owner(_owner)
    _chosen.clear()
    bpy.msgbus.subscribe_rna(key=(bpy.types.ShaderNodeTexImage, "image"), owner=_owner, args=(), notify=_tell)


def _tell():
    for material in bpy.data.materials:
        images = model_names(material)
        if _chosen.get(material.name_full, ()) != images:
            _chosen[material.name_full] = images
            material.update_tag()
