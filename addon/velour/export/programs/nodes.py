"""The nodes that are compiled, by idname."""

from . import color_nodes, coordinate_nodes, image_nodes, math_nodes, normal_nodes, texture_nodes

NODES = {
    **color_nodes.NODES,
    **coordinate_nodes.NODES,
    **image_nodes.NODES,
    **math_nodes.NODES,
    **normal_nodes.NODES,
    **texture_nodes.NODES,
}
