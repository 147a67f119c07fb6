"""Another image chosen in a measured node, of which Blender tells no material: the node is not linked."""

import bpy

from ..export.nodes import velour_node

_owner = object()
_chosen = {}  # names of images by names of materials


def attach():
    bpy.app.handlers.load_post.append(_listen)
    _listen()


def detach():
    bpy.app.handlers.load_post.remove(_listen)
    bpy.msgbus.clear_by_owner(_owner)


@bpy.app.handlers.persistent
def _listen(*_arguments):
    """Anew in each file: what listens is left behind in the last one."""
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
