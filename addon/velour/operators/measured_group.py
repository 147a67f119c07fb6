"""The node group of a measured material: its model, the inputs of its look, and nodes for other engines."""

import bpy

from ..core.approximation import UNFITTED
from ..export.nodes import MeasuredNode, active_output, model_texture, nodes_of
from . import approximation_group, group_inputs

NODE_NAME = "Velour"


def add(material):
    """Adds a group without a model to a material as its surface; returns the MeasuredNode.

    The nodes of the previous surface stay, unlinked.
    """
    if material.node_tree is None:
        material.use_nodes = True
    tree = material.node_tree
    node = tree.nodes.new("ShaderNodeGroup")
    node.name = NODE_NAME
    node.width = 200
    node.node_tree = _new_tree(material.name)
    output = active_output(tree, "ShaderNodeOutputMaterial") or tree.nodes.new("ShaderNodeOutputMaterial")
    node.location = output.location.x - node.width - 60, output.location.y
    tree.links.new(node.outputs[0], output.inputs["Surface"])
    measured = MeasuredNode(model_texture(node.node_tree), node)
    approximation_group.put(measured, material, UNFITTED)
    return measured


def _new_tree(name):
    tree = bpy.data.node_groups.new(name, "ShaderNodeTree")
    group_inputs.put_output(tree, "BSDF", "Shader")
    texture = tree.nodes.new("ShaderNodeTexImage")
    texture.name = texture.label = "Model"
    texture.location = 0, 420
    # Cycles reads the images of all nodes that are not muted, linked or not; models are not images.
    texture.mute = True
    texture.velour.enabled = True
    return tree


def make_single_user(node):
    """Gives a MeasuredNode a copy of its group, if other nodes use the group as well; returns the node."""
    if not is_shared(node):
        return node
    node.group.node_tree = node.group.node_tree.copy()
    return MeasuredNode(model_texture(node.group.node_tree), node.group)


def is_shared(node):
    """Whether other nodes use the group of a MeasuredNode as well."""
    return node.group is not None and len(nodes_of(node.group.node_tree)) > 1
