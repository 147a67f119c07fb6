"""Sky Textures."""

import math

import bpy

from parity import stage
from parity.case import ParityTest
from support import level

_ENUM = bpy.types.ShaderNodeTexSky.bl_rna.properties["sky_type"].enum_items.keys()
_WITH_SUN = [kind for kind in _ENUM if kind not in ("PREETHAM", "HOSEK_WILKIE")]


class Sky(ParityTest):
    """A sphere on a ground under a sky."""

    def setUp(self):
        super().setUp()
        stage.sphere(segments=32, rings=16)
        stage.ground(20, 0.5).location.z = -1
        stage.camera((0, -6, 1), (math.pi / 2 - 0.1, 0, 0))
        world = stage.world()
        world.cycles.sample_map_resolution = 512
        self.tree = world.node_tree
        self.background = self.tree.nodes["Background"]
        self.node = self.tree.nodes.new("ShaderNodeTexSky")
        self.tree.links.new(self.node.outputs[0], self.background.inputs["Color"])

    def test_without_a_sun(self):
        self.background.inputs["Strength"].default_value = 0.1
        for kind in _ENUM if level.LONG else _ENUM[:1]:
            with self.subTest(kind):
                self.node.sky_type = kind
                if kind in _WITH_SUN:
                    self.node.sun_disc, self.node.sun_rotation, self.node.sun_elevation = False, 2.5, 0.4
                # Its horizon is an edge, which lies within a row of texels.
                self.assert_parity(f"Sky: {kind.lower()}", up_to=0.3 if kind in _WITH_SUN else 0.0)

    def test_a_sun(self):
        """Through other nodes, too."""
        self.node.sky_type, self.node.sun_rotation, self.node.sun_elevation = _WITH_SUN[0], 2.5, 0.7
        self.background.inputs["Strength"].default_value = 0.02
        self.assert_parity("Sky: with its sun", samples=4)
        tint = self.tree.nodes.new("ShaderNodeHueSaturation")
        tint.inputs["Saturation"].default_value, tint.inputs["Value"].default_value = 0.5, 0.7
        self.tree.links.new(self.node.outputs[0], tint.inputs["Color"])
        self.tree.links.new(tint.outputs[0], self.background.inputs["Color"])
        self.assert_parity("Sky: with its sun, desaturated", samples=4)
