"""An artist's tint and exposure of measured materials: the picture, times a color, sample for sample."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest

TINT = (1.0, 0.5, 0.25)


class Tint(BlenderTest):
    def _plane(self, material):
        scene = scenes.use_engine(samples=16)
        scenes.set_world((0.5, 0.7, 1.0))
        scenes.add_camera(ortho_scale=1.5)
        scenes.add_plane(material)
        return scene, material

    def _is_multiplied(self, scene, material):
        plain = scenes.render(self.folder, "plain")[..., :3]
        scenes.set_look(material, tint=TINT, exposure=1.0)
        tinted = scenes.render(self.folder, "tinted")[..., :3]
        self.assertGreater(plain.min(), 0.01)
        np.testing.assert_allclose(tinted, plain * np.float32(TINT) * 2, rtol=1e-5)

    def test_of_a_model(self):
        material = scenes.measured_material(inputs.model_bytes(inputs.plastic_measurement()))
        self._is_multiplied(*self._plane(material))

    def test_of_a_btf(self):
        self._is_multiplied(*self._plane(scenes.measured_material(inputs.quarters_model())))

    def test_of_the_measurement_itself(self):
        material = scenes.measured_material(inputs.model_bytes(inputs.plastic_measurement()))
        scene, material = self._plane(material)
        settings = scenes.velour_node(material).velour
        settings.measurement = bpy.data.images.load(str(inputs.plastic_measurement()))
        settings.use_reference = True
        self._is_multiplied(scene, material)

    def test_black_reflects_nothing(self):
        material = scenes.measured_material(inputs.model_bytes(inputs.lambert_measurement()))
        scene, material = self._plane(material)
        scene.velour.bounces = 3
        scenes.set_look(material, tint=(0.0, 0.0, 0.0))
        self.assertEqual(scenes.render(self.folder)[..., :3].max(), 0.0)
