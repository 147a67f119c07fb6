"""Worlds whose nodes are evaluated in each direction."""

import math

import bpy
import numpy as np

from parity import stage
from parity.case import ParityTest
from parity.shaders import mapped_picture


class WorldNodes(ParityTest):
    """A sphere before a world of nodes."""

    def setUp(self):
        super().setUp()
        stage.sphere(segments=32, rings=16)
        stage.camera((0, -6, 0), (math.pi / 2, 0, 0))
        self.tree = stage.world().node_tree
        self.background = self.tree.nodes["Background"]

    def _new(self, idname, inputs=None, **settings):
        node = self.tree.nodes.new(f"ShaderNode{idname}")
        for name, value in settings.items():
            setattr(node, name, value)
        for name, value in (inputs or {}).items():
            if isinstance(value, bpy.types.NodeSocket):
                self.tree.links.new(value, node.inputs[name])
            else:
                node.inputs[name].default_value = value
        return node

    def _colored(self, output, strength=None):
        self.tree.links.new(output, self.background.inputs["Color"])
        if strength is not None:
            self.tree.links.new(strength, self.background.inputs["Strength"])

    def _shown(self, shader):
        self.tree.links.new(shader.outputs[0], self.tree.nodes["World Output"].inputs["Surface"])

    def _direction(self, name="Generated"):
        return self._new("TexCoord").outputs[name]

    def _environment(self, vector=None, scale=1.0, **settings):
        return self._new(
            "TexEnvironment", {"Vector": vector} if vector else None, image=self._sky(scale), **settings
        )

    def _sky(self, scale=1.0):
        """Another color on every side."""
        image = bpy.data.images.new("sky", 64, 32, float_buffer=True)
        u, v = np.meshgrid((np.arange(64) + 0.5) / 64, (np.arange(32) + 0.5) / 32)
        pixels = np.ones((32, 64, 4), np.float32)
        pixels[..., 0] = 1 + np.sin(2 * np.pi * u)
        pixels[..., 1] = 1 + np.cos(2 * np.pi * u) * v
        pixels[..., 2] = 0.1 + 2 * v
        pixels[..., :3] *= scale
        image.pixels.foreach_set(pixels.ravel())
        image.pack()
        return image

    def test_a_ramp_of_the_height(self):
        height = self._new("SeparateXYZ", {"Vector": self._direction()}).outputs["Z"]
        self._colored(self._new("ValToRGB", {"Fac": height}).outputs["Color"])
        self.assert_parity("World: color ramp of the height")

    def test_noise_over_the_sky(self):
        # Cycles 3.4 takes other normals where it samples the world, if it has rendered nodes of lamps before.
        self.scene.world.cycles.sampling_method = "NONE"
        noise = self._new("TexNoise", {"Vector": self._direction("Normal"), "Scale": 2.0})
        self._colored(noise.outputs["Color"], noise.outputs["Fac"])
        self.assert_parity("World: noise, linked strength")

    def test_an_image_that_is_changed(self):
        sky = self._environment(self._direction())
        saturated = self._new("HueSaturation", {"Color": sky.outputs[0], "Saturation": 0.3, "Hue": 0.6})
        self._colored(self._new("Gamma", {"Color": saturated.outputs[0], "Gamma": 1.4}).outputs[0])
        self.assert_parity("World: environment texture behind color nodes")

    def test_an_image_that_is_moved_and_stretched(self):
        inputs = {"Vector": self._direction(), "Location": (0.2, 0, 0.4), "Scale": (1, 1, 0.5)}
        self._colored(self._environment(self._new("Mapping", inputs).outputs[0]).outputs[0])
        self.assert_parity("World: location and uneven scale of a mapping")

    def test_an_image_that_a_group_turns(self):
        group = self._new(
            "Group", node_tree=mapped_picture("ShaderNodeTexEnvironment", self._sky(), "Generated")
        )
        group.inputs["Turn"].default_value, group.inputs["Size"].default_value = (0, 0, 1.2), (1, 1, 1)
        self._colored(group.outputs[0])
        self.assert_parity("World: rotation by an input of a node group")

    def test_an_image_in_place_of_a_shader(self):
        self._shown(self._environment(self._direction()))
        self.assert_parity("World Output: environment texture")

    def test_a_mirror_ball(self):
        self._colored(self._environment(projection="MIRROR_BALL").outputs[0])
        self.assert_parity("World: mirror ball")

    def test_what_the_camera_sees_is_another_world(self):
        """What lights the scene is not what the camera sees, also behind a pane."""
        light_path = self._new("LightPath")
        seen = self._new("Background", {"Color": (0.1, 0.4, 0.9, 1), "Strength": 0.5})
        mixed = self._new("MixShader", {"Fac": light_path.outputs["Is Camera Ray"]})
        self._colored(self._environment().outputs[0])
        self.tree.links.new(self.background.outputs[0], mixed.inputs[1])
        self.tree.links.new(seen.outputs[0], mixed.inputs[2])
        self._shown(mixed)
        self.assert_parity("World: another background for the camera")

    def test_two_worlds_added(self):
        height = self._new("SeparateXYZ", {"Vector": self._direction("Object")}).outputs["Z"]
        height = self._new("Math", {0: height}, operation="ABSOLUTE").outputs[0]
        self._colored(self._environment().outputs[0])
        glow = self._new("Emission", {"Color": (1, 0.6, 0.2, 1), "Strength": height})
        added = self._new("AddShader")
        for shader, socket in zip((self.background, glow), added.inputs, strict=True):
            self.tree.links.new(shader.outputs[0], socket)
        self._shown(added)
        self.assert_parity("World: shaders added")

    def test_an_environment_on_a_surface(self):
        """By the position, and by the mirrored view."""
        (sphere,) = (obj for obj in bpy.data.objects if obj.type == "MESH")
        sky = self._environment(scale=0.3).image
        material = bpy.data.materials.new("Sky")
        sphere.data.materials[0], material.use_nodes = material, True
        self.tree, world = material.node_tree, self.tree
        base = self.tree.nodes["Principled BSDF"].inputs["Base Color"]
        for output in (None, "Reflection"):
            with self.subTest(output):
                vector = {"Vector": self._direction(output)} if output else None
                self.tree.links.new(self._new("TexEnvironment", vector, image=sky).outputs[0], base)
                self.assert_parity(f"Environment texture on a surface, {output or 'unlinked'}")
        self.tree = world
