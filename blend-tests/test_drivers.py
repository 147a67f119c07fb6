"""What drivers alone set arrives as it is evaluated."""

import bpy
import numpy as np

from support import scenes
from support.blender import BlenderTest


class Drivers(BlenderTest):
    """A ball under a lamp, driven by properties of the scene; nothing is keyed."""

    def setUp(self):
        super().setUp()
        self.scene = scenes.use_engine(samples=16)
        scenes.add_camera()
        self.scene["power"], self.scene["place"], self.scene["red"] = 1.0, 0.0, 0.2
        self.material = scenes.diffuse_material((0.2, 0.5, 0.5))
        self.ball = scenes.add_sphere(self.material, radius=0.7)
        self.lamp = bpy.data.objects.new("Lamp", bpy.data.lights.new("Lamp", "POINT"))
        self.lamp.location = (1, 1, 4)
        self.scene.collection.objects.link(self.lamp)
        self.color = next(
            n for n in self.material.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfDiffuse"
        ).inputs["Color"]

    def _drive(self, owner, path, name, expression, index=-1):
        curve = owner.driver_add(path, index) if index >= 0 else owner.driver_add(path)
        variable = curve.driver.variables.new()
        variable.name = "value"
        variable.targets[0].id_type, variable.targets[0].id = "SCENE", self.scene
        variable.targets[0].data_path = f'["{name}"]'
        curve.driver.expression = expression

    def _picture(self, **values):
        for name, value in values.items():
            self.scene[name] = value
        self.scene.update_tag()
        return scenes.render(self.folder)[..., :3]

    def _assert_as_set(self, driven, undriven):
        """`driven` is the picture of the scene as it is now, and not the one before."""
        self.assertGreater(driven.max(), 0.05)
        np.testing.assert_array_equal(driven, scenes.render(self.folder)[..., :3])
        self.assertFalse(np.array_equal(driven, undriven))

    def test_energy_of_a_lamp(self):
        self._drive(self.lamp.data, "energy", "power", "100 * value")
        undriven = self._picture(power=1.0)
        driven = self._picture(power=3.0)
        np.testing.assert_allclose(driven, 3 * undriven, rtol=1e-4)
        self.lamp.data.driver_remove("energy")
        self.lamp.data.energy = 300
        self._assert_as_set(driven, undriven)

    def test_location_of_an_object(self):
        self.lamp.data.energy = 100
        self._drive(self.ball, "location", "place", "value / 2", 0)
        undriven = self._picture(place=0.0)
        driven = self._picture(place=1.6)
        self.ball.driver_remove("location", 0)
        self.ball.location.x = 0.8
        self._assert_as_set(driven, undriven)

    def test_color_of_a_material(self):
        self.lamp.data.energy = 100
        self._drive(self.color, "default_value", "red", "value", 0)
        undriven = self._picture(red=0.2)
        driven = self._picture(red=0.9)
        self.color.driver_remove("default_value", 0)
        self.color.default_value[0] = 0.9
        self._assert_as_set(driven, undriven)
