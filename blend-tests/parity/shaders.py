"""Materials made of shader nodes, pictures for them, and a roof to show them."""

import itertools

import bpy
import numpy as np

from support import scenes

from . import stage
from .case import ParityTest

# Sockets of the Principled BSDF that were renamed in 4.0.
_NEWER_NAMES = {"Specular": "Specular IOR Level", "Emission": "Emission Color"}


class Tree:
    """A material's nodes, made from the leaves up: every method returns the output to link further."""

    def __init__(self, material):
        material.use_nodes = True
        self.nodes = material.node_tree.nodes
        self.links = material.node_tree.links
        self.nodes.clear()

    def node(self, idname, output=0, settings=None, **inputs):
        """`inputs`: numbers, colors or outputs of other nodes; underscores stand for blanks."""
        node = self.nodes.new(idname)
        for name, value in (settings or {}).items():
            setattr(node, name, value)
        for name, value in inputs.items():
            name = name.replace("_", " ")
            self.set(node.inputs[name if name in node.inputs else _NEWER_NAMES[name]], value)
        return node.outputs[output]

    def set(self, socket, value):
        if isinstance(value, bpy.types.NodeSocket):
            self.links.new(value, socket)
        else:
            socket.default_value = value

    def mix(self, factor, first, second):
        node = self.nodes.new("ShaderNodeMixShader")
        for socket, value in zip(node.inputs, (factor, first, second), strict=True):
            self.set(socket, value)
        return node.outputs[0]

    def add(self, first, second):
        node = self.nodes.new("ShaderNodeAddShader")
        self.links.new(first, node.inputs[0])
        self.links.new(second, node.inputs[1])
        return node.outputs[0]

    def end(self, shader, target="ALL"):
        """`target`: the engines that use it. The last one is active."""
        output = self.nodes.new("ShaderNodeOutputMaterial")
        output.target, output.is_active_output = target, True
        self.links.new(shader, output.inputs["Surface"])

    def diffuse(self, color=(0.8, 0.8, 0.8), **inputs):
        return self.node("ShaderNodeBsdfDiffuse", Color=_rgba(color), **inputs)

    def glossy(self, roughness, color=(0.9, 0.7, 0.4), distribution="GGX", **inputs):
        settings = {"distribution": distribution}
        return self.node(
            "ShaderNodeBsdfGlossy", settings=settings, Color=_rgba(color), Roughness=roughness, **inputs
        )

    def transparent(self, color=(1, 1, 1)):
        return self.node("ShaderNodeBsdfTransparent", Color=_rgba(color))

    def emission(self, color=(0.5, 0.7, 1), strength=1.0):
        return self.node("ShaderNodeEmission", Color=_rgba(color), Strength=strength)

    def picture(self, image, output="Color", interpolation="Closest"):
        node = self.nodes.new("ShaderNodeTexImage")
        node.image, node.interpolation = image, interpolation
        return node.outputs[output]


def _rgba(color):
    return color if isinstance(color, bpy.types.NodeSocket) else (*color, 1)


def node_group(inputs, *output):
    """A group and the nodes at its ends. `inputs`: types of sockets by name; `output`: name and type."""
    group = scenes.new_group("Group", *output, inputs=inputs)
    return group, group.nodes.new("NodeGroupInput"), group.nodes.new("NodeGroupOutput")


def mapped_picture(idname, picture, coordinates):
    """A group that maps the coordinates of a picture by its inputs Turn and Size."""
    vectors = {"Turn": "NodeSocketVector", "Size": "NodeSocketVector"}
    group, given, end = node_group(vectors, "Color", "NodeSocketColor")
    mapping, texture = group.nodes.new("ShaderNodeMapping"), group.nodes.new(idname)
    texture.image = picture
    links = group.links
    links.new(group.nodes.new("ShaderNodeTexCoord").outputs[coordinates], mapping.inputs["Vector"])
    links.new(given.outputs["Turn"], mapping.inputs["Rotation"])
    links.new(given.outputs["Size"], mapping.inputs["Scale"])
    links.new(mapping.outputs[0], texture.inputs["Vector"])
    links.new(texture.outputs["Color"], end.inputs[0])
    return group


def image(seed=2, size=8, low=0.1, high=0.9, alpha=False):
    """Random texels; `alpha`: that is 0 or 1 at random."""
    made = bpy.data.images.new(f"random {seed}", size, size, alpha=True, float_buffer=True)
    random = np.random.default_rng(seed)
    pixels = random.uniform(low, high, (size, size, 4)).astype(np.float32)
    pixels[..., 3] = random.integers(0, 2, (size, size)) if alpha else 1
    made.alpha_mode = "CHANNEL_PACKED"
    made.pixels.foreach_set(pixels.ravel())
    made.pack()
    return made


class ShaderTest(ParityTest):
    """A roof over a colored ground, seen from above at an angle: camera and shadow rays meet it."""

    def setUp(self):
        super().setUp()
        stage.ground(12, 0.6)
        stage.box((-2.5, 0.5, 0), (-1.5, 1.5, 0.6), 0.3)
        self.material = bpy.data.materials.new("Roof")
        self.tree = Tree(self.material)
        corners = [(-1.5, -1.2, 1), (1.5, -1.2, 1), (1.5, 1.2, 1), (-1.5, 1.2, 1)]
        self.roof = stage.mesh(corners, [(0, 1, 2, 3)], self.material, "Roof")
        layer = self.roof.data.uv_layers.new(name="UVMap")
        layer.data.foreach_set("uv", [0, 0, 1, 0, 1, 1, 0, 1])
        stage.camera((0, -5, 6), (0.7, 0, 0), 45)
        stage.sharp_sun()
        stage.world((0.6, 0.8, 1), 0.4)


def geometry_nodes(obj, *kinds):
    """A modifier of nodes in a row, each of which takes and gives geometry; its tree and those nodes."""
    tree = bpy.data.node_groups.new("Nodes", "GeometryNodeTree")
    if hasattr(tree, "interface"):  # 4.0 and newer
        for direction in ("INPUT", "OUTPUT"):
            tree.interface.new_socket("Geometry", in_out=direction, socket_type="NodeSocketGeometry")
    else:
        tree.inputs.new("NodeSocketGeometry", "Geometry")
        tree.outputs.new("NodeSocketGeometry", "Geometry")
    nodes = [tree.nodes.new(kind) for kind in ("NodeGroupInput", *kinds, "NodeGroupOutput")]
    for node, following in itertools.pairwise(nodes):
        tree.links.new(node.outputs[0], following.inputs[0])
    obj.modifiers.new("Nodes", "NODES").node_group = tree
    return tree, nodes[1:-1]
