"""Tags materials whose measured node gets another image; Blender does not, as the node is not linked."""

import bpy

from ..export.nodes import velour_node

_owner = object()
_chosen = {}  # {name of material: name of image}


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
        node = velour_node(material)
        if node is None:
            continue
        image = node.image.name_full if node.image else ""
        if _chosen.get(material.name_full) != image:
            _chosen[material.name_full] = image
            node.id_data.update_tag()
