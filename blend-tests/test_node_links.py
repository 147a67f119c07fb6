"""Links between nodes that Blender keeps but does not use: the input's own value applies."""

import bpy

from support import inputs
from support.blender import BlenderTest


class NodeLinks(BlenderTest):
    def setUp(self):
        super().setUp()
        material = bpy.data.materials.new("Linked")
        material.use_nodes = True
        self.tree = material.node_tree
        self.shader = self.tree.nodes["Principled BSDF"]
        self.roughness = self.shader.inputs["Roughness"]

    def _node(self, idname):
        return self.tree.nodes.new(f"ShaderNode{idname}")

    def _assert_used(self, socket, is_used):
        plugs, nodes = inputs.module("export.plugs"), inputs.module("export.nodes")
        self.assertTrue(socket.is_linked)
        self.assertEqual(plugs.fed_by(plugs.Plug(socket)) is not None, is_used)
        self.assertEqual(nodes.source(socket) is not None, is_used)

    def test_muted(self):
        link = self.tree.links.new(self._node("Value").outputs[0], self.roughness)
        self._assert_used(self.roughness, True)
        link.is_muted = True
        self._assert_used(self.roughness, False)

    def test_from_a_hidden_output(self):
        node = self._node("VectorMath")
        node.operation = "DOT_PRODUCT"
        self.tree.links.new(node.outputs["Value"], self.roughness)
        self._assert_used(self.roughness, True)
        node.operation = "ADD"
        self._assert_used(self.roughness, False)

    def test_to_a_hidden_input(self):
        node = self._node("TexNoise")
        node.noise_dimensions = "4D"
        distance = node.inputs["W"]
        self.tree.links.new(self._node("Value").outputs[0], distance)
        self._assert_used(distance, True)
        node.noise_dimensions = "3D"
        self._assert_used(distance, False)

    def test_cycle(self):
        first, second = self._node("Math"), self._node("Math")
        self.tree.links.new(first.outputs[0], second.inputs[0])
        self.tree.links.new(second.outputs[0], self.roughness)
        self._assert_used(second.inputs[0], True)
        self.tree.links.new(second.outputs[0], first.inputs[0])
        links = (first.inputs[0].links[0], second.inputs[0].links[0])
        self.assertFalse(all(link.is_valid for link in links))
        for link in links:
            self._assert_used(link.to_socket, link.is_valid)
