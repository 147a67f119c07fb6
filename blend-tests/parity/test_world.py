"""Worlds: color, strength, environment pictures and how they are turned."""

import math

import bpy
import numpy as np

from parity import stage
from parity.case import ParityTest


class World(ParityTest):
    """A sphere before the sky."""

    def setUp(self):
        super().setUp()
        self.sphere = stage.sphere(segments=32, rings=16)
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0))
        self.tree = stage.world().node_tree
        self.background = self.tree.nodes["Background"]

    def _environment(self, **settings):
        """A smooth sky, another color on every side."""
        image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
        u, v = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(32) + 0.5) / 32)
        pixels = np.ones((32, 64, 4), np.float32)
        pixels[..., 0] = 1 + np.sin(2 * np.pi * u)
        pixels[..., 1] = 1 + np.cos(2 * np.pi * u) * v
        pixels[..., 2] = 0.1 + 2 * v
        pixels[12:16, 20:24, :3] *= 3
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        node = self.tree.nodes.new("ShaderNodeTexEnvironment")
        node.image = image
        for name, value in settings.items():
            setattr(node, name, value)
        self.tree.links.new(node.outputs[0], self.background.inputs["Color"])
        return node

    def _mapping(self, node, rotation, kind="POINT"):
        mapping, source = self.tree.nodes.new("ShaderNodeMapping"), self.tree.nodes.new("ShaderNodeTexCoord")
        mapping.vector_type, mapping.inputs["Rotation"].default_value = kind, rotation
        self.tree.links.new(source.outputs["Generated"], mapping.inputs["Vector"])
        self.tree.links.new(mapping.outputs[0], node.inputs["Vector"])
        return mapping

    def test_color(self):
        self.background.inputs["Color"].default_value = (0.9, 0.5, 0.2, 1)
        self.background.inputs["Strength"].default_value = 0.7
        self.assert_parity("World: color and strength")

    def test_environment(self):
        self._environment()
        self.background.inputs["Strength"].default_value = 1.5
        self.assert_parity("World: environment texture, strength")

    def test_rotation(self):
        for kind in ("POINT", "TEXTURE", "VECTOR"):
            with self.subTest(kind):
                self._mapping(self._environment(), (0.3, -0.4, 1.1), kind)
                self.assert_parity(f"World: rotated environment, {kind.lower()} mapping")

    def test_mapping_of_texture(self):
        self._environment().texture_mapping.rotation = (0.3, -0.4, 1.1)
        self.assert_parity("World: environment rotated by the settings of its node")

    def test_closest(self):
        self._environment(interpolation="Closest")
        self.assert_approximate("World: environment, closest texel", 0.6)

    def test_byte_image(self):
        """Cycles decodes between texels, Velour at them: the picture is smooth."""
        image = bpy.data.images.new("bytes", 64, 32)
        pixels = np.ones((32, 64, 4), np.float32)
        pixels[..., 0] = 0.5 + 0.3 * np.sin(2 * np.pi * (np.arange(64) + 0.5) / 64)
        pixels[..., 1] = np.linspace(0.2, 0.8, 32)[:, None]
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        self._environment().image = image
        self.assert_approximate("World: environment, 8-bit sRGB", 0.6)

    def test_camera_coordinates(self):
        node = self._environment()
        source = self.tree.nodes.new("ShaderNodeTexCoord")
        self.tree.links.new(source.outputs["Camera"], node.inputs["Vector"])
        sentence = "output 'Camera' of 'Texture Coordinate' is not supported"
        self.assert_ignored("World: camera coordinates", sentence)

    def test_negative(self):
        stage.sharp_sun()
        stage.world((0.5, 0.5, 0.5), -0.5)
        self.assert_ignored("World: negative strength", "its light is negative")

    def test_hidden_from_camera(self):
        self.scene.world.cycles_visibility.camera = False
        self.assert_parity("World: hidden from the camera")

    def test_bounce(self):
        stage.ground(20, 0.8).location.z = -1
        self.scene.cycles.max_bounces = self.scene.cycles.diffuse_bounces = self.scene.velour.bounces = 2
        self.assert_parity("Two bounces under a sky")
