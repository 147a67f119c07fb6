"""Squares side by side, each of which shows an output of a shader node."""

import bpy

from . import stage
from .case import ParityTest

COLUMNS, ROWS = 6, 4


class BoardTest(ParityTest):
    """Seen from above, in the dark; squares glow in the color of a node's output."""

    def setUp(self):
        super().setUp()
        camera = stage.camera((COLUMNS / 2, ROWS / 2, 5), (0, 0, 0))
        camera.data.type, camera.data.ortho_scale = "ORTHO", COLUMNS
        stage.world((0, 0, 0))

    def show(self, builds):
        """Adds squares for up to COLUMNS x ROWS functions, which get a Nodes and return an output."""
        for number, build in enumerate(builds):
            square(number, build)


class Nodes:
    """Adds nodes to a material's tree."""

    def __init__(self, tree):
        self.tree = tree

    def add(self, idname, inputs=None, **properties):
        """A node. `inputs`: values or outputs by name or number."""
        node = self.tree.nodes.new(f"ShaderNode{idname}")
        for name, value in properties.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            self.set(node, name, value)
        return node

    def set(self, node, name, value):
        socket = node.inputs[name] if isinstance(name, int) else _named(node.inputs, name)
        if isinstance(value, bpy.types.NodeSocket):
            self.tree.links.new(value, socket)
        elif isinstance(value, bpy.types.Node):
            self.tree.links.new(value.outputs[0], socket)
        else:
            socket.default_value = value

    def place(self, scale=3.0):
        """Object coordinates of the square, from -scale to scale, turned into three dimensions."""
        turned = self.add(
            "Mapping",
            {
                "Vector": self.add("TexCoord").outputs["Object"],
                "Rotation": (0.4, 0.3, 0.2),
                "Location": (0.1, 0.2, 0.3),
                "Scale": (2 * scale,) * 3,
            },
        )
        return turned.outputs[0]

    def ramp(self):
        """A number from 0 to 1 along the square."""
        return self.add("SeparateXYZ", {0: self.add("TexCoord").outputs["UV"]}).outputs["X"]

    def color(self):
        """Red and green along the square's sides."""
        apart = self.add("SeparateXYZ", {0: self.add("TexCoord").outputs["UV"]})
        return self.add("CombineXYZ", {"X": apart.outputs["X"], "Y": apart.outputs["Y"], "Z": 0.35}).outputs[
            0
        ]

    def halved(self, output):
        """Half of an output and a half: its values from -1 to 1, as a color."""
        sum_of = self.add("VectorMath", {0: output, 1: (0.5,) * 3, 2: (0.5,) * 3}, operation="MULTIPLY_ADD")
        return sum_of.outputs[0]


def square(number, build):
    """A square of the board; the object."""
    material = bpy.data.materials.new(f"Square {number}")
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    end = tree.nodes.new("ShaderNodeOutputMaterial")
    glow = tree.nodes.new("ShaderNodeEmission")
    tree.links.new(glow.outputs[0], end.inputs["Surface"])
    tree.links.new(build(Nodes(tree)), glow.inputs["Color"])
    corners = [(x, y, 0) for x, y in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))]
    made = stage.mesh(corners, [(0, 1, 2, 3)], material, f"Square {number}")
    made.location = (number % COLUMNS + 0.5, number // COLUMNS + 0.5, 0)
    layer = made.data.uv_layers.new(name="UVMap")
    layer.data.foreach_set("uv", (0, 0, 1, 0, 1, 1, 0, 1))
    return made


def _named(sockets, name):
    """The first socket of that identifier or name; names of newer Blenders."""
    found = [s for s in sockets if s.identifier == name] + [
        s for s in sockets if s.name == name and s.enabled
    ]
    return found[0]
