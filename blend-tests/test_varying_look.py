"""Inputs of a measured node that vary over the surface: a point looks as with the constant of its value."""

import math

import bpy
import numpy as np
from mathutils import Vector

from support import inputs, scenes
from support.blender import BlenderTest
from support.notes import export_notes

_NAMES = {"roughness": "Roughness Offset", "rotation": "Rotation", "scale": "Scale"}


class VaryingLook(BlenderTest):
    def _stage(self, data, sun=(0.3, 0.1, 1.0)):
        """A measured material on a plane under a sun, which has no noise."""
        self.material = scenes.measured_material(data)
        self.tree, self.node = self.material.node_tree, scenes.velour_node(self.material)
        scenes.use_engine(samples=16, size=24)
        scenes.add_camera(ortho_scale=1.5)
        light = bpy.data.objects.new("Sun", bpy.data.lights.new("Sun", "SUN"))
        light.data.energy, light.data.angle = 3.0, 0.0
        light.rotation_euler = Vector(sun).to_track_quat("Z", "Y").to_euler()
        bpy.context.collection.objects.link(light)
        self.plane = scenes.add_plane(self.material)

    def _picture(self, name):
        return scenes.render(self.folder, name)[..., :3]

    def _link(self, node, name):
        self.tree.links.new(node.outputs[0], self.node.group.inputs[name])

    def _computed(self, value):
        node = self.tree.nodes.new("ShaderNodeMath")
        node.inputs[0].default_value, node.inputs[1].default_value = value - 1.0, 1.0
        return node

    def _image(self, *values):
        node = self.tree.nodes.new("ShaderNodeTexImage")
        node.image = bpy.data.images.new("Values", len(values), 1, float_buffer=True)
        node.image.colorspace_settings.name = "Non-Color"
        node.image.pixels = [channel for v in values for channel in (v, v, v, 1.0)]
        node.interpolation = "Closest"
        return node

    def _attribute(self, value):
        colors = self.plane.data.color_attributes.new("Values", "FLOAT_COLOR", "CORNER")
        for each in colors.data:
            each.color = (value, value, value, 1.0)
        node = self.tree.nodes.new("ShaderNodeVertexColor")
        node.layer_name = "Values"
        return node

    def _is_as_constant(self, tolerance, **sources):
        """`sources`: by field of the look, a value and the function that makes the node for it."""
        plain = self._picture("plain")
        nodes = []
        for field, (value, make) in sources.items():
            nodes.append(make(value))
            self._link(nodes[-1], _NAMES[field])
        varying = self._picture("varying")
        for node in nodes:
            self.tree.nodes.remove(node)
        scenes.set_look(self.material, **{field: value for field, (value, _make) in sources.items()})
        constant = self._picture("constant")
        self.assertLess(np.abs(varying - constant).max(), tolerance * constant.max())
        self.assertGreater(np.abs(constant - plain).max(), 0.1 * constant.max())

    def test_tiles(self):
        """That are not square, so that a rotation shears their coordinates."""
        self._stage(inputs.quarters_model())
        self.node.velour.placement.repeats = (2.0, 3.0)
        self._is_as_constant(1e-4, rotation=(0.6, self._attribute), scale=(0.7, self._image))

    def test_direction_of_anisotropy(self):
        self._stage(inputs.brushed_model())
        self._is_as_constant(1e-4, rotation=(math.pi / 2, self._computed))

    def test_roughness(self):
        """Between two levels, where their sum differs most."""
        self._stage(inputs.model_bytes(inputs.plastic_measurement()), sun=(0.05, 0.02, 1.0))
        for value in (0.27, 0.35, 0.5, 0.7):
            with self.subTest(value):
                self._is_as_constant(0.06, roughness=(value, self._computed))
                scenes.set_look(self.material, roughness=0.0)

    def test_an_image_of_roughness(self):
        self._stage(inputs.model_bytes(inputs.plastic_measurement()), sun=(0.05, 0.02, 1.0))
        self._link(self._image(0.0, 1.0), "Roughness Offset")
        both = self._picture("both")
        self.tree.nodes.remove(self.tree.nodes["Image Texture"])
        for half, value in ((np.s_[:, 2:10], 0.0), (np.s_[:, 14:22], 1.0)):
            scenes.set_look(self.material, roughness=value)
            constant = self._picture(f"constant-{value:g}")
            np.testing.assert_allclose(both[half], constant[half], rtol=1e-4)
        self.assertGreater(both[:, 2:10].mean(), 2 * both[:, 14:22].mean())

    def test_a_measurement_has_no_roughness(self):
        path = inputs.plastic_measurement()
        self._stage(inputs.model_bytes(path))
        self._link(self._computed(0.5), "Roughness Offset")
        self.assertEqual(export_notes(), [])
        settings = self.node.velour
        settings.measurement, settings.use_reference = bpy.data.images.load(str(path)), True
        self.assertIn("Roughness Offset has no effect on a measurement", " ".join(export_notes()))
