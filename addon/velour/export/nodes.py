"""Lookups in Blender's node trees."""


def velour_node(material):
    """The Image Texture node of a measured material, or None; the active one if there are several."""
    tree = material.node_tree if material else None
    if tree is None:
        return None
    found = [node for node in tree.nodes if node.bl_idname == "ShaderNodeTexImage" and node.velour.enabled]
    if tree.nodes.active in found:
        return tree.nodes.active
    return found[0] if found else None


def approximation_node(material):
    """The group node that approximates a measured material without Velour, or None."""
    for node in material.node_tree.nodes if material and material.node_tree else ():
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree and node.node_tree.velour.is_approximation:
            return node
    return None


def active_output(tree, idname):
    """The output node that Blender renders, or None."""
    outputs = [node for node in tree.nodes if node.bl_idname == idname]
    return next((node for node in outputs if node.is_active_output), outputs[0] if outputs else None)


def output(socket):
    """The output socket that feeds an input socket, through reroutes; None if it is unlinked or muted."""
    while socket.is_linked and socket.links and not socket.links[0].is_muted:
        link = socket.links[0]
        if link.from_node.bl_idname != "NodeReroute":
            return link.from_socket
        socket = link.from_node.inputs[0]
    return None


def source(socket):
    """The node of that output socket, or None."""
    found = output(socket)
    return found.node if found else None


def first_input(node, *names):
    """The first input socket with one of these names (Blender renames them between versions), or None."""
    return next((node.inputs[name] for name in names if name in node.inputs), None)
