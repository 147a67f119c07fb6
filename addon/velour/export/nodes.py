"""Lookups in Blender's node trees."""

import bpy


class MeasuredNode:
    """Node of a material that renders a measured model: a group node whose tree contains the model.

    Files of the former layout have the model and all settings in a node of the material itself, which renders
    whether it is linked or not.
    """

    __slots__ = ("group", "texture")

    def __init__(self, texture, group=None):
        self.texture = (
            texture  # Image Texture node: its image is the model, its `velour` the model's settings
        )
        self.group = group  # group node: its inputs are the look; None: the former layout

    def __eq__(self, other):
        return isinstance(other, MeasuredNode) and (self.texture, self.group) == (other.texture, other.group)

    def __hash__(self):
        return hash((self.texture, self.group))

    @property
    def node(self):
        """The node of the material."""
        return self.group or self.texture

    @property
    def name(self):
        return self.node.name

    @property
    def velour(self):
        """VelourMaterialSettings of the material: fit, placement, VOTF and scene model."""
        return self.node.velour

    @property
    def neighbors(self):
        return self.texture.velour.neighbors

    @property
    def image(self):
        """The image that stands for the model's file, or None."""
        return self.texture.image

    @image.setter
    def image(self, image):
        self.texture.image = image


def velour_node(material):
    """The MeasuredNode of a material, or None; the active one if there are several."""
    found = all_measured(material)
    active = material.node_tree.nodes.active if found else None
    return next((node for node in found if node.node == active), found[0] if found else None)


def former_node(material):
    """The MeasuredNode of a material of the former layout, or None."""
    texture = model_texture(material.node_tree) if material and material.node_tree else None
    return MeasuredNode(texture) if texture is not None else None


def all_nodes(tree, seen=None):
    """The nodes of a tree and of the groups in it, each group once."""
    seen = set() if seen is None else seen
    for node in tree.nodes:
        yield node
        group = getattr(node, "node_tree", None)
        if group and group.as_pointer() not in seen:  # a broken file may nest a group in itself
            seen.add(group.as_pointer())
            yield from all_nodes(group, seen)


def measured_nodes(tree, seen=None):
    """The MeasuredNodes of a tree and of the groups in it, each once."""
    seen = set() if seen is None else seen
    for node in tree.nodes:
        group = node.node_tree if node.bl_idname == "ShaderNodeGroup" else None
        texture = model_texture(group) if group else None
        if texture is not None:
            yield MeasuredNode(texture, node)
        elif group and group.as_pointer() not in seen:  # a broken file may nest a group in itself
            seen.add(group.as_pointer())
            yield from measured_nodes(group, seen)


def all_measured(material):
    """The MeasuredNodes of a material, or of None."""
    tree = material.node_tree if material else None
    if tree is None:
        return []
    former = former_node(material)
    return [former] if former else list(measured_nodes(tree))


def model_names(material):
    """Names of the images of all measured models of a material."""
    return tuple(node.image.name_full for node in all_measured(material) if node.image)


def nodes_of(tree):
    """The group nodes that use a node tree."""
    materials = (material.node_tree for material in bpy.data.materials)
    return [
        node
        for user in (*materials, *bpy.data.node_groups)
        for node in (user.nodes if user else ())
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree == tree
    ]


def model_texture(tree):
    """The Image Texture node of a tree that contains a measured model, or None; the active one if there are
    several."""
    found = [node for node in tree.nodes if is_model_texture(node)]
    if tree.nodes.active in found:
        return tree.nodes.active
    return found[0] if found else None


def is_model_texture(node):
    """Whether a node contains a measured model."""
    return node.bl_idname == "ShaderNodeTexImage" and node.velour.enabled


def approximation_node(material):
    """The group node that approximates a measured material without Velour, or None."""
    measured = velour_node(material)
    if measured is None or measured.group is not None:
        return measured and measured.group
    for node in material.node_tree.nodes:
        if node.bl_idname == "ShaderNodeGroup" and node.node_tree and node.node_tree.velour.is_approximation:
            return node
    return None


def active_output(tree, idname):
    """The output node that Cycles renders, or None: its own before that of all engines, and the active one of
    these."""
    order = ("CYCLES", "ALL")
    outputs = [node for node in tree.nodes if node.bl_idname == idname and node.target in order]
    return min(outputs, key=lambda node: (order.index(node.target), not node.is_active_output), default=None)


def link_to(socket):
    """The link whose value an input socket takes, or None.

    Links stay in a tree when they are muted, close a cycle, or a node's settings hide a socket at their ends.
    """
    link = socket.links[0] if socket.is_linked and socket.links else None
    if link is None or link.is_muted or not link.is_valid:
        return None
    return link if link.from_socket.enabled and link.to_socket.enabled else None


def output(socket):
    """The output socket that feeds an input socket, through reroutes; None if its own value applies."""
    while link := link_to(socket):
        if link.from_node.bl_idname != "NodeReroute":
            return link.from_socket
        socket = link.from_node.inputs[0]
    return None


def source(socket):
    """The node of that output socket, or None."""
    found = output(socket)
    return found.node if found else None


def first_input(node, *names):
    """The first input socket with one of these names (Blender renames them between versions), or None.

    Inputs that the node's settings hide count as well: since 4.1, look-ups by name leave them out.
    """
    for name in names:
        found = node.inputs.get(name) or next((each for each in node.inputs if each.name == name), None)
        if found is not None:
            return found
    return None
