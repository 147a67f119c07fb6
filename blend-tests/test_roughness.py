"""An artist's roughness of measured materials: wider highlights of the same energy."""

import bpy
import numpy as np

from support import inputs, scenes
from support.blender import BlenderTest


class Roughness(BlenderTest):
    def _ball(self, data, make=scenes.measured_material):
        """A ball that wears a model; its material."""
        material = make(data)
        scenes.use_engine(samples=256)
        scenes.add_camera(ortho_scale=2.2)
        scenes.add_sphere(material)
        return material

    def _plastic(self):
        return self._ball(inputs.model_bytes(inputs.plastic_measurement()))

    def _sun(self):
        bpy.ops.object.light_add(type="SUN", rotation=(0.4, 0, 0))
        bpy.context.object.data.angle = 0.02

    def _highlight(self, name):
        """Peak of the picture, and how many pixels have half of it."""
        green = scenes.render(self.folder, name)[..., 1]
        return green.max(), int((green > green.max() / 2).sum())

    def test_highlights_get_lower_and_wider(self):
        material = self._plastic()
        scenes.set_world(strength=0)
        self._sun()
        peaks, sizes = [], []
        for i, roughness in enumerate((0.0, 0.35, 0.5, 0.7)):
            scenes.set_look(material, roughness=roughness)
            peak, size = self._highlight(f"rough{i}")
            peaks.append(peak)
            sizes.append(size)
        self.assertEqual(peaks, sorted(peaks, reverse=True))
        self.assertEqual(sizes, sorted(sizes))
        self.assertLess(peaks[2], 0.6 * peaks[0])
        self.assertGreater(sizes[2], 1.5 * sizes[0])

    def test_no_light_is_won_or_lost(self):
        material = self._plastic()
        scenes.set_world()
        plain = scenes.render(self.folder, "plain")[..., :3].mean()
        for i, roughness in enumerate((0.2, 0.5, 1.0)):
            scenes.set_look(material, roughness=roughness)
            rough = scenes.render(self.folder, f"furnace{i}")[..., :3].mean()
            self.assertLess(abs(rough / plain - 1), 0.02, roughness)

    def test_nothing_is_the_same_picture(self):
        material = self._plastic()
        scenes.set_world((0.5, 0.7, 1.0))
        plain = scenes.render(self.folder, "plain")
        scenes.set_look(material, roughness=0.0)
        np.testing.assert_array_equal(scenes.render(self.folder, "zero"), plain)

    def _is_left_out(self, material, words, roughen):
        """The picture stays, and a warning says why."""
        scenes.set_world((0.5, 0.7, 1.0))
        plain = scenes.render(self.folder, "plain")
        roughen(material)
        np.testing.assert_array_equal(scenes.render(self.folder, "left-out"), plain)
        notes = inputs.module("export.notes").Notes()
        materials = inputs.module("export.materials")
        with inputs.native().Scene() as scene:
            materials.MaterialTable(scene, notes).number(bpy.context.object.active_material)
        self.assertTrue(any(words in note for note in notes), list(notes))

    def test_of_a_btf_of_the_former_layout(self):
        """Groups of BTFs have no such input."""

        def roughen(material):
            scenes.velour_node(material).velour.roughness = 0.6

        former = self._ball(inputs.quarters_model(), scenes.former_material)
        self._is_left_out(former, "no effect on the model of a BTF", roughen)

    def test_of_the_measurement_itself(self):
        material = self._plastic()
        settings = scenes.velour_node(material).velour
        settings.measurement = bpy.data.images.load(str(inputs.plastic_measurement()))
        settings.use_reference = True
        words = "Disable Render from Measurement"
        self._is_left_out(material, words, lambda each: scenes.set_look(each, roughness=0.6))
